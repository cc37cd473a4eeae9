#pragma once

#include <array>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <optional>
#include <span>
#include <vector>

#include "traces/scene/avatar.hpp"

namespace vestige {

/// An affine matrix in fp32, stored by columns. The fourth component of each column is padding (std430 layout of the
/// shaders).
struct SkinMatrix {
  std::array<glm::vec4, 4> column;
};

/// Computes the joint palette of detector/CONTRACT.md, 3: world matrix times inverse bind matrix in double, moved by
/// `offset_m` (pose origin minus frame origin), rounded once to fp32. `world` is the output of `world_matrices`.
void build_palette(const Avatar& avatar, std::span<const glm::dmat4> world, const glm::dvec3& offset_m,
                   std::vector<SkinMatrix>& out);

/// Returns the largest absolute coordinates of the bind pose, for each axis.
glm::dvec3 bind_extent_m(const Avatar& avatar);

/// Returns an upper bound for each coordinate of M x, and for every part of its sum, over all x within +-`extent_m`.
glm::dvec3 skin_reach_m(const SkinMatrix& matrix, const glm::dvec3& extent_m);

/// Returns the largest of these bounds, and of the matrices' numbers, over a palette: how far a skinned vertex can be
/// from the origin along each axis, with any influences; rounding adds a little, as weights sum to 1 only almost.
/// Returns nothing unless all are below `limit_m`.
std::optional<glm::dvec3> palette_reach_m(std::span<const SkinMatrix> palette, const glm::dvec3& extent_m,
                                          double limit_m);

/// Linear blend skinning of one vertex in fp32. Every detector keeps this order: blend the columns over the influences
/// from zero upwards, then compute ((c0 x + c1 y) + c2 z) + c3, never contracted to fma. Padding influences of weight 0
/// change no bit, because a sum that starts at +0 is never -0.
glm::vec3 skin_vertex(const Avatar& avatar, std::span<const SkinMatrix> palette, std::size_t vertex);

/// Skins all vertices, with the same bits as `skin_vertex`. All numbers of the palette must be finite.
void skin_vertices(const Avatar& avatar, std::span<const SkinMatrix> palette, std::vector<glm::vec3>& out);

/// As above. `out` has as many elements as the avatar has vertices.
void skin_vertices(const Avatar& avatar, std::span<const SkinMatrix> palette, std::span<glm::vec3> out);

}  // namespace vestige
