#include "transport/sinks/serial_sink.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <span>

namespace vestige {

SerialSink::SerialSink(SerialSinkOptions options) : options_(std::move(options)), ttl_(ttl_units(options_.ttl_ms)) {
  if (options_.xbee) unwrapper_.emplace(options_.xbee->escaping);
  open();
}

void SerialSink::open() {
  port_ = std::make_unique<SerialPort>(options_.path, options_.baud, options_.patience);
  greeting_.reset();
  ask_again_ = false;
  line_is_free_ = Clock::now();
  silent_until_ = Clock::now() + options_.boot_silence;
  say_hello();
}

void SerialSink::say_hello() {
  std::vector<std::uint8_t> frame{kFrameEnd};
  const std::vector<std::uint8_t> hello = encode_hello(0);
  frame.insert(frame.end(), hello.begin(), hello.end());
  write(frame);
}

std::optional<Greeting> SerialSink::greet() {
  const auto deadline = Clock::now() + options_.greeting_timeout;
  auto next_hello = silent_until_;
  while (!greeting_ && Clock::now() < deadline) {
    if (Clock::now() >= next_hello) {
      say_hello();
      next_hello = Clock::now() + options_.hello_interval;
    }
    const auto longest = std::min(next_hello, deadline) - Clock::now();
    if (port().wait_readable(std::chrono::ceil<std::chrono::milliseconds>(longest))) receive();
  }
  silent_until_ = Clock::now();
  return greeting_;
}

bool SerialSink::ready() {
  if (!port_) return true;
  if (Clock::now() < silent_until_) return false;
  return pending_bytes() <= 0;
}

double SerialSink::pending_bytes() const {
  // Converters keep bytes that their driver counts as sent, and a pseudo-terminal counts none. So bytes that cannot
  // have left yet at this baud are pending, too.
  const std::chrono::duration<double> busy_s = line_is_free_ - Clock::now();
  return std::max(static_cast<double>(port_->pending_bytes()), busy_s.count() * options_.baud / kBitsPerByte);
}

void SerialSink::send(const ActuatorFrame& frame, std::uint8_t sequence) {
  if (ask_again_ && !greeting_) say_hello();
  ask_again_ = false;
  std::span<const std::uint8_t> level(frame.duty);
  if (greeting_) level = level.first(std::min<std::size_t>(level.size(), greeting_->actuator_count));
  write(encode_state(options_.quantity, level, sequence, ttl_));
}

void SerialSink::send_off(std::uint8_t sequence) {
  write(encode_off(sequence));
}

void SerialSink::write(std::span<const std::uint8_t> frame) {
  std::vector<std::uint8_t> wrapped;
  if (options_.xbee) {
    radio_frame_ = static_cast<std::uint8_t>(radio_frame_ % 255U + 1U);  // 0 would mean: do not report its delivery
    wrapped = xbee_wrap(*options_.xbee, radio_frame_, frame);
    frame = wrapped;
  }
  try {
    port().write(frame);
  } catch (const LinkLost&) {
    port_.reset();
    throw;
  }
  bytes_sent_ += frame.size();
  const std::chrono::duration<double> on_line_s(static_cast<double>(frame.size()) * kBitsPerByte / options_.baud);
  line_is_free_ = std::max(line_is_free_, Clock::now()) + std::chrono::floor<Clock::duration>(on_line_s);
}

std::vector<Acknowledgement> SerialSink::receive() {
  std::vector<std::uint8_t> bytes;
  try {
    bytes = port().read();
  } catch (const LinkLost&) {
    port_.reset();
    throw;
  }
  if (unwrapper_) bytes = unwrapper_->push(bytes);
  std::vector<Acknowledgement> acknowledgements;
  for (const VestAnswer& answer : decoder_.push(bytes)) {
    silent_until_ = Clock::now();
    if (const auto* greeting = std::get_if<Greeting>(&answer))
      greeting_ = *greeting;
    else
      acknowledgements.push_back(std::get<Acknowledgement>(answer));
  }
  return acknowledgements;
}

bool SerialSink::reconnect() {
  if (port_) return true;
  try {
    open();
  } catch (const Error&) {
    port_.reset();  // not there or not accessible yet: a device node gets its group a moment after it appears
    return false;
  }
  ask_again_ = true;
  return true;
}

SerialPort& SerialSink::port() {
  if (!port_) throw LinkLost(options_.path, "the line is lost", "plug the vest in again, and see that it has power");
  return *port_;
}

}  // namespace vestige
