#include "transport/sinks/osc_sink.hpp"

#include <exception>
#include <thread>
#include <utility>

#include "transport/sinks/osc_message.hpp"

namespace vestige {

namespace {

std::vector<std::byte> message_of(const std::string& address, OscValue value, std::uint8_t level) {
  OscMessageBuilder message;
  switch (value) {
    case OscValue::kFloat:
      message.add(static_cast<float>(level) / 255.0F);
      break;
    case OscValue::kInteger:
      message.add(std::int32_t{level});
      break;
    case OscValue::kBoolean:
      message.add_switch(level != 0);
      break;
  }
  return message.bytes(address);
}

}  // namespace

OscSink::OscSink(OscOptions options, const std::vector<std::string>& actuator_names)
    : options_(std::move(options)),
      addresses_(osc_addresses(options_.address_template, actuator_names)),
      out_({.host = options_.host, .port = options_.port}, osc_url(options_)),
      watchdog_(out_.route(), datagrams_of({}), options_.ttl) {}

void OscSink::send(const ActuatorFrame& frame, std::uint8_t) {
  watchdog_.note_on();
  send_levels(frame.duty);
}

void OscSink::send_off(std::uint8_t) {
  std::exception_ptr failure;
  for (int i = 0; i < kFinalTries; ++i) {
    if (i != 0) std::this_thread::sleep_for(kBetweenFinalTries);
    watchdog_.note_on();
    try {
      send_levels({});
      failure = nullptr;
    } catch (const Error&) {
      failure = std::current_exception();  // the next one may get through
    }
  }
  if (failure) std::rethrow_exception(failure);
  watchdog_.note_off();
}

void OscSink::send_levels(std::span<const std::uint8_t> level) {
  for (const std::vector<std::byte>& datagram : datagrams_of(level)) out_.send(datagram);
}

std::vector<std::vector<std::byte>> OscSink::datagrams_of(std::span<const std::uint8_t> level) const {
  std::vector<std::vector<std::byte>> messages;
  messages.reserve(addresses_.size());
  for (std::size_t i = 0; i < addresses_.size(); ++i)
    messages.push_back(message_of(addresses_[i], options_.value, i < level.size() ? level[i] : std::uint8_t{0}));
  return pack_osc(messages);
}

}  // namespace vestige
