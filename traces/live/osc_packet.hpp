#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <variant>
#include <vector>

namespace vestige {

/// std::monostate represents the types that this program does not use.
using OscArgument = std::variant<std::monostate, std::int32_t, float, double, std::string>;

struct OscMessage {
  std::string address;
  std::vector<OscArgument> arguments;
};

/// Decodes a datagram of Open Sound Control 1.0: a message, or a bundle, whose elements may be bundles again. Returns
/// the messages of a bundle at once and in order, whatever time the bundle asks for. Throws `mcap::Malformed` if any
/// part of the datagram is invalid; then no part of it counts.
std::vector<OscMessage> decode_osc_packet(std::span<const std::byte> packet);

}  // namespace vestige
