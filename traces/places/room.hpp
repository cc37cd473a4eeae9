#pragma once

#include <glm/vec3.hpp>
#include <vector>

#include "traces/places/body.hpp"

namespace vestige {

/// The room that an animated body takes up: a box that moves with the body's centre and contains the body's whole
/// motion around that centre. Computed from some of the vertices, 30 times a second.
class Room {
 public:
  explicit Room(MovingBody& body);

  /// The mean of the vertices; before time 0, the mean at 0.
  glm::dvec3 centre_m(double time_s) const;
  /// The box, relative to the centre.
  const glm::dvec3& low_m() const { return low_m_; }
  const glm::dvec3& high_m() const { return high_m_; }

 private:
  double loop_s_;
  std::vector<glm::dvec3> centres_m_;  // at equal intervals from the beginning of the loop to its end
  glm::dvec3 low_m_;
  glm::dvec3 high_m_;
};

}  // namespace vestige
