#pragma once

#include <cstddef>
#include <vector>

#include "detector/algebra/polynomial.hpp"

namespace vestige {

/// All roots of a polynomial between `low` and `high`, both left out, in ascending order, at most 6. The polynomial has
/// no multiple root. Its Cauchy indices with products tell the roots apart, however close they are.
struct CloseRoots {
  double low = 0;
  double high = 1;
  /// As many as there are roots. The Cauchy index of each, times another polynomial, is the sum of the other's signs at
  /// the roots, each times the number in the weight's row.
  std::vector<Polynomial> weights;
  std::vector<std::vector<int>> rows;
};

/// Requires that `count` >= 1 roots lie between `low` and `high`, and 0 <= low < high.
CloseRoots tell_roots_apart(const Polynomial& polynomial, double low, double high, std::size_t count);

/// Returns the signs of `other` at the roots of `polynomial`: Basu, Pollack, Roy, Algorithms in Real Algebraic Geometry
/// (2006), chapter 10.3.
std::vector<int> signs_at_roots(const Polynomial& polynomial, const CloseRoots& roots, const Polynomial& other);

}  // namespace vestige
