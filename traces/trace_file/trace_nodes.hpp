#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "traces/mcap/record.hpp"

namespace vestige {

/// The nodes that a /pose channel's metadata names, in the order of its poses; nothing where it does not say.
std::optional<std::vector<std::string>> parse_node_names(const mcap::Channel& pose_channel);

/// How many nodes a binary glTF file has (glTF 2.0 §4.4: 12 bytes of header, then a JSON chunk); nothing when it is
/// none, which whoever parses the avatar explains better.
std::optional<std::size_t> glb_node_count(std::span<const std::byte> glb);

}  // namespace vestige
