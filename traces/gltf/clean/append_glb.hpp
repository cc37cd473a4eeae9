#pragma once

#include <vector>

#include "traces/gltf/clean/glb_builder.hpp"

namespace vestige::gltf {

/// Where the nodes of an appended file are.
struct AppendedNodes {
  int first = 0;           ///< the index of its node 0; the others follow
  std::vector<int> roots;  ///< indices in the file that it was appended to
};

/// Appends what `clean_avatar_glb` wrote to another file: nodes, meshes, skins, materials, textures. No scene has the
/// new nodes yet. Leaves out animations and VRM's roles.
AppendedNodes append_glb(GlbBuilder& builder, GlbBuilder other);

}  // namespace vestige::gltf
