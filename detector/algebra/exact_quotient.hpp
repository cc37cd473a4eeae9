#pragma once

#include "detector/algebra/scaled_integers.hpp"

namespace vestige {

/// Returns a / b. b must not be zero and must divide a. Takes several times less time than Boost's division, which does
/// not know that there is no remainder.
Integer exact_quotient(const Integer& a, const Integer& b);

}  // namespace vestige
