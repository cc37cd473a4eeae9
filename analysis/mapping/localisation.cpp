#include "analysis/mapping/localisation.hpp"

#include <cmath>

namespace vestige {

namespace {

constexpr double kAcuity_m = 0.025;
constexpr double kAcuityAtMidline_m = 0.010;
constexpr double kMidline_m = 0.025;

}  // namespace

glm::dvec2 felt_offset_m(const ActuatorLayout& layout, const LocatedContact& contact, std::span<const Share> shares,
                         Centroid centroid) {
  glm::dvec2 sum(0);
  double weights = 0;
  for (const Share& share : shares) {
    const double weight = centroid == Centroid::kEnergy ? share.amplitude * share.amplitude : share.amplitude;
    sum += weight * layout.towards_m(contact, share.actuator);
    weights += weight;
  }
  return sum / weights;
}

double acuity_m(const glm::dvec3& position_m, double middle_x_m) {
  return std::abs(position_m.x - middle_x_m) <= kMidline_m ? kAcuityAtMidline_m : kAcuity_m;
}

}  // namespace vestige
