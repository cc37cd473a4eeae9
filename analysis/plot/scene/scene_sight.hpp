#pragma once

#include <cstddef>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <limits>

#include "analysis/plot/studio/camera.hpp"
#include "analysis/plot/studio/surface.hpp"

namespace vestige::plot {

/// The side from which scenes are drawn unless another is asked for: half-left of one person. Several people are drawn
/// from the right of the first, because most people reach out with their right hand, which then hides nothing.
inline constexpr double kAzimuthDegrees = 35;
inline constexpr double kAzimuthOfSeveralDegrees = -70;
inline constexpr double kElevationDegrees = 14;

/// What the pictures of a scene show. Lengths are in metres, places relative to the surfaces' origin.
struct SceneSight {
  Camera camera;
  double ground_y_m = 0;
  double extent_m = 1;                  ///< the largest extent of a surface
  bool follows = false;                 ///< the camera goes along with the people
  glm::dvec3 middle_m = glm::dvec3(0);  ///< stays in place in the pictures; only its height if the camera goes along
  glm::dvec2 low_m = glm::dvec2(0);     ///< the pictures' lower left corner, from what stays in place
  glm::dvec2 size_m = glm::dvec2(1);    ///< width and height that must be seen

  /// Returns the view of one picture, with the people in its middle from left to right, and the ground at its foot.
  View view_of(const Surface& surface, std::size_t width_dots, std::size_t height_dots, double m_per_dot) const;
};

/// Finds what a camera must show so that all moments of a scene have room.
class SightFinder {
 public:
  explicit SightFinder(const Camera& camera);

  /// Takes the people at one moment.
  void add(const Surface& surface);
  /// Precondition: `add` was called. A camera follows people who cover much ground; otherwise they are seen to move.
  SceneSight sight() const;

 private:
  /// A rectangle of the camera's sight.
  struct Seen {
    glm::dvec2 low = glm::dvec2(std::numeric_limits<double>::max());
    glm::dvec2 high = -glm::dvec2(std::numeric_limits<double>::max());
    void add(const glm::dvec2& point);
  };

  Camera camera_;
  glm::dvec3 low_ = glm::dvec3(std::numeric_limits<double>::max());
  glm::dvec3 high_ = -glm::dvec3(std::numeric_limits<double>::max());
  glm::dvec3 largest_ = glm::dvec3(0);
  Seen standing_;   ///< by a camera that stands still
  Seen following_;  ///< from the middle of each surface on the ground's plane
};

}  // namespace vestige::plot
