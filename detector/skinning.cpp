#include "detector/skinning.hpp"

#include <glm/common.hpp>

namespace vestige {

glm::dvec3 bind_extent_m(const Avatar& avatar) {
  glm::dvec3 extent_m(0);
  for (const glm::vec3& position : avatar.position_bind) extent_m = glm::max(extent_m, glm::abs(glm::dvec3(position)));
  return extent_m;
}

glm::dvec3 skin_reach_m(const SkinMatrix& matrix, const glm::dvec3& extent_m) {
  const auto magnitude = [&matrix](std::size_t column) { return glm::abs(glm::dvec3(matrix.column[column])); };
  return magnitude(0) * extent_m.x + magnitude(1) * extent_m.y + magnitude(2) * extent_m.z + magnitude(3);
}

glm::vec3 skin_vertex(const Avatar& avatar, std::span<const SkinMatrix> palette, std::size_t vertex) {
  const Influences& influences = avatar.influences[vertex];
  std::array<glm::vec4, 4> blend = {glm::vec4(0), glm::vec4(0), glm::vec4(0), glm::vec4(0)};
  for (std::size_t k = 0; k < avatar.influence_count; ++k) {
    const SkinMatrix& matrix = palette[influences.palette[k]];
    const float weight = influences.weight[k];
    for (std::size_t column = 0; column < 4; ++column) blend[column] += weight * matrix.column[column];
  }
  const glm::vec3 bind = avatar.position_bind[vertex];
  const glm::vec4 world = ((blend[0] * bind.x + blend[1] * bind.y) + blend[2] * bind.z) + blend[3];
  return {world};
}

}  // namespace vestige
