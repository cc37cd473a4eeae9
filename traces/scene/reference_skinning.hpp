#pragma once

#include <cstddef>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <vector>

#include "traces/scene/avatar.hpp"

namespace vestige {

/// What every entry of the palette does to a vertex: the node's world matrix times its inverse bind matrix, in double,
/// relative to the pose's own `origin_m` (glTF 2.0 §3.7.3.3). Precondition: the pose is of this avatar.
void palette_matrices(const Avatar& avatar, const Pose& pose, std::vector<glm::dmat4>& out);

/// One vertex under linear blend skinning, relative to the `origin_m` of the pose that `palette` is of. The sum of
/// w (M p) over its influences, the weights, which are floats, scaled in double so that their sum is 1.
glm::dvec3 skin_vertex(const Avatar& avatar, const std::vector<glm::dmat4>& palette, std::size_t vertex);

/// All vertices under linear blend skinning, in metres from `origin_m` (world), computed in double throughout: what the
/// single-precision skinning is measured against. One entry for each of Avatar::position_bind.
void skin_reference(const Avatar& avatar, const Pose& pose, const glm::dvec3& origin_m, std::vector<glm::dvec3>& out);

}  // namespace vestige
