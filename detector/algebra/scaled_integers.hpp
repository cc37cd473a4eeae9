#pragma once

#include <algorithm>
#include <array>
#include <boost/multiprecision/cpp_int.hpp>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

namespace vestige {

/// An integer of any size; small values need no allocation.
using Integer = boost::multiprecision::number<
    boost::multiprecision::cpp_int_backend<1024, 0, boost::multiprecision::signed_magnitude,
                                           boost::multiprecision::unchecked,
                                           std::allocator<boost::multiprecision::limb_type>>,
    boost::multiprecision::et_off>;

/// Multiplies finite doubles by one power of two that makes all of them integers. This does not change the signs of
/// polynomials whose terms all have the same degree, or the quotients of two such polynomials of equal degree.
template <std::size_t Count>
std::array<Integer, Count> scaled_integers(const std::array<double, Count>& values) {
  constexpr int kDigits = std::numeric_limits<double>::digits;
  std::array<int, Count> exponent = {};
  int lowest = std::numeric_limits<int>::max();
  for (std::size_t i = 0; i < Count; ++i) {
    if (values[i] == 0) continue;
    std::frexp(values[i], &exponent[i]);
    lowest = std::min(lowest, exponent[i]);
  }
  std::array<Integer, Count> whole;
  for (std::size_t i = 0; i < Count; ++i) {
    if (values[i] == 0) continue;
    whole[i] = static_cast<std::int64_t>(std::ldexp(values[i], kDigits - exponent[i]));
    whole[i] <<= exponent[i] - lowest;
  }
  return whole;
}

}  // namespace vestige
