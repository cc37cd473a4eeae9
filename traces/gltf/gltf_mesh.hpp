#pragma once

#include <array>
#include <cstddef>
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

/// A primitive as drawn by one node, and its place in the avatar.
struct DrawnPart {
  int node = 0;
  int skin = -1;
  std::size_t mesh = 0;
  std::size_t primitive = 0;
  std::size_t first_vertex = 0;  ///< parts may share their vertices
  std::size_t vertex_count = 0;
  std::size_t first_triangle = 0;
  std::size_t triangle_count = 0;
  bool is_mirrored = false;  ///< the node mirrors: the avatar has the triangles reversed
};

/// What a writer needs besides the avatar.
struct DrawnMeshes {
  std::vector<DrawnPart> parts;                            ///< in the order of their triangles
  std::vector<std::array<float, kMaxInfluences>> weights;  ///< for each vertex: as in the file, not normalised
};

/// Fills palette, vertices and triangles with the meshes of the nodes that are drawn, morphed by their weights at rest.
/// Returns the morph targets of these nodes. The other meshes are checked, too. A mirroring rigid node (whose global
/// matrix at rest has a negative determinant) reverses its triangles, so that their front stays outside (glTF 2.0
/// §3.7.4). Fills `details` unless it is null.
MorphTargets read_meshes(const Document& document, const std::vector<Skin>& skins, const std::vector<bool>& drawn,
                         Avatar& avatar, Report& report, DrawnMeshes* details = nullptr);

}  // namespace vestige::gltf
