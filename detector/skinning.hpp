#pragma once

#include <array>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <span>
#include <vector>

#include "traces/scene/avatar.hpp"

namespace vestige {

/// An affine matrix in fp32, by columns; the fourth component of each is padding (std430 layout of the shaders).
struct SkinMatrix {
  std::array<glm::vec4, 4> column;
};

/// The joint palette of detector/CONTRACT.md, 3: world matrix times inverse bind matrix in double, moved by
/// `offset_m` (pose origin minus frame origin), rounded once. `world` is what `world_matrices` gave.
void build_palette(const Avatar& avatar, std::span<const glm::dmat4> world, const glm::dvec3& offset_m,
                   std::vector<SkinMatrix>& out);

/// The largest absolute coordinates of the bind pose.
glm::dvec3 bind_extent_m(const Avatar& avatar);

/// No coordinate of M x, nor any part of its sum, is larger than this for any x within +-`extent_m`.
glm::dvec3 skin_reach_m(const SkinMatrix& matrix, const glm::dvec3& extent_m);

/// Linear blend skinning of one vertex in fp32, in the one order that every detector keeps: columns are blended over
/// the influences from zero upwards, then ((c0 x + c1 y) + c2 z) + c3, never contracted to fma. Padding influences of
/// weight 0 change no bit, since a sum that starts at +0 never is -0.
glm::vec3 skin_vertex(const Avatar& avatar, std::span<const SkinMatrix> palette, std::size_t vertex);

/// All vertices, to the bits of `skin_vertex`.
void skin_vertices(const Avatar& avatar, std::span<const SkinMatrix> palette, std::vector<glm::vec3>& out);

}  // namespace vestige
