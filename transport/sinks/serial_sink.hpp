#pragma once

#include <chrono>
#include <memory>
#include <optional>
#include <string>

#include "transport/actuator_sink.hpp"
#include "transport/sinks/serial_port.hpp"
#include "transport/wire/vest_frame.hpp"
#include "transport/wire/xbee_api.hpp"

namespace vestige {

struct SerialSinkOptions {
  std::string path;
  std::uint32_t baud = kDefaultBaud;
  int ttl_ms = 200;  ///< 10 … 2550 in steps of 10: without a newer frame for this long, the board switches off
  Quantity quantity = Quantity::kDuty;
  std::optional<XbeeOptions> xbee;                   ///< set if the module at this port is in API mode
  std::chrono::milliseconds patience{500};           ///< as for `SerialPort`
  std::chrono::milliseconds greeting_timeout{2000};  ///< how long `greet` waits
  /// An Arduino resets when its port is opened, and its bootloader listens for about a second. If the bootloader of the
  /// MEGA 2560 (stk500v2) receives anything, it waits for a new program as long as bytes arrive. So this sink is silent
  /// for this time after the first hello, which a board that did not reset answers.
  std::chrono::milliseconds boot_silence{1500};
  std::chrono::milliseconds hello_interval{250};  ///< between the later hellos
};

/// The vest at a serial port. It uses the frames of vest_frame.hpp.
class SerialSink final : public ActuatorSink {
 public:
  /// Opens the port, ends a frame that may be half-sent on the line, and sends hello. Throws as `SerialPort` does, and
  /// `UsageError` for an invalid ttl or XBee address.
  explicit SerialSink(SerialSinkOptions options);

  /// Waits for the answer to hello, and repeats hello. Returns nothing if the board does not answer in time. Call this
  /// before sending frames, because acknowledgements that arrive meanwhile are dropped. Throws `LinkLost`.
  std::optional<Greeting> greet();
  /// The greeting of the connected board, from `greet` or `receive`. Empty if the board has not answered since the port
  /// was opened.
  const std::optional<Greeting>& greeting() const { return greeting_; }

  std::string name() const override { return options_.path; }
  /// Also false while the board may be starting, until it answers: see `boot_silence`. True if the link is lost, so
  /// that `send` reports it.
  bool ready() override;
  /// Leaves out actuators beyond those of the greeting.
  void send(const ActuatorFrame& frame, std::uint8_t sequence) override;
  void send_off(std::uint8_t sequence) override;
  bool acknowledges() const override { return true; }
  int readable_descriptor() const override { return port_ ? port_->descriptor() : -1; }
  std::vector<Acknowledgement> receive() override;
  /// The board's greeting, if it answers, arrives through `receive`.
  bool reconnect() override;
  std::uint64_t bytes_sent() const override { return bytes_sent_; }

  std::uint64_t damaged_answers() const { return decoder_.damaged(); }
  /// The reports of the radio at this port about delivered and undelivered frames; null without XBee.
  const XbeeUnwrapper* radio() const { return unwrapper_ ? &*unwrapper_ : nullptr; }

 private:
  using Clock = std::chrono::steady_clock;

  void open();
  void say_hello();
  void write(std::span<const std::uint8_t> frame);
  double pending_bytes() const;
  SerialPort& port();

  SerialSinkOptions options_;
  std::uint8_t ttl_ = 0;
  std::unique_ptr<SerialPort> port_;  // null: the link is lost
  VestAnswerDecoder decoder_;
  std::optional<XbeeUnwrapper> unwrapper_;
  std::optional<Greeting> greeting_;
  bool ask_again_ = false;          // a hello after a reconnection may have met a board that was starting
  Clock::time_point silent_until_;  // end of the silence, unless the board answers
  Clock::time_point line_is_free_;  // time at which, by the baud, the last byte written will have left
  std::uint64_t bytes_sent_ = 0;
  std::uint8_t radio_frame_ = 0;
};

}  // namespace vestige
