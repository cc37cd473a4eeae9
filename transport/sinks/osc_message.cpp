#include "transport/sinks/osc_message.hpp"

#include <lo/lo.h>

#include <string_view>

namespace vestige {

namespace {

/// An Ethernet packet of 1500 bytes, less the headers of IPv6, UDP and a tunnel.
constexpr std::size_t kMostDatagramBytes = 1400;

/// OSC 1.0: how a bundle begins that is to be executed at once.
constexpr std::string_view kBundleHead("#bundle\0\0\0\0\0\0\0\0\1", 16);

void append_big_endian(std::vector<std::byte>& out, std::size_t value) {
  for (const unsigned shift : {24U, 16U, 8U, 0U}) out.push_back(static_cast<std::byte>(value >> shift));
}

}  // namespace

void OscMessageBuilder::Free::operator()(void* message) const {
  lo_message_free(message);
}

OscMessageBuilder::OscMessageBuilder() : message_(lo_message_new()) {}

OscMessageBuilder& OscMessageBuilder::add(float value) {
  lo_message_add_float(message_.get(), value);
  return *this;
}

OscMessageBuilder& OscMessageBuilder::add(double value) {
  lo_message_add_double(message_.get(), value);
  return *this;
}

OscMessageBuilder& OscMessageBuilder::add(std::int32_t value) {
  lo_message_add_int32(message_.get(), value);
  return *this;
}

OscMessageBuilder& OscMessageBuilder::add(const std::string& value) {
  lo_message_add_string(message_.get(), value.c_str());
  return *this;
}

OscMessageBuilder& OscMessageBuilder::add_switch(bool value) {
  value ? lo_message_add_true(message_.get()) : lo_message_add_false(message_.get());
  return *this;
}

std::vector<std::byte> OscMessageBuilder::bytes(const std::string& address) const {
  std::size_t size = lo_message_length(message_.get(), address.c_str());
  std::vector<std::byte> bytes(size);
  lo_message_serialise(message_.get(), address.c_str(), bytes.data(), &size);
  return bytes;
}

std::vector<std::vector<std::byte>> pack_osc(std::span<const std::vector<std::byte>> messages) {
  std::vector<std::vector<std::byte>> bundles;
  for (const std::vector<std::byte>& message : messages) {
    if (bundles.empty() || bundles.back().size() + sizeof(std::uint32_t) + message.size() > kMostDatagramBytes) {
      std::vector<std::byte>& bundle = bundles.emplace_back();
      for (const char letter : kBundleHead) bundle.push_back(static_cast<std::byte>(letter));
    }
    append_big_endian(bundles.back(), message.size());
    bundles.back().insert(bundles.back().end(), message.begin(), message.end());
  }
  return bundles;
}

}  // namespace vestige
