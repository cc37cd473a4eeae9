#pragma once

#include "detector/decide/scaled_integers.hpp"

namespace vestige {

/// numerator / denominator, rounded to the nearest fp32, ties to even. 0 <= numerator <= denominator, denominator > 0.
float nearest_float(const Integer& numerator, const Integer& denominator);

}  // namespace vestige
