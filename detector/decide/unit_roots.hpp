#pragma once

#include <cstddef>
#include <vector>

#include "detector/decide/polynomial.hpp"

namespace vestige {

/// The distinct real roots of a polynomial of degree <= 3 in the open interval from 0 to 1, in ascending order, as
/// exact algebraic numbers: they are never approximated, only asked. Every answer takes a number of steps that does not
/// depend on how close roots lie to each other or to anything else.
class UnitRoots {
 public:
  /// `polynomial` is not zero.
  explicit UnitRoots(const Polynomial& polynomial);

  std::size_t count() const { return cells_.size(); }

  /// The root, rounded to nearest-even fp32: by exact signs at the midpoints between neighbours.
  float rounded(std::size_t root) const { return cells_[root].rounded; }

  /// The sign, at the root, of a polynomial of degree <= 2.
  int sign_at(std::size_t root, const Polynomial& other) const;

  /// Whether the polynomial keeps its sign from one side of the root to the other.
  bool is_even(std::size_t root) const;

 private:
  /// The root lies in [low, high], and so might others.
  struct Cell {
    double low = 0;
    double high = 1;
    float rounded = 0;
  };

  bool is_at_most(std::size_t root, double t) const;
  Cell find_cell(std::size_t root) const;
  int tarski_query(const Polynomial& other) const;

  Polynomial square_free_;  ///< has the same roots, each once
  Polynomial derivative_;   ///< of square_free_
  Polynomial common_;       ///< of the polynomial and its derivative: holds the multiple roots
  std::vector<Polynomial> sturm_;
  int changes_at_0_ = 0;
  std::vector<Cell> cells_;
};

}  // namespace vestige
