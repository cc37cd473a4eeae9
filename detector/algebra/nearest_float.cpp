#include "detector/algebra/nearest_float.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

namespace vestige {

float nearest_float(const Integer& numerator, const Integer& denominator) {
  if (numerator.is_zero()) return 0;
  constexpr int kDigits = std::numeric_limits<float>::digits;
  constexpr int kLowestBit = std::numeric_limits<float>::min_exponent - kDigits;  // of the smallest subnormal: 2^-149
  // Scaled by 2^shift, the quotient has as many bits as a float holds, or one more.
  const int shift =
      std::min(kDigits + static_cast<int>(msb(denominator)) - static_cast<int>(msb(numerator)), -kLowestBit);
  const Integer scaled = numerator << shift;
  const Integer quotient = scaled / denominator;
  const Integer twice_rest = 2 * (scaled - quotient * denominator);
  // The part that was cut off is zero, or less than, equal to, or more than half of the last bit. Two extra bits encode
  // these four cases. A double can hold them, and then rounds as the true quotient does.
  int rest = 0;
  if (!twice_rest.is_zero()) rest = twice_rest == denominator ? 2 : (twice_rest < denominator ? 1 : 3);
  const std::int64_t with_rest = 4 * static_cast<std::int64_t>(quotient) + rest;
  return static_cast<float>(std::ldexp(static_cast<double>(with_rest), -shift - 2));
}

}  // namespace vestige
