#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "traces/mcap/record.hpp"

namespace vestige {

/// Returns the node names in a /pose channel's metadata, in the order of its poses. Returns nothing if the metadata
/// does not name them.
std::optional<std::vector<std::string>> parse_node_names(const mcap::Channel& pose_channel);

/// Returns the number of nodes of a binary glTF file (glTF 2.0 §4.4: 12 bytes of header, then a JSON chunk). Returns
/// nothing if the bytes are not such a file; the avatar's parser explains that error better.
std::optional<std::size_t> glb_node_count(std::span<const std::byte> glb);

}  // namespace vestige
