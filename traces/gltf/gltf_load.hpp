#pragma once

#include <cstddef>
#include <span>
#include <string_view>
#include <vector>

#include "traces/gltf/gltf_document.hpp"
#include "traces/gltf/gltf_mesh.hpp"

namespace vestige::gltf {

struct LoadedAvatar {
  Document document;  ///< keeps references to the file's bytes
  Avatar avatar;
  std::vector<Skin> skins;  ///< all skins of the file, drawn or not
};

/// Does what `parse_avatar_glb` does, and returns more. Fills `details` unless it is null.
LoadedAvatar load_avatar(std::span<const std::byte> glb, std::string_view name, DrawnMeshes* details = nullptr);

}  // namespace vestige::gltf
