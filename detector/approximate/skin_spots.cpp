#include "detector/approximate/skin_spots.hpp"

#include <cstddef>
#include <glm/geometric.hpp>
#include <limits>

#include "detector/nearest_in_triangle.hpp"

namespace vestige {

SkinSpot nearest_spot(const Avatar& avatar, const ActuatorMap& map, const JointSkin& skin, const glm::dvec3& point) {
  std::size_t nearest = 0;
  glm::dvec3 weight(1, 0, 0);
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < skin.triangles.size(); ++i) {
    const auto& [a, b, c] = skin.corners[i];
    const glm::dvec3 of_corners = nearest_in_triangle(point, skin.corners[i]);
    const glm::dvec3 away = of_corners.x * a + of_corners.y * b + of_corners.z * c - point;
    const double distance_squared = glm::dot(away, away);
    if (!(distance_squared < least)) continue;
    nearest = i;
    weight = of_corners;
    least = distance_squared;
  }
  SkinSpot spot;
  spot.triangle = skin.triangles[nearest];
  spot.barycentric = {weight.y, weight.z};
  const glm::uvec3& corner = avatar.triangles[spot.triangle];
  spot.texture_coordinate = weight.x * glm::dvec2(avatar.texture_coordinate[corner.x]) +
                            weight.y * glm::dvec2(avatar.texture_coordinate[corner.y]) +
                            weight.z * glm::dvec2(avatar.texture_coordinate[corner.z]);
  spot.actuator = map.at(spot.triangle, spot.texture_coordinate);
  return spot;
}

}  // namespace vestige
