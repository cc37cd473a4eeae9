#include "traces/viz/viz_bodies.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/mat3x3.hpp>
#include <set>
#include <utility>

#include "traces/viz/viz_format.hpp"

namespace vestige {

namespace {

constexpr const char* kAvatar = "avatar";

VizPlacement placement_of(const glm::dmat4& matrix) {
  VizPlacement placement = {.position_m = glm::dvec3(matrix[3])};
  const glm::dmat3 axes(matrix);
  const glm::dvec3 lengths(glm::length(axes[0]), glm::length(axes[1]), glm::length(axes[2]));
  if (!(std::min({lengths.x, lengths.y, lengths.z}) > 0) || !(glm::determinant(axes) > 0)) return placement;
  const glm::dquat rotation = glm::quat_cast(glm::dmat3(axes[0] / lengths.x, axes[1] / lengths.y, axes[2] / lengths.z));
  const double length = glm::length(rotation);
  if (std::isfinite(length) && length > 0) placement.rotation = rotation / length;
  return placement;
}

bool is_finite(const glm::dmat4& matrix) {
  for (int column = 0; column < 4; ++column)
    if (!is_drawable(glm::dvec3(matrix[column]))) return false;
  return true;
}

std::vector<std::string> frame_names(const Avatar& avatar, const std::string& prefix, std::set<std::string>& taken) {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < avatar.nodes.size(); ++i) {
    std::string name = prefix + avatar.nodes[i].name;
    if (name == prefix || taken.contains(name)) name = fmt::format("{}#{}", name, i);
    while (!taken.insert(name).second) name += '_';
    names.push_back(std::move(name));
  }
  return names;
}

}  // namespace

bool is_drawable(const glm::dvec3& place) {
  return std::isfinite(place.x) && std::isfinite(place.y) && std::isfinite(place.z);
}

std::string viz_name(std::string_view name, std::size_t person) {
  return person == 0 ? std::string(name) : fmt::format("{} {}", name, person + 1);
}

VizBodies::VizBodies(const std::vector<const Avatar*>& avatars) {
  std::set<std::string> taken = {viz_format::kWorld, viz_format::kUpright};
  for (std::size_t person = 0; person < avatars.size(); ++person) taken.insert(viz_name(kAvatar, person));
  for (std::size_t person = 0; person < avatars.size(); ++person) {
    VizBody& body = people_.emplace_back();
    body.skeleton.nodes = avatars[person]->nodes;
    body.skeleton.node_order = avatars[person]->node_order;
    body.skeleton.root_node = avatars[person]->root_node;
    body.frame = viz_name(kAvatar, person);
    body.node_frames = frame_names(*avatars[person], person == 0 ? "" : fmt::format("{}/", person + 1), taken);
  }
}

void VizBodies::take(const TraceFrame& frame) {
  for (std::size_t person = 0; person < people_.size(); ++person) {
    VizBody& body = people_[person];
    body.world.clear();
    body.node_placement.clear();
    const Pose& pose = frame.poses[person];
    if (pose.nodes.empty() || !is_drawable(pose.origin_m)) continue;
    world_matrices(body.skeleton, pose, body.world);
    if (!std::ranges::all_of(body.world, is_finite)) body.world.clear();
    for (const glm::dmat4& matrix : body.world) body.node_placement.push_back(placement_of(matrix));
  }
}

}  // namespace vestige
