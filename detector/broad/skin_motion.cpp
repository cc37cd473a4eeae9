#include "detector/broad/skin_motion.hpp"

#include "detector/skinning.hpp"

namespace vestige {

void SkinMotion::skin(const Avatar& avatar, const DetectorFrame& frame, Method method) {
  skin_vertices(avatar, frame.palette, now);
  if (method != Method::kStatic) skin_vertices(avatar, frame.palette_before, before);
}

Corners corners_of(const Avatar& avatar, std::span<const glm::vec3> vertices, std::uint32_t triangle) {
  const glm::uvec3& corner = avatar.triangles[triangle];
  return {glm::dvec3(vertices[corner.x]), glm::dvec3(vertices[corner.y]), glm::dvec3(vertices[corner.z])};
}

MovingCorners moving_corners(const Avatar& avatar, const SkinMotion& skin, Method method, std::uint32_t triangle) {
  const Corners now = corners_of(avatar, skin.now, triangle);
  return {method == Method::kStatic ? now : corners_of(avatar, skin.before, triangle), now};
}

MovingCorners skin_corners(const Avatar& avatar, const DetectorFrame& frame, Method method, std::uint32_t triangle) {
  const glm::uvec3& corner = avatar.triangles[triangle];
  const auto skinned = [&](const std::vector<SkinMatrix>& palette) -> Corners {
    return {glm::dvec3(skin_vertex(avatar, palette, corner.x)), glm::dvec3(skin_vertex(avatar, palette, corner.y)),
            glm::dvec3(skin_vertex(avatar, palette, corner.z))};
  };
  const Corners now = skinned(frame.palette);
  return {method == Method::kStatic ? now : skinned(frame.palette_before), now};
}

Corners corners_at(const Corners& before, const Corners& now, float t) {
  const auto at = [t](const glm::dvec3& from, const glm::dvec3& to) {
    return from + static_cast<double>(t) * (to - from);
  };
  return {at(before.a, now.a), at(before.b, now.b), at(before.c, now.c)};
}

glm::dvec3 carried_displacement(const Corners& before, const Corners& now) {
  return (((now.a - before.a) + (now.b - before.b)) + (now.c - before.c)) / 3.0;
}

glm::vec3 carried_start(const glm::vec3& start, const Corners& before, const Corners& now) {
  return {glm::dvec3(start) + carried_displacement(before, now)};
}

}  // namespace vestige
