#include "analysis/scoring/localisation.hpp"

#include <cmath>

namespace vestige {

namespace {

constexpr double kAcuity_m = 0.025;
constexpr double kAcuityAtMidline_m = 0.010;
constexpr double kMidline_m = 0.025;

}  // namespace

FeltOffset felt_offset(const ActuatorLayout& layout, const LocatedContact& contact, std::span<const Share> shares) {
  FeltOffset sum;
  double amplitudes = 0;
  double energies = 0;
  for (const Share& share : shares) {
    const glm::dvec2 way_m = layout.towards_m(contact, share.actuator);
    const double energy = share.amplitude * share.amplitude;
    sum.amplitude_m += share.amplitude * way_m;
    sum.energy_m += energy * way_m;
    amplitudes += share.amplitude;
    energies += energy;
  }
  return {sum.amplitude_m / amplitudes, sum.energy_m / energies};
}

double acuity_m(const glm::dvec3& position_m, double middle_x_m) {
  return std::abs(position_m.x - middle_x_m) <= kMidline_m ? kAcuityAtMidline_m : kAcuity_m;
}

}  // namespace vestige
