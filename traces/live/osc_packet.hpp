#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <variant>
#include <vector>

namespace vestige {

/// std::monostate stands for types that nobody here asks for.
using OscArgument = std::variant<std::monostate, std::int32_t, float, double, std::string>;

struct OscMessage {
  std::string address;
  std::vector<OscArgument> arguments;
};

/// Decodes a datagram of Open Sound Control 1.0: a message, or a bundle, whose elements may be bundles again. Whatever
/// time a bundle asks for, its messages are given at once, in order. Throws `mcap::Malformed` where anything in it is
/// not as it must be: then nothing of it counts.
std::vector<OscMessage> decode_osc_packet(std::span<const std::byte> packet);

}  // namespace vestige
