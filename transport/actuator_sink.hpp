#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "traces/base/error.hpp"
#include "traces/timeline/timeline.hpp"

namespace vestige {

/// The meaning of a frame's levels: duty cycles of vibrators, or pressures of pneumatic cells, both 0 … 255.
enum class Quantity : std::uint8_t { kDuty, kPressure };

/// A board's answer to a frame that it obeyed.
struct Acknowledgement {
  std::uint8_t sequence = 0;        ///< of the frame
  bool was_in_fail_safe = false;    ///< the board had switched itself off, since no valid frame came for too long
  bool overrun = false;             ///< the board lost bytes since its last answer
  std::uint8_t receive_errors = 0;  ///< damaged frames since the board started, modulo 256
  bool outputs_failed = false;      ///< the chips that drive the actuators did not answer the board, so all were off
};

/// The other end is gone for now: unplugged, or hung up. `reconnect` may restore the link.
class LinkLost : public Error {
 public:
  using Error::Error;
};

/// The destination of actuator frames while a trace plays. Used by one thread at a time.
class ActuatorSink {
 public:
  ActuatorSink() = default;
  virtual ~ActuatorSink() = default;
  ActuatorSink(const ActuatorSink&) = delete;
  ActuatorSink& operator=(const ActuatorSink&) = delete;

  /// The name for messages: "/dev/ttyUSB0", "osc://127.0.0.1:9000".
  virtual std::string name() const = 0;
  /// Whether everything sent before has left. Then a frame sent now is the only one on its way, and no queue builds up
  /// behind a slow line.
  virtual bool ready() { return true; }
  /// Sends a frame, and returns after the last byte was passed to the system. The acknowledgement repeats `sequence`.
  /// Throws `LinkLost`, or `Error` for faults that do not resolve themselves.
  virtual void send(const ActuatorFrame& frame, std::uint8_t sequence) = 0;
  /// Switches all actuators off. Throws as `send` does.
  virtual void send_off(std::uint8_t sequence) = 0;
  /// Whether frames are ever answered.
  virtual bool acknowledges() const { return false; }
  /// A descriptor that becomes readable when an answer arrives. -1 if the sink never answers, or the link is lost.
  virtual int readable_descriptor() const { return -1; }
  /// Returns the answers that have arrived, without waiting. Throws `LinkLost`.
  virtual std::vector<Acknowledgement> receive() { return {}; }
  /// Tries to restore a lost link, without waiting for an answer. Returns false if the link is not back yet.
  virtual bool reconnect() { return true; }
  /// Bytes passed to the system so far, including all framing.
  virtual std::uint64_t bytes_sent() const = 0;
};

}  // namespace vestige
