#pragma once

#include "detector/algebra/scaled_integers.hpp"

namespace vestige {

/// Returns numerator / denominator, rounded to the nearest fp32, ties to even. Requires 0 <= numerator <= denominator
/// and denominator > 0.
float nearest_float(const Integer& numerator, const Integer& denominator);

}  // namespace vestige
