#pragma once

#include <array>
#include <bit>
#include <boost/multiprecision/cpp_int.hpp>
#include <cstddef>
#include <cstdint>
#include <limits>

namespace vestige::exact {

/// An integer of any size; up to 512 bits need no allocation.
using Whole = boost::multiprecision::number<
    boost::multiprecision::cpp_int_backend<512, 0, boost::multiprecision::signed_magnitude,
                                           boost::multiprecision::unchecked>,
    boost::multiprecision::et_off>;

inline int sign_of(const Whole& value) {
  return value.sign();
}

/// A finite double as significand * 2^exponent with an odd significand, or 0 * 2^0.
struct BinaryParts {
  std::int64_t significand = 0;
  int exponent = 0;
};

inline BinaryParts binary_parts(double value) {
  constexpr int kFractionBits = 52;
  constexpr int kLowestExponent = -1074;
  const auto bits = std::bit_cast<std::uint64_t>(value);
  const std::uint64_t fraction = bits & ((std::uint64_t{1} << kFractionBits) - 1);
  const auto biased = static_cast<int>((bits >> kFractionBits) & 0x7FF);
  const std::uint64_t magnitude = biased == 0 ? fraction : fraction | (std::uint64_t{1} << kFractionBits);
  if (magnitude == 0) return {};
  const int trailing = std::countr_zero(magnitude);
  const auto odd = static_cast<std::int64_t>(magnitude >> trailing);
  return {(bits >> 63) != 0 ? -odd : odd, kLowestExponent + (biased == 0 ? 0 : biased - 1) + trailing};
}

/// Returns the values as integer multiples of one power of two. Callers need only signs of homogeneous polynomials, and
/// quotients of two polynomials of the same degree. So they never need that power.
template <std::size_t Count>
std::array<Whole, Count> whole_multiples(const std::array<double, Count>& values) {
  std::array<BinaryParts, Count> parts;
  int unit = std::numeric_limits<int>::max();
  for (std::size_t i = 0; i < Count; ++i) {
    parts[i] = binary_parts(values[i]);
    if (parts[i].significand != 0) unit = std::min(unit, parts[i].exponent);
  }
  std::array<Whole, Count> whole;
  for (std::size_t i = 0; i < Count; ++i) {
    if (parts[i].significand == 0) continue;
    whole[i] = parts[i].significand;
    whole[i] <<= static_cast<unsigned>(parts[i].exponent - unit);
  }
  return whole;
}

/// Returns numerator / denominator, rounded to nearest-even fp32, including denormal results. Requires 0 <= numerator
/// <= denominator and denominator > 0.
float rounded_quotient(const Whole& numerator, const Whole& denominator);

}  // namespace vestige::exact
