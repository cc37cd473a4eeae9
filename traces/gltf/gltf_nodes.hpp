#pragma once

#include <vector>

#include "traces/gltf/gltf_document.hpp"
#include "traces/scene/avatar.hpp"

namespace vestige::gltf {

/// Fills `nodes` and `node_order`. Fails on cycles, nodes with two parents, and invalid transforms.
void read_nodes(const Document& document, Avatar& avatar, Report& report);

/// Returns for each node whether the default scene shows it (glTF 2.0 §3.5.1). The default scene is the one named by
/// `scene`, otherwise the first. Without any scene, all nodes are shown.
std::vector<bool> nodes_drawn(const Document& document, const Avatar& avatar, Report& report);

/// Returns the affine matrix of 16 numbers in glTF's order, or nothing if its last row is not 0 0 0 1.
std::optional<glm::dmat4> affine_matrix(const double* numbers);

}  // namespace vestige::gltf
