#pragma once

#include <vector>

#include "traces/gltf/gltf_document.hpp"
#include "traces/gltf/gltf_morph.hpp"
#include "traces/scene/avatar.hpp"

namespace vestige::gltf {

/// A skin of the file: its joints and their inverse bind matrices.
struct Skin {
  std::vector<int> joints;               ///< nodes
  std::vector<glm::dmat4> inverse_bind;  ///< one for each joint
};

/// Reads all skins, drawn or not. Fails if joints repeat, or inverse bind matrices are too few, not affine or not
/// finite. Warns of joints without a common root and of a wrong `skeleton`; nothing here relies on either.
std::vector<Skin> read_skins(const Document& document, const Avatar& avatar, Report& report);

/// Fills palette, vertices and triangles with the meshes of the nodes that are drawn, morphed by their weights at rest.
/// Returns the morph targets of these nodes. The other meshes are checked, too. A mirroring rigid node (whose global
/// matrix at rest has a negative determinant) reverses its triangles, so that their front stays outside (glTF 2.0
/// §3.7.4).
MorphTargets read_meshes(const Document& document, const std::vector<Skin>& skins, const std::vector<bool>& drawn,
                         Avatar& avatar, Report& report);

}  // namespace vestige::gltf
