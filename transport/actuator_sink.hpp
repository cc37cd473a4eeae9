#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "traces/base/error.hpp"
#include "traces/timeline/timeline.hpp"

namespace vestige {

/// What the levels of a frame mean to the vest: duties of vibrators, or pressures of pneumatic cells, both 0 … 255.
enum class Quantity : std::uint8_t { kDuty, kPressure };

/// What a board answers to a frame that it obeyed.
struct Acknowledgement {
  std::uint8_t sequence = 0;        ///< of the frame
  bool was_in_fail_safe = false;    ///< the board had switched itself off, since nothing valid came for too long
  bool overrun = false;             ///< the board lost bytes since its last answer
  std::uint8_t receive_errors = 0;  ///< damaged frames since it started, modulo 256
};

/// The other end has gone for now: unplugged, or hung up. `reconnect` may bring it back.
class LinkLost : public Error {
 public:
  using Error::Error;
};

/// Where actuator frames go while a trace plays. Belongs to one thread at a time.
class ActuatorSink {
 public:
  ActuatorSink() = default;
  virtual ~ActuatorSink() = default;
  ActuatorSink(const ActuatorSink&) = delete;
  ActuatorSink& operator=(const ActuatorSink&) = delete;

  /// For messages: "/dev/ttyUSB0", "osc://127.0.0.1:9000".
  virtual std::string name() const = 0;
  /// Whether whatever was sent before has left: a frame sent now is the only one on its way, and no queue builds up
  /// behind a slow line.
  virtual bool ready() { return true; }
  /// Returns when the last byte has been given to the system. `sequence` comes back in the acknowledgement.
  /// Throws `LinkLost`, or `Error` for what will not mend itself.
  virtual void send(const ActuatorFrame& frame, std::uint8_t sequence) = 0;
  /// Switches all actuators off. The same errors.
  virtual void send_off(std::uint8_t sequence) = 0;
  /// Whether frames are answered at all.
  virtual bool acknowledges() const { return false; }
  /// A descriptor that becomes readable when an answer comes; -1: none ever does, or the link is lost.
  virtual int readable_descriptor() const { return -1; }
  /// The answers that have come, without waiting. Throws `LinkLost`.
  virtual std::vector<Acknowledgement> receive() { return {}; }
  /// Tries to bring a lost link back, without waiting for an answer: false when it is not there yet.
  virtual bool reconnect() { return true; }
  /// Handed to the system so far, wrapping and all.
  virtual std::uint64_t bytes_sent() const = 0;
};

}  // namespace vestige
