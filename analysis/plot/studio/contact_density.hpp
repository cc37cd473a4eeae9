#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "analysis/plot/studio/surface.hpp"
#include "detector/output/contacts_csv.hpp"

namespace vestige::plot {

/// Contacts per area of a surface, smoothed along it by a Gaussian: each contact is spread over the skin around it that
/// faces the same way, and counts one in all, at hems as anywhere. The distance is the straight one.
class ContactDensity {
 public:
  /// `sigma` is the Gaussian's, in the surface's unit. The density is computed at places half of it apart, between
  /// which contacts are shared and densities interpolated: peaks come out lower by up to a twentieth.
  ContactDensity(const Surface& surface, std::span<const RecordedContact> contacts, double sigma);

  /// Contacts per square unit where the triangle's second and third vertex weigh u and v.
  double at(std::uint32_t triangle, double u, double v) const;
  double highest() const;

 private:
  /// The places of a triangle: the corners of `parts`² equal ones into which it is cut, in rows along v.
  struct Cut {
    std::size_t parts = 1;
    std::size_t first = 0;  ///< its first place in `density_`
    std::size_t place(std::size_t u, std::size_t v) const { return first + v * (parts + 1) - v * (v - 1) / 2 + u; }
  };

  /// The three places around a point of a triangle, and what part each has in it.
  struct Spot {
    std::array<std::size_t, 3> place;
    std::array<double, 3> weight;
  };
  Spot spot_at(std::uint32_t triangle, double u, double v) const;

  std::vector<Cut> cuts_;
  std::vector<double> density_;
};

}  // namespace vestige::plot
