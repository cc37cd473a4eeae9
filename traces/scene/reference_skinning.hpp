#pragma once

#include <cstddef>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <vector>

#include "traces/scene/avatar.hpp"
#include "traces/scene/box.hpp"

namespace vestige {

/// Returns in `out` the skinning matrix of every palette entry: the node's world matrix times its inverse bind matrix,
/// in double, relative to the pose's own `origin_m` (glTF 2.0 §3.7.3.3). Precondition: `pose` belongs to `avatar`.
void palette_matrices(const Avatar& avatar, const Pose& pose, std::vector<glm::dmat4>& out);

/// Returns one vertex under linear blend skinning, relative to the `origin_m` of the pose behind `palette`. It is the
/// sum of w (M p) over the vertex's influences. The weights are floats, so they are scaled in double to sum to 1.
glm::dvec3 skin_vertex(const Avatar& avatar, const std::vector<glm::dmat4>& palette, std::size_t vertex);

/// Returns in `out` all vertices under linear blend skinning, in metres from `origin_m` (world), one for each of
/// Avatar::position_bind. Computed entirely in double, as the reference for single-precision skinning.
void skin_reference(const Avatar& avatar, const Pose& pose, const glm::dvec3& origin_m, std::vector<glm::dvec3>& out);

/// Returns all vertices in the rest pose, as `skin_reference` does, in metres.
std::vector<glm::dvec3> skin_at_rest(const Avatar& avatar);

/// Returns the box around the skin at rest, in metres. Precondition: the avatar has vertices.
Box rest_box(const Avatar& avatar);

}  // namespace vestige
