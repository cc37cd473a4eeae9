#include "analysis/mapping/localisation.hpp"

#include <cmath>
#include <glm/geometric.hpp>

namespace vestige {

namespace {

constexpr double kAcuity_m = 0.025;
constexpr double kAcuityAtMidline_m = 0.010;
constexpr double kMidline_m = 0.025;

}  // namespace

double localisation_error_m(const ActuatorLayout& layout, const LocatedContact& contact, std::span<const Share> shares,
                            Centroid centroid) {
  if (shares.size() == 1) return static_cast<double>(contact.distance_m()[shares.front().actuator]);
  glm::dvec2 sum(0);
  double weights = 0;
  for (const Share& share : shares) {
    const double weight = centroid == Centroid::kEnergy ? share.amplitude * share.amplitude : share.amplitude;
    sum += weight * layout.towards_m(contact, share.actuator);
    weights += weight;
  }
  return glm::length(sum) / weights;
}

double acuity_m(const glm::dvec3& position_m, double middle_x_m) {
  return std::abs(position_m.x - middle_x_m) <= kMidline_m ? kAcuityAtMidline_m : kAcuity_m;
}

}  // namespace vestige
