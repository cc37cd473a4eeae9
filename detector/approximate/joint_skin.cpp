#include "detector/approximate/joint_skin.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/matrix.hpp>
#include <glm/vec4.hpp>
#include <map>

#include "traces/scene/pose.hpp"
#include "traces/scene/reference_skinning.hpp"

namespace vestige {

namespace {

std::size_t joint_of(const Avatar& avatar, const glm::uvec3& triangle) {
  std::map<std::uint16_t, double> weight;
  for (const std::uint32_t vertex : {triangle.x, triangle.y, triangle.z})
    for (std::size_t i = 0; i < avatar.influence_count; ++i)
      weight[avatar.influences[vertex].palette[i]] += static_cast<double>(avatar.influences[vertex].weight[i]);
  return std::ranges::max_element(weight, {}, [](const auto& entry) { return entry.second; })->first;
}

}  // namespace

std::vector<JointSkin> skin_by_joint(const Avatar& avatar) {
  const Pose pose = rest_pose(avatar);
  std::vector<glm::dvec3> at_rest;
  skin_reference(avatar, pose, glm::dvec3(0), at_rest);
  std::vector<glm::dmat4> palette;
  palette_matrices(avatar, pose, palette);

  std::vector<JointSkin> skins(avatar.palette.size());
  for (std::size_t i = 0; i < skins.size(); ++i) skins[i].palette = i;
  for (std::uint32_t i = 0; i < avatar.triangles.size(); ++i)
    skins[joint_of(avatar, avatar.triangles[i])].triangles.push_back(i);
  for (JointSkin& skin : skins) {
    const double scale = glm::determinant(glm::dmat3(palette[skin.palette]));
    if (!std::isnormal(scale)) {
      skin.triangles.clear();
      continue;
    }
    const glm::dmat4 to_bind = glm::inverse(palette[skin.palette]);
    const auto bound = [&](std::uint32_t vertex) { return glm::dvec3(to_bind * glm::dvec4(at_rest[vertex], 1)); };
    for (const std::uint32_t number : skin.triangles) {
      const glm::uvec3& triangle = avatar.triangles[number];
      skin.corners.push_back({bound(triangle.x), bound(triangle.y), bound(triangle.z)});
    }
  }
  std::erase_if(skins, [](const JointSkin& skin) { return skin.triangles.empty(); });
  return skins;
}

}  // namespace vestige
