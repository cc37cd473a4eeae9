#pragma once

#include <span>
#include <vector>

#include "detector/algebra/polynomial.hpp"

namespace vestige {

/// Returns a, b, and then repeatedly the negative remainder of the last two, until the remainder is zero: the signed
/// remainder sequence of Basu, Pollack, Roy, Algorithms in Real Algebraic Geometry (2006), definition 1.7, up to
/// positive factors. The last one is the greatest common divisor. Requires degree of a >= degree of b.
///
/// The factors are those of the subresultants (Brown, The Subresultant PRS Algorithm, 1978): the coefficients grow in
/// proportion to the degree.
std::vector<Polynomial> signed_remainders(const Polynomial& a, const Polynomial& b);

/// Returns the number of sign changes along a list, zeros left out.
int sign_changes(std::span<const int> signs);

/// Returns the number of sign changes that the sequence loses from just above `low` to just below `high`. Requires 0 <=
/// low < high.
int changes_lost(std::span<const Polynomial> sequence, double low, double high);

/// Returns the Cauchy index of other / polynomial between `low` and `high`, both left out: how often the quotient jumps
/// from minus to plus infinity, less how often it jumps back. At a simple root of `polynomial`, that is the sign of
/// its derivative times `other`: Basu, Pollack, Roy, chapter 2.2.2. Requires a degree >= 1 and 0 <= low < high.
int cauchy_index(const Polynomial& polynomial, const Polynomial& other, double low, double high);

/// Returns the greatest common divisor of a polynomial and its derivative. Its coefficients have no common divisor. Its
/// roots are the multiple roots, each once less. `remainders` is the remainder sequence of the two.
Polynomial repeated_part(std::span<const Polynomial> remainders);

}  // namespace vestige
