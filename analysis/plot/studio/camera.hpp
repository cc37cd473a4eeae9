#pragma once

#include <cmath>
#include <cstddef>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <numbers>

#include "traces/scene/facing.hpp"

namespace vestige::plot {

/// A camera infinitely far away, so that equal lengths look equal. The world's y is up.
struct Camera {
  glm::dvec3 right = {1, 0, 0};
  glm::dvec3 up = {0, 1, 0};
  glm::dvec3 toward = {0, 0, 1};  ///< towards the viewer

  /// Azimuth 0 shows the front of an avatar that looks along `facing` at rest, 90 its left side, 180 its back.
  /// Elevation 90 looks down.
  static Camera from(double azimuth_degrees, double elevation_degrees, Facing facing) {
    const double azimuth = (azimuth_degrees + 90 * static_cast<double>(facing)) * std::numbers::pi / 180;
    const double elevation = elevation_degrees * std::numbers::pi / 180;
    Camera camera;
    camera.right = {std::cos(azimuth), 0, -std::sin(azimuth)};
    camera.toward = {std::sin(azimuth) * std::cos(elevation), std::sin(elevation),
                     std::cos(azimuth) * std::cos(elevation)};
    camera.up = glm::cross(camera.toward, camera.right);
    return camera;
  }

  /// Returns the point in camera coordinates: x to the right, y up, z towards the viewer, in the world's unit.
  glm::dvec3 seen(const glm::dvec3& point) const {
    return {glm::dot(point, right), glm::dot(point, up), glm::dot(point, toward)};
  }
};

/// The rectangle of a camera's sight that becomes a picture.
struct View {
  Camera camera;
  double left = 0;  ///< in coordinates of `Camera::seen`
  double bottom = 0;
  double unit_per_dot = 1;
  std::size_t width = 1;  ///< dots
  std::size_t height = 1;
};

}  // namespace vestige::plot
