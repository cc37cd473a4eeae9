#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string_view>
#include <vector>

#include "traces/scene/avatar.hpp"

namespace vestige {

/// A glTF avatar as one self-contained binary file: a .glb (or .vrm) that is one, byte for byte as it is; otherwise,
/// and for a .gltf, told by its content, packed together with the buffers that are read (images, materials and extras
/// are left out; the same input gives the same bytes). "-" is standard input. Throws `Error`: missing file, no glTF, a
/// buffer that is missing or too short, a URI that leaves the folder.
std::vector<std::byte> read_avatar_glb(const std::filesystem::path& path);

/// The same for what `path` holds; its buffers are looked for beside it.
std::vector<std::byte> pack_avatar_glb(std::vector<std::byte> content, const std::filesystem::path& path);

/// Parses and validates a binary glTF 2.0 file. `name` stands in errors and warnings. Images are never looked at.
///
/// Throws `Error`, naming the JSON field or byte offset, for whatever would make geometry, skin or motion wrong:
/// out-of-range indices, accessors beyond their buffer, non-finite values (those of the rest pose too), node cycles,
/// negative weights, animation times that do not increase, required extensions that are not supported, no triangle at
/// all. What does no harm becomes one of `Avatar::warnings`: unknown properties, wrong min and max, weights whose sum
/// is not 1 (normalised), vertices without any weight (they follow their first joint), joints outside the scene, morph
/// targets and other motion that moves no node.
///
/// `root_node` is the lowest joint without a joint above it of the lowest skin that is drawn; without a skin, the first
/// node that draws. `joint_count` counts all skins. Primitives that share their attributes and skin (or node) share
/// vertices.
Avatar parse_avatar_glb(std::span<const std::byte> glb, std::string_view name);

}  // namespace vestige
