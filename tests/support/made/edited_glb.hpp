// Avatars with a changed JSON.

#pragma once

#include <array>
#include <cstddef>
#include <glm/gtc/quaternion.hpp>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "traces/gltf/glb_container.hpp"

namespace vestige::test {

/// Returns the binary glTF with its JSON as `edit` leaves it.
template <typename Edit>
std::vector<std::byte> edited_glb(std::span<const std::byte> glb, const Edit& edit) {
  gltf::Report report("edited.glb");
  const gltf::GlbChunks chunks = gltf::split_glb(glb, report);
  nlohmann::json json = nlohmann::json::parse(chunks.json);
  edit(json);
  return gltf::join_glb(json.dump(), chunks.bin, report);
}

/// Hangs everything that the file's scene shows below a new node.
inline void hang_below(nlohmann::json& json, nlohmann::json node) {
  nlohmann::json& scene = json["scenes"][json.value("scene", std::size_t{0})];
  node["children"] = scene["nodes"];
  scene["nodes"] = {json["nodes"].size()};
  json["nodes"].push_back(std::move(node));
}

/// Returns the avatar turned to its left, by quarters of a turn: one that faced +z faces +x, -z, -x.
inline std::vector<std::byte> turned_glb(std::span<const std::byte> glb, int quarters) {
  constexpr double kHalf = 0.70710678118654752;
  const std::array<std::array<double, 2>, 4> turn = {{{0, 1}, {kHalf, kHalf}, {1, 0}, {kHalf, -kHalf}}};
  const std::array<double, 2>& yw = turn[static_cast<std::size_t>(quarters)];
  return edited_glb(glb, [&](nlohmann::json& json) {
    hang_below(json, {{"name", "turn"}, {"rotation", {0, yw[0], 0, yw[1]}}});
  });
}

/// Returns the avatar turned as a whole about an axis of length 1.
inline std::vector<std::byte> laid_glb(std::span<const std::byte> glb, double degrees, const glm::dvec3& axis) {
  const glm::dquat q = glm::angleAxis(glm::radians(degrees), axis);
  return edited_glb(glb, [&](nlohmann::json& json) {
    hang_below(json, {{"name", "laid"}, {"rotation", {q.x, q.y, q.z, q.w}}});
  });
}

}  // namespace vestige::test
