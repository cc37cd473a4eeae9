#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string_view>
#include <vector>

#include "traces/avatar.hpp"

namespace vestige {

/// A glTF avatar as one self-contained binary file: a .glb (or .vrm) byte for byte as it is; a .gltf packed together with
/// its buffers (images, which detection never reads, are left out). Throws `Error` (missing file, no glTF, a buffer that
/// is missing or too short, a URI that leaves the folder).
std::vector<std::byte> read_avatar_glb(const std::filesystem::path& path);

/// Parses and validates a binary glTF 2.0 file. `name` stands in errors and warnings. Images are never decoded.
///
/// Throws `Error`, naming the JSON field or byte offset, for whatever would make geometry, skin or motion wrong:
/// out-of-range indices, accessors beyond their buffer, non-finite values, node cycles, negative weights, required
/// extensions that are not supported, no triangle at all.
Avatar parse_avatar_glb(std::span<const std::byte> glb, std::string_view name);

}  // namespace vestige
