#pragma once

#include <cstddef>
#include <vector>

#include "detector/decide/polynomial.hpp"

namespace vestige {

/// The distinct real roots of a polynomial of degree <= 3 in the open interval from 0 to 1, in ascending order. They
/// are exact algebraic numbers: the class never approximates them and only answers questions about them. Every answer
/// takes a number of steps that does not depend on how close roots are to each other or to anything else.
class UnitRoots {
 public:
  /// `polynomial` must not be zero.
  explicit UnitRoots(const Polynomial& polynomial);

  std::size_t count() const { return cells_.size(); }

  /// Returns the root rounded to nearest-even fp32, found by exact signs at the midpoints between neighbouring fp32
  /// numbers.
  float rounded(std::size_t root) const { return cells_[root].rounded; }

  /// Returns the sign, at the root, of a polynomial of degree <= 2.
  int sign_at(std::size_t root, const Polynomial& other) const;

  /// Returns whether a root is below a root of another polynomial.
  bool is_before(std::size_t root, const UnitRoots& other, std::size_t other_root) const;

  /// Returns whether the polynomial has the same sign on both sides of the root.
  bool is_even(std::size_t root) const;

 private:
  /// The root lies in [low, high]. Other roots may lie there too.
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
  Polynomial common_;       ///< greatest common divisor of the polynomial and its derivative: has the multiple roots
  std::vector<Polynomial> sturm_;
  int changes_at_0_ = 0;
  std::vector<Cell> cells_;
};

}  // namespace vestige
