#pragma once

#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

namespace vestige {

// These functions return the same bits on every machine. A C library's functions need not: theirs differ between
// processors with and without fma. The relative error of both is within 1e-15 (log2: or the absolute error).

/// e^x.
inline double portable_exp(double x) {
  if (!(x < 709)) return x >= 709 ? std::numeric_limits<double>::infinity() : x;
  if (x < -745) return 0;
  constexpr double kLn2High = 0x1.62e42fefa0000p-1;  // its last bits are 0, so that whole multiples are exact
  constexpr double kLn2Low = 0x1.cf79abc9e3b3ap-40;
  const double whole = std::floor(x * 0x1.71547652b82fep0 + 0.5);
  const double r = (x - whole * kLn2High) - whole * kLn2Low;  // within ln 2 / 2
  constexpr std::array<double, 15> kInverseFactorial = [] {
    std::array<double, 15> inverse = {1};
    double factorial = 1;
    for (std::size_t n = 1; n < inverse.size(); ++n) inverse[n] = 1 / (factorial *= static_cast<double>(n));
    return inverse;
  }();
  double sum = kInverseFactorial.back();
  for (std::size_t n = kInverseFactorial.size() - 1; n-- > 0;) sum = sum * r + kInverseFactorial[n];
  const auto exponent = static_cast<int>(whole);
  if (exponent < -1022) return std::ldexp(sum, exponent);
  return sum * std::bit_cast<double>(static_cast<std::uint64_t>(exponent + 1023) << 52);
}

/// Returns the logarithm to base 2: -inf for 0, and NaN below 0. Exact for powers of two.
inline double portable_log2(double x) {
  if (!(x > 0)) return x == 0 ? -std::numeric_limits<double>::infinity() : std::numeric_limits<double>::quiet_NaN();
  if (std::isinf(x)) return x;
  int exponent = 0;
  double mantissa = std::frexp(x, &exponent);
  if (mantissa < 0x1.6a09e667f3bcdp-1) {
    mantissa *= 2;
    --exponent;
  }
  // ln m = 2 artanh s
  const double s = (mantissa - 1) / (mantissa + 1);
  double sum = 0;
  for (int n = 25; n > 0; n -= 2) sum = sum * s * s + 1.0 / n;
  return exponent + 2 * s * sum * 0x1.71547652b82fep0;
}

/// x^y for x ≥ 0.
inline double portable_pow(double x, double y) {
  if (x == 0) return y == 0 ? 1 : 0;
  if (x == 1 || y == 1) return x;
  return portable_exp(y * portable_log2(x) * 0x1.62e42fefa39efp-1);
}

}  // namespace vestige
