#pragma once

#include <chrono>
#include <cstdint>
#include <span>
#include <variant>
#include <vector>

#include "transport/actuator_sink.hpp"

namespace vestige {

// The frames to and from the vest's board: COBS(payload, CRC-16 of the payload, low byte first), then a zero. Payloads,
// beginning with a letter:
//   to the board     S sequence ttl n duty[n]      P sequence ttl n pressure[n]      X sequence 0 0      H sequence
//   from the board   A sequence flags receive_errors      H sequence version n flags
// Levels are absolute; actuators beyond n are off. ttl is in units of 10 ms: the board switches all off if no newer
// frame arrives within it. X switches all off. H asks the board to identify itself.

/// The number of actuators is one byte.
inline constexpr std::size_t kMaxActuators = 255;
inline constexpr int kTtlUnit_ms = 10;
/// Converts a ttl to the unit of `encode_state`. Throws `UsageError` with --ttl unless `ttl_ms` is a multiple of 10
/// from 10 to 2550.
std::uint8_t ttl_units(int ttl_ms);
/// A board of more than six actuators drives them through chips of 16 channels each (transport/firmware/README.md).
/// Returns how many chips that many actuators need.
std::size_t chips_of(std::size_t actuators);
/// Returns the longest time that a board takes to pass a frame on to its chips. Frames that come faster are obeyed,
/// too, but some are replaced by the next before all chips show them.
std::chrono::microseconds board_time(std::size_t actuators);
/// A zero alone ends a half-sent frame on the line, and is not a frame itself.
inline constexpr std::uint8_t kFrameEnd = 0;

/// These functions return frames with their zero, ready for the line. `level` has 0 … 255 for each actuator; throws
/// `Error` for more than `kMaxActuators`. `ttl` is 1 … 255, in units of 10 ms.
std::vector<std::uint8_t> encode_state(Quantity quantity, std::span<const std::uint8_t> level, std::uint8_t sequence,
                                       std::uint8_t ttl);
std::vector<std::uint8_t> encode_off(std::uint8_t sequence);
std::vector<std::uint8_t> encode_hello(std::uint8_t sequence);

/// A board's description of itself, in answer to a hello.
struct Greeting {
  std::uint8_t sequence = 0;        ///< sequence of the hello
  std::uint8_t version = 0;         ///< version of the board's program, by its own count
  std::uint8_t actuator_count = 0;  ///< number of actuators; further levels of a frame are ignored
  bool was_in_fail_safe = false;    ///< as in `Acknowledgement`; also true after a start, until the first frame
  bool overrun = false;             ///< as in `Acknowledgement`
  bool outputs_failed = false;      ///< as in `Acknowledgement`
};

using VestAnswer = std::variant<Acknowledgement, Greeting>;

/// Finds the board's answers in bytes from the line, in pieces of any size. Ignores frames with a wrong CRC, of an
/// unknown kind, or of another length than their kind has.
class VestAnswerDecoder {
 public:
  /// Returns the answers that these bytes complete, in order.
  std::vector<VestAnswer> push(std::span<const std::uint8_t> bytes);
  /// Number of frames ignored. Two zeros with nothing between them are not a frame.
  std::uint64_t damaged() const { return damaged_; }

 private:
  std::vector<std::uint8_t> frame_;  // bytes so far; at most one byte longer than the longest answer
  std::uint64_t damaged_ = 0;
};

}  // namespace vestige
