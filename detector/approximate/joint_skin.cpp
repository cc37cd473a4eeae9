#include "detector/approximate/joint_skin.hpp"

#include <algorithm>
#include <cmath>
#include <glm/matrix.hpp>
#include <glm/vec4.hpp>
#include <map>
#include <utility>

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
  const std::vector<glm::dvec3> at_rest = skin_at_rest(avatar);
  std::vector<glm::dmat4> palette;
  palette_matrices(avatar, rest_pose(avatar), palette);

  std::vector<std::vector<std::uint32_t>> moved(avatar.palette.size());
  for (std::uint32_t i = 0; i < avatar.triangles.size(); ++i) moved[joint_of(avatar, avatar.triangles[i])].push_back(i);
  std::vector<JointSkin> skins;
  for (std::size_t i = 0; i < moved.size(); ++i) {
    if (moved[i].empty() || !std::isnormal(glm::determinant(glm::dmat3(palette[i])))) continue;
    const glm::dmat4 to_bind = glm::inverse(palette[i]);
    const auto bound = [&](std::uint32_t vertex) { return glm::dvec3(to_bind * glm::dvec4(at_rest[vertex], 1)); };
    std::vector<Corners> corners;
    for (const std::uint32_t number : moved[i]) {
      const glm::uvec3& triangle = avatar.triangles[number];
      corners.push_back({bound(triangle.x), bound(triangle.y), bound(triangle.z)});
    }
    skins.push_back({i, RestPatch(std::move(moved[i]), std::move(corners))});
  }
  return skins;
}

}  // namespace vestige
