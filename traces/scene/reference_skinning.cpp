#include "traces/scene/reference_skinning.hpp"

namespace vestige {

void palette_matrices(const Avatar& avatar, const Pose& pose, std::vector<glm::dmat4>& out) {
  std::vector<glm::dmat4> world;
  world_matrices(avatar, pose, world);
  out.clear();
  out.reserve(avatar.palette.size());
  for (const PaletteEntry& entry : avatar.palette)
    out.push_back(world[static_cast<std::size_t>(entry.node)] * entry.inverse_bind);
}

glm::dvec3 skin_vertex(const Avatar& avatar, const std::vector<glm::dmat4>& palette, std::size_t vertex) {
  const Influences& influences = avatar.influences[vertex];
  const glm::dvec4 bind(glm::dvec3(avatar.position_bind[vertex]), 1);
  glm::dvec3 position(0);
  double weight_sum = 0;
  for (std::size_t k = 0; k < kMaxInfluences && influences.weight[k] > 0; ++k) {
    const double weight = double{influences.weight[k]};
    position += weight * glm::dvec3(palette[influences.palette[k]] * bind);
    weight_sum += weight;
  }
  return position / weight_sum;
}

void skin_reference(const Avatar& avatar, const Pose& pose, const glm::dvec3& origin_m, std::vector<glm::dvec3>& out) {
  std::vector<glm::dmat4> palette;
  palette_matrices(avatar, pose, palette);
  const glm::dvec3 shift = pose.origin_m - origin_m;
  out.clear();
  out.reserve(avatar.position_bind.size());
  for (std::size_t vertex = 0; vertex < avatar.position_bind.size(); ++vertex)
    out.push_back(skin_vertex(avatar, palette, vertex) + shift);
}

std::vector<glm::dvec3> skin_at_rest(const Avatar& avatar) {
  std::vector<glm::dvec3> positions;
  skin_reference(avatar, rest_pose(avatar), glm::dvec3(0), positions);
  return positions;
}

Box rest_box(const Avatar& avatar) {
  return box_around(skin_at_rest(avatar));
}

}  // namespace vestige
