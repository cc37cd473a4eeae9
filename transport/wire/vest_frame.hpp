#pragma once

#include <cstdint>
#include <span>
#include <variant>
#include <vector>

#include "transport/actuator_sink.hpp"

namespace vestige {

// The frames that go to the vest's board and come from it: COBS(payload, CRC-16 of the payload, low byte first), then a
// zero. Payloads, a letter first:
//   to the board     S sequence ttl n duty[n]      P sequence ttl n pressure[n]      X sequence 0 0      H sequence
//   from the board   A sequence flags receive_errors      H sequence version n flags
// Levels are absolute; actuators beyond n are off. ttl, in 10 ms units: without a newer frame the board switches all
// off after it. X switches all off. H asks who is there.

/// n is one byte.
inline constexpr std::size_t kMaxActuators = 255;
inline constexpr int kTtlUnit_ms = 10;
/// What `encode_state` takes. Throws `UsageError` naming --ttl for what is no multiple of 10 from 10 to 2550.
std::uint8_t ttl_units(int ttl_ms);
/// A zero alone ends whatever stood half-sent on the line before, and is no frame.
inline constexpr std::uint8_t kFrameEnd = 0;

/// Frames with their zero, ready for the line. `level`: 0 … 255 for each actuator, at most `kMaxActuators`, else throws
/// `Error`. `ttl`: 1 … 255, of 10 ms each.
std::vector<std::uint8_t> encode_state(Quantity quantity, std::span<const std::uint8_t> level, std::uint8_t sequence,
                                       std::uint8_t ttl);
std::vector<std::uint8_t> encode_off(std::uint8_t sequence);
std::vector<std::uint8_t> encode_hello(std::uint8_t sequence);

/// What a board says of itself when it is asked with a hello.
struct Greeting {
  std::uint8_t sequence = 0;        ///< of the hello
  std::uint8_t version = 0;         ///< of the board's program, as its own documentation counts
  std::uint8_t actuator_count = 0;  ///< how many it drives; further levels of a frame are ignored
  bool was_in_fail_safe = false;    ///< as in `Acknowledgement`: also true after a start, until a frame sets it going
  bool overrun = false;             ///< as in `Acknowledgement`
};

using VestAnswer = std::variant<Acknowledgement, Greeting>;

/// Finds the board's answers in what comes over the line, in whatever pieces. Nothing that fails its CRC, is unknown,
/// or has not exactly the length of its kind is taken.
class VestAnswerDecoder {
 public:
  /// The answers that these bytes complete, in order.
  std::vector<VestAnswer> push(std::span<const std::uint8_t> bytes);
  /// Frames that were not taken. Two zeros with nothing between them are no frame.
  std::uint64_t damaged() const { return damaged_; }

 private:
  std::vector<std::uint8_t> frame_;  // so far; never longer than the longest answer and one byte
  std::uint64_t damaged_ = 0;
};

}  // namespace vestige
