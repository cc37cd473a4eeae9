#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <optional>

namespace vestige {

/// The way of a point within a frame: from `start` at t = 0 to `end` at t = 1, linearly. Finite.
struct Way {
  glm::dvec3 start;
  glm::dvec3 end;
};

/// The corners of a triangle, in order: its front is where they run counter-clockwise. Finite; any shape, without area
/// too.
struct Corners {
  glm::dvec3 a;
  glm::dvec3 b;
  glm::dvec3 c;
};

/// The first time at which a point is on a closed triangle: detector/CONTRACT.md, 4, 5 and 9.
struct FirstContact {
  float t = 0;           ///< the exact time, rounded to nearest-even; never -0
  std::int8_t side = 0;  ///< +1 it comes from the triangle's front, -1 from its back, 0 it moves in the plane

  friend bool operator==(const FirstContact&, const FirstContact&) = default;
};

/// What the deciding code answers, right to the last bit, and what the answer took.
struct Decision {
  std::optional<FirstContact> contact;
  bool exact_arithmetic = false;  ///< no filter could tell: exact arithmetic decided
};

/// The way's closed segment against the closed triangle.
Decision decide_static(const Way& way, const Corners& triangle);

/// A point and a triangle that both move linearly from t = 0 (`before`) to t = 1 (`after`).
Decision decide_ccd(const Way& way, const Corners& before, const Corners& after);

}  // namespace vestige
