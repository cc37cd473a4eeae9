#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <optional>

namespace vestige {

/// The linear motion of a point within a frame: from `start` at t = 0 to `end` at t = 1. All coordinates are finite.
struct Way {
  glm::dvec3 start;
  glm::dvec3 end;
};

/// The corners of a triangle. The front is the side from which they run counter-clockwise. All coordinates are finite.
/// Any shape is allowed, including triangles without area.
struct Corners {
  glm::dvec3 a;
  glm::dvec3 b;
  glm::dvec3 c;
};

/// The first time at which a point is on a closed triangle: detector/CONTRACT.md, 4, 5 and 9.
struct FirstContact {
  float t = 0;           ///< the exact time, rounded to nearest-even; never -0
  std::int8_t side = 0;  ///< +1: the point comes from the triangle's front; -1: from its back; 0: it moves in the plane

  friend bool operator==(const FirstContact&, const FirstContact&) = default;
};

/// The answer of the deciding code, correct to the last bit, and how it was found.
struct Decision {
  std::optional<FirstContact> contact;
  bool exact_arithmetic = false;  ///< true if the filter could not decide and exact arithmetic did
};

/// A sphere whose centre moves. The radius is above 0.
struct MovingSphere {
  Way centre;
  double radius = 0;
};

/// The first time at which a sphere and a closed triangle touch: detector/CONTRACT.md, Spheres.
struct FirstTouch {
  float t = 0;            ///< the exact time, rounded to nearest-even; never -0
  std::int8_t side = 0;   ///< +1: the centre is on the triangle's front side; -1: on its back side; 0: in its plane
  bool at_start = false;  ///< whether the exact time is 0: the sphere touches at the start of the frame

  friend bool operator==(const FirstTouch&, const FirstTouch&) = default;
};

/// As `Decision`, for a sphere.
struct SphereDecision {
  std::optional<FirstTouch> touch;
  bool exact_arithmetic = false;
};

/// Decides whether a sphere touches a triangle if both move linearly from t = 0 (`before`) to t = 1 (`after`), and when
/// it first does. For `static` and `carried`, the triangle is the same before and after.
SphereDecision decide_sphere(const MovingSphere& sphere, const Corners& before, const Corners& after);

/// Decides whether the closed segment of `way` meets the closed triangle, and when it first does.
Decision decide_static(const Way& way, const Corners& triangle);

/// Decides whether a point meets a triangle if both move linearly from t = 0 (`before`) to t = 1 (`after`).
Decision decide_ccd(const Way& way, const Corners& before, const Corners& after);

}  // namespace vestige
