#include "analysis/plot/scene/crowd.hpp"

#include <algorithm>
#include <cmath>
#include <glm/mat4x4.hpp>
#include <utility>

namespace vestige::plot {

namespace {

glm::dvec3 root_of(const Avatar& avatar, const Pose& pose) {
  std::vector<glm::dmat4> world;
  world_matrices(avatar, pose, world);
  const glm::dvec3 root(world[static_cast<std::size_t>(avatar.root_node)][3]);
  const glm::dvec3 at = pose.origin_m + root;
  return std::isfinite(at.x + at.y + at.z) ? at : pose.origin_m;
}

}  // namespace

std::size_t Crowd::person_of(std::uint32_t triangle) const {
  return static_cast<std::size_t>(std::ranges::upper_bound(first_triangle, triangle) - first_triangle.begin()) - 1;
}

CrowdPoser::CrowdPoser(const std::vector<Subject>& subjects) {
  for (const Subject& subject : subjects) posers_.emplace_back(subject.avatar);
}

Crowd CrowdPoser::pose(const std::vector<Pose>& poses, const glm::dvec3& origin_m) const {
  Crowd crowd;
  crowd.origin_m = origin_m;
  for (std::size_t i = 0; i < posers_.size(); ++i) {
    crowd.first_triangle.push_back(static_cast<std::uint32_t>(crowd.surface.triangles.size()));
    if (poses[i].nodes.empty()) continue;
    Surface surface = posers_[i].pose(poses[i], origin_m);
    if (crowd.surface.triangles.empty())
      crowd.surface = std::move(surface);
    else
      crowd.surface.append(surface);
  }
  crowd.first_triangle.push_back(static_cast<std::uint32_t>(crowd.surface.triangles.size()));
  return crowd;
}

glm::dvec3 standing_at(const std::vector<Subject>& subjects, const std::vector<Pose>& poses) {
  for (std::size_t i = 0; i < subjects.size(); ++i)
    if (!poses[i].nodes.empty()) return root_of(subjects[i].avatar, poses[i]);
  return glm::dvec3(0);
}

}  // namespace vestige::plot
