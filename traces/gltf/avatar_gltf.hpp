#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "traces/scene/avatar.hpp"

namespace vestige {

/// Reads a glTF avatar as one self-contained binary file. A self-contained .glb (or .vrm) is returned unchanged, byte
/// for byte. Any other .glb, and a .gltf (recognised by its content), is packed together with the buffers that are
/// read. Images, materials and extras (but `radius_m` of nodes) are then left out; the same input gives the same bytes.
/// "-" is standard input. Throws `Error` if the file does not exist or is not glTF, a buffer is missing or too short,
/// or a URI leaves the folder.
std::vector<std::byte> read_avatar_glb(const std::filesystem::path& path);

/// Returns the built-in avatar if `avatar` is `kBuiltin`. Otherwise does the same as `read_avatar_glb`.
std::vector<std::byte> read_builtin_or_file(const std::string& avatar);

/// Does the same as `read_avatar_glb` for `content`, which was read from `path`; looks for its buffers beside `path`.
std::vector<std::byte> pack_avatar_glb(std::vector<std::byte> content, const std::filesystem::path& path);

/// Parses and validates a binary glTF 2.0 file. `name` is used in errors and warnings. Images are never read.
///
/// Throws `Error`, with the JSON field or byte offset, for everything that would make geometry, skin or motion wrong:
/// out-of-range indices, accessors beyond their buffer, non-finite values (in the rest pose, too), node cycles,
/// negative weights, animation times that do not increase, required extensions that are not supported, no triangle at
/// all. Harmless faults become `Avatar::warnings`: unknown properties, wrong min and max, weights whose sum is not 1
/// (normalised), vertices without any weight (they follow their first joint), joints outside the scene, misaligned
/// data, motion that moves neither node nor skin.
///
/// The weights of morph targets at rest displace `position_bind` (glTF 2.0 §3.7.2.2). Animated weights are not played:
/// `Animation::morph` names those that would move the skin.
///
/// `root_node` belongs to the skin with the lowest index that is drawn: it is the lowest joint without a joint above
/// it. Without a skin, it is the first node that is drawn. `joint_count` counts all skins. Primitives that share their
/// attributes and skin (or node) share vertices.
Avatar parse_avatar_glb(std::span<const std::byte> glb, std::string_view name);

}  // namespace vestige
