#pragma once

#include <vector>

#include "traces/gltf/gltf_document.hpp"
#include "traces/scene/avatar.hpp"

namespace vestige::gltf {

/// A skin of the file: its joints, and where each one's inverse bind matrix takes a vertex from.
struct Skin {
  std::vector<int> joints;               ///< nodes
  std::vector<glm::dmat4> inverse_bind;  ///< one for each joint
};

/// All skins, drawn or not. Fails on joints that repeat and on inverse bind matrices that are too few, not affine or
/// not finite; warns of joints without a common root and of a wrong `skeleton`, on which nothing here relies.
std::vector<Skin> read_skins(const Document& document, const Avatar& avatar, Report& report);

/// Fills palette, vertices and triangles with the meshes of the nodes that are drawn. The other meshes are checked all
/// the same. A rigid node that mirrors (its global matrix at rest has a negative determinant) turns its triangles
/// around, so that their front stays outside (glTF 2.0 §3.7.4).
void read_meshes(const Document& document, const std::vector<Skin>& skins, const std::vector<bool>& drawn,
                 Avatar& avatar, Report& report);

}  // namespace vestige::gltf
