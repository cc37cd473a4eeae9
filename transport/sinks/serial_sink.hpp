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
  int ttl_ms = 200;  ///< 10 … 2550 in steps of 10: the board switches all off when nothing newer comes for so long
  Quantity quantity = Quantity::kDuty;
  std::optional<XbeeOptions> xbee;                   ///< the module at this port is in API mode
  std::chrono::milliseconds patience{500};           ///< as `SerialPort` says
  std::chrono::milliseconds greeting_timeout{2000};  ///< how long `greet` waits
  /// An Arduino resets when its port is opened, and its bootloader listens for about a second. The one of the MEGA 2560
  /// (stk500v2) that hears anything but silence then waits for a new program, for as long as bytes come. So after the
  /// first hello, which a board that did not reset answers, nothing is said for so long.
  std::chrono::milliseconds boot_silence{1500};
  std::chrono::milliseconds hello_interval{250};  ///< between the hellos after that
};

/// The vest at a serial port. Its frames are those of vest_frame.hpp.
class SerialSink final : public ActuatorSink {
 public:
  /// Opens the port, ends what may stand half-sent on the line, and says hello. Throws as `SerialPort` does, and
  /// `UsageError` for a ttl or an XBee address that does not fit.
  explicit SerialSink(SerialSinkOptions options);

  /// Waits for the answer to hello, saying it again; none when the board does not answer in time. To be called before
  /// frames are sent: acknowledgements that come meanwhile answer nobody. Throws `LinkLost`.
  std::optional<Greeting> greet();
  /// Of the board that is there now, from `greet` or `receive`; none when it has not answered since the port was
  /// opened.
  const std::optional<Greeting>& greeting() const { return greeting_; }

  std::string name() const override { return options_.path; }
  /// Also false while the board may be starting, until it answers: see `boot_silence`. True on a lost link: `send` says
  /// so.
  bool ready() override;
  /// Actuators beyond those of the greeting are left out.
  void send(const ActuatorFrame& frame, std::uint8_t sequence) override;
  void send_off(std::uint8_t sequence) override;
  bool acknowledges() const override { return true; }
  int readable_descriptor() const override { return port_ ? port_->descriptor() : -1; }
  std::vector<Acknowledgement> receive() override;
  /// The board's greeting, if it answers, comes with `receive`.
  bool reconnect() override;
  std::uint64_t bytes_sent() const override { return bytes_sent_; }

  std::uint64_t damaged_answers() const { return decoder_.damaged(); }
  /// What the radio at this port says of frames that did or did not arrive; null without XBee.
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
  std::unique_ptr<SerialPort> port_;  // none: the link is lost
  VestAnswerDecoder decoder_;
  std::optional<XbeeUnwrapper> unwrapper_;
  std::optional<Greeting> greeting_;
  bool ask_again_ = false;          // a hello after a reconnection may have met a board that was starting
  Clock::time_point silent_until_;  // unless the board answers
  Clock::time_point line_is_free_;  // by the baud: when the last byte written will have left
  std::uint64_t bytes_sent_ = 0;
  std::uint8_t radio_frame_ = 0;
};

}  // namespace vestige
