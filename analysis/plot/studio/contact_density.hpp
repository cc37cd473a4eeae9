#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "analysis/plot/studio/surface.hpp"
#include "detector/output/recorded_contacts.hpp"

namespace vestige::plot {

/// Contacts per area of a surface, smoothed along it by a Gaussian. Each contact spreads over the nearby skin that
/// faces the same way. Each contact counts one in total, also at the edge of an open surface. Distances are straight
/// lines.
class ContactDensity {
 public:
  /// `sigma` is that of the Gaussian, in the surface's unit. The density is computed at places half of `sigma` apart.
  /// Contacts are shared between these places, and densities are interpolated. So peaks are lower by up to a twentieth.
  ContactDensity(const Surface& surface, std::span<const RecordedContact> contacts, double sigma);

  /// Returns the contacts per square unit at which the triangle's second and third vertex weigh u and v.
  double at(std::uint32_t triangle, double u, double v) const;
  double highest() const;

 private:
  /// The places of a triangle. The triangle is cut into `parts`² equal triangles, and their corners are the places, in
  /// rows along v.
  struct Cut {
    std::size_t parts = 1;
    std::size_t first = 0;  ///< index of its first place in `density_`
    std::size_t place(std::size_t u, std::size_t v) const { return first + v * (parts + 1) - v * (v - 1) / 2 + u; }
  };

  /// The three places around a point of a triangle, and their weights.
  struct Spot {
    std::array<std::size_t, 3> place;
    std::array<double, 3> weight;
  };
  Spot spot_at(std::uint32_t triangle, double u, double v) const;

  std::vector<Cut> cuts_;
  std::vector<double> density_;
};

}  // namespace vestige::plot
