#include "detector/algebra/exact_quotient.hpp"

#include <algorithm>
#include <limits>
#include <span>
#include <vector>

namespace vestige {

namespace {

using Limb = boost::multiprecision::limb_type;
using TwoLimbs = boost::multiprecision::double_limb_type;

/// Returns the inverse of an odd number modulo 2 to the power of a limb's bits.
Limb inverse(Limb odd) {
  Limb result = odd * 3 ^ 2U;  // right in 5 bits; each step of Newton's doubles them
  for (int bits = 5; bits < std::numeric_limits<Limb>::digits; bits *= 2) result *= 2 - odd * result;
  return result;
}

/// Subtracts factor * subtrahend from what begins at `rest`, modulo 2 to the power of its bits.
void subtract_multiple(std::span<Limb> rest, std::span<const Limb> subtrahend, Limb factor) {
  const std::size_t size = std::min(rest.size(), subtrahend.size());
  Limb carry = 0;
  for (std::size_t i = 0; i < size; ++i) {
    const TwoLimbs product = static_cast<TwoLimbs>(factor) * subtrahend[i] + carry;
    const auto low = static_cast<Limb>(product);
    carry = static_cast<Limb>(product >> std::numeric_limits<Limb>::digits) + (rest[i] < low ? 1 : 0);
    rest[i] -= low;
  }
  for (std::size_t i = size; i < rest.size() && carry != 0; ++i) {
    const Limb next = rest[i] < carry ? 1 : 0;
    rest[i] -= carry;
    carry = next;
  }
}

}  // namespace

Integer exact_quotient(const Integer& a, const Integer& b) {
  if (a.is_zero()) return 0;
  // From the lowest limb up (Jebelean, An algorithm for exact division, 1993): an odd divisor has an inverse there, and
  // the limbs above those of the quotient need not be looked at.
  const unsigned twos = boost::multiprecision::lsb(abs(b));
  const Integer dividend = abs(a) >> twos;
  const Integer divisor = abs(b) >> twos;
  const std::span<const Limb> divisor_limbs(divisor.backend().limbs(), divisor.backend().size());
  const unsigned size = dividend.backend().size() - divisor.backend().size() + 1;
  std::vector<Limb> rest(dividend.backend().limbs(), dividend.backend().limbs() + size);
  const Limb inverse_of_lowest = inverse(divisor_limbs[0]);
  Integer quotient;
  quotient.backend().resize(size, size);
  for (unsigned i = 0; i < size; ++i) {
    const Limb limb = rest[i] * inverse_of_lowest;
    quotient.backend().limbs()[i] = limb;
    subtract_multiple(std::span(rest).subspan(i), divisor_limbs, limb);
  }
  quotient.backend().normalize();
  return a.sign() == b.sign() ? quotient : Integer(-quotient);
}

}  // namespace vestige
