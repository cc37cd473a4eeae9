#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "detector/algebra/close_roots.hpp"
#include "detector/algebra/polynomial.hpp"

namespace vestige {

/// The distinct real roots of a polynomial of degree <= 6 in the open interval from 0 to 1, in ascending order. They
/// are exact algebraic numbers: the class never approximates them and only answers questions about them. Every answer
/// takes a number of steps that does not depend on how close roots are to each other or to anything else.
class UnitRoots {
 public:
  /// `polynomial` must not be zero.
  explicit UnitRoots(const Polynomial& polynomial);

  std::size_t count() const { return places_.size(); }

  /// Returns the root rounded to nearest-even fp32, found by exact signs at the midpoints between neighbouring fp32
  /// numbers.
  float rounded(std::size_t root) const { return cells_[places_[root].cell].rounded; }

  /// Returns the sign of another polynomial at the root.
  int sign_at(std::size_t root, const Polynomial& other) const;

  /// Returns whether a root is below a root of another polynomial.
  bool is_before(std::size_t root, const UnitRoots& other, std::size_t other_root) const;

  /// Returns how often the polynomial has the root, 1 to 6.
  int multiplicity(std::size_t root) const;

  /// Returns whether the polynomial has the same sign on both sides of the root.
  bool is_even(std::size_t root) const { return multiplicity(root) % 2 == 0; }

 private:
  /// Roots that round alike: those between two neighbouring midpoints, or one that is itself a midpoint.
  struct Cell {
    CloseRoots roots;  ///< with low = high for a midpoint
    float rounded = 0;
    bool crowded = false;  ///< holds two or more roots, or a multiple one, or none

    bool is_midpoint() const { return roots.low == roots.high; }
  };
  struct Place {
    std::size_t cell = 0;
    std::size_t index = 0;  ///< among the cell's roots
  };

  void find_cells(std::uint32_t low, std::uint32_t high);
  void find_single(std::uint32_t low, std::uint32_t high);
  void add_midpoint(std::uint32_t below);
  void place_roots();

  Polynomial polynomial_;
  Polynomial square_free_;  ///< has the same roots, each once
  Polynomial repeated_;     ///< has the multiple roots that lie in crowded cells, each once less; others perhaps
  std::vector<Cell> cells_;
  std::vector<Place> places_;
};

}  // namespace vestige
