#pragma once

#include <vector>

#include "traces/gltf/gltf_document.hpp"
#include "traces/scene/avatar.hpp"

namespace vestige::gltf {

/// Fills `nodes` and `node_order`. Fails on cycles, on nodes with two parents and on transforms that are none.
void read_nodes(const Document& document, Avatar& avatar, Report& report);

/// For each node whether the default scene shows it (glTF 2.0 §3.5.1): the one named by `scene`, else the first;
/// without any scene, all nodes.
std::vector<bool> nodes_drawn(const Document& document, const Avatar& avatar, Report& report);

/// The affine matrix of 16 numbers in glTF's order. Returns nothing when its last row is not 0 0 0 1.
std::optional<glm::dmat4> affine_matrix(const double* numbers);

}  // namespace vestige::gltf
