#include "detector/approximate/skin_spots.hpp"

#include <algorithm>
#include <cstddef>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <utility>

#include "detector/nearest_in_triangle.hpp"

namespace vestige {

namespace {

Box box_around(std::span<const Corners> triangles) {
  Box box = {triangles.front().a, triangles.front().a};
  for (const auto& [a, b, c] : triangles)
    for (const glm::dvec3& corner : {a, b, c}) box = {glm::min(box.low, corner), glm::max(box.high, corner)};
  return box;
}

struct Nearest {
  std::uint32_t triangle = 0;
  glm::dvec3 weight = glm::dvec3(1, 0, 0);  ///< of the corners
  double distance_squared = std::numeric_limits<double>::infinity();
};

void look_in(const RestPatch& patch, const glm::dvec3& point, Nearest& nearest) {
  if (!(patch.distance_squared_at_least(point) < nearest.distance_squared)) return;
  for (std::size_t i = 0; i < patch.triangles().size(); ++i) {
    const auto& [a, b, c] = patch.corners()[i];
    const glm::dvec3 weight = nearest_in_triangle(point, patch.corners()[i]);
    const glm::dvec3 away = weight.x * a + weight.y * b + weight.z * c - point;
    const double distance_squared = glm::dot(away, away);
    if (distance_squared < nearest.distance_squared) nearest = {patch.triangles()[i], weight, distance_squared};
  }
}

}  // namespace

RestPatch::RestPatch(std::vector<std::uint32_t> triangles, std::vector<Corners> corners)
    : triangles_(std::move(triangles)), corners_(std::move(corners)), box_(box_around(corners_)) {}

double RestPatch::distance_squared_at_least(const glm::dvec3& point) const {
  const glm::dvec3 away = point - glm::clamp(point, box_.low, box_.high);
  return glm::dot(away, away);
}

SkinSpot nearest_spot(const Avatar& avatar, const ActuatorMap& map, std::span<const RestPatch> patches,
                      const glm::dvec3& point) {
  Nearest nearest;
  // Where the nearest one probably is, so that most others need no look.
  look_in(
      *std::ranges::min_element(patches, {}, [&](const RestPatch& p) { return p.distance_squared_at_least(point); }),
      point, nearest);
  for (const RestPatch& patch : patches) look_in(patch, point, nearest);

  SkinSpot spot;
  spot.triangle = nearest.triangle;
  spot.barycentric = {nearest.weight.y, nearest.weight.z};
  const glm::uvec3& corner = avatar.triangles[spot.triangle];
  spot.texture_coordinate = nearest.weight.x * glm::dvec2(avatar.texture_coordinate[corner.x]) +
                            nearest.weight.y * glm::dvec2(avatar.texture_coordinate[corner.y]) +
                            nearest.weight.z * glm::dvec2(avatar.texture_coordinate[corner.z]);
  spot.actuator = map.at(spot.triangle, spot.texture_coordinate);
  return spot;
}

void put_spot(const SkinSpot& spot, Contact& contact) {
  contact.triangle = spot.triangle;
  contact.barycentric = spot.barycentric;
  contact.texture_coordinate = spot.texture_coordinate;
  contact.actuator = spot.actuator;
}

}  // namespace vestige
