#include "traces/live/osc_packet.hpp"

#include <lo/lo.h>

#include <cstring>
#include <memory>
#include <string_view>

#include "traces/mcap/decode.hpp"

namespace vestige {

namespace {

using mcap::Malformed;

constexpr std::string_view kBundle("#bundle\0", 8);
constexpr std::size_t kTimeTagBytes = 8;
constexpr int kDeepest = 8;  ///< bundles within bundles
constexpr std::size_t kMostMessages = 4096;

struct FreeMessage {
  void operator()(lo_message message) const { lo_message_free(message); }
};

std::uint32_t big_endian(std::span<const std::byte> bytes) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < sizeof value; ++i) value = value << 8U | std::to_integer<std::uint32_t>(bytes[i]);
  return value;
}

/// Reads an argument, which is aligned to 4 bytes; a double needs more.
template <typename Number>
Number copied(const lo_arg* argument) {
  Number value = 0;
  std::memcpy(&value, argument, sizeof value);
  return value;
}

OscArgument argument_of(char type, const lo_arg* argument) {
  switch (type) {
    case LO_INT32:
      return copied<std::int32_t>(argument);
    case LO_FLOAT:
      return copied<float>(argument);
    case LO_DOUBLE:
      return copied<double>(argument);
    case LO_STRING:
    case LO_SYMBOL:
      return std::string(reinterpret_cast<const char*>(argument));
    default:
      return std::monostate();
  }
}

OscMessage decode_message(std::span<const std::byte> bytes) {
  // liblo checks every string and argument against the remaining bytes. It writes nothing, but its interface is not
  // const.
  std::vector<std::byte> copy(bytes.begin(), bytes.end());
  if (copy.empty() || copy.front() != std::byte{'/'})
    throw Malformed("a message's address does not begin with a slash");
  int failure = 0;
  const std::unique_ptr<void, FreeMessage> message(lo_message_deserialise(copy.data(), copy.size(), &failure));
  if (!message) throw Malformed("a message is not valid OSC");
  OscMessage decoded;
  decoded.address = reinterpret_cast<const char*>(copy.data());  // terminated within the bytes, as liblo has checked
  const char* types = lo_message_get_types(message.get());
  lo_arg** const arguments = lo_message_get_argv(message.get());
  const int count = lo_message_get_argc(message.get());
  for (int i = 0; i < count; ++i) decoded.arguments.push_back(argument_of(types[i], arguments[i]));
  return decoded;
}

void decode(std::span<const std::byte> packet, int depth, std::vector<OscMessage>& out) {
  const bool is_bundle =
      packet.size() >= kBundle.size() && std::memcmp(packet.data(), kBundle.data(), kBundle.size()) == 0;
  if (!is_bundle) {
    if (out.size() == kMostMessages) throw Malformed("it has too many messages");
    out.push_back(decode_message(packet));
    return;
  }
  if (depth == kDeepest) throw Malformed("its bundles are nested too deep");
  if (packet.size() < kBundle.size() + kTimeTagBytes) throw Malformed("a bundle is too short for its time tag");
  packet = packet.subspan(kBundle.size() + kTimeTagBytes);
  while (!packet.empty()) {
    if (packet.size() < sizeof(std::uint32_t)) throw Malformed("a bundle ends inside an element's size");
    const std::uint32_t size = big_endian(packet);
    packet = packet.subspan(sizeof size);
    if (size > packet.size()) throw Malformed("an element is longer than the rest of its bundle");
    decode(packet.first(size), depth + 1, out);
    packet = packet.subspan(size);
  }
}

}  // namespace

std::vector<OscMessage> decode_osc_packet(std::span<const std::byte> packet) {
  std::vector<OscMessage> messages;
  decode(packet, 0, messages);
  return messages;
}

}  // namespace vestige
