#include "detector/truth/whole_number.hpp"

#include <algorithm>
#include <cmath>

namespace vestige::exact {

float rounded_quotient(const Whole& numerator, const Whole& denominator) {
  if (numerator == 0) return 0;
  constexpr int kDigits = std::numeric_limits<float>::digits;
  constexpr int kFinest = kDigits - std::numeric_limits<float>::min_exponent;  // denormals are multiples of 2^-149
  // The quotient lies in (2^(size - 1), 2^(size + 1)), so one of two scales makes it `kDigits` digits long.
  const int size = static_cast<int>(msb(numerator)) - static_cast<int>(msb(denominator));
  int scale = std::min(kDigits - 1 - size, kFinest);
  Whole scaled = numerator << static_cast<unsigned>(scale);
  if (scale < kFinest && scaled < (denominator << static_cast<unsigned>(kDigits - 1))) {
    scaled <<= 1;
    ++scale;
  }
  Whole quotient;
  Whole remainder;
  divide_qr(scaled, denominator, quotient, remainder);
  auto digits = static_cast<std::int64_t>(quotient);
  const int to_half = Whole(remainder << 1).compare(denominator);
  if (to_half > 0 || (to_half == 0 && digits % 2 != 0)) ++digits;
  return std::ldexp(static_cast<float>(digits), -scale);
}

}  // namespace vestige::exact
