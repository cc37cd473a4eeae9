#include "detector/decide/unit_roots.hpp"

#include <bit>
#include <cstdint>

namespace vestige {

namespace {

constexpr std::uint32_t kBitsOfOne = std::bit_cast<std::uint32_t>(1.0F);

/// Returns the number of sign changes that the sequence loses from 0 to 1.
int changes_lost(const std::vector<Polynomial>& sequence) {
  std::vector<int> at_0;
  std::vector<int> at_1;
  at_0.reserve(sequence.size());
  at_1.reserve(sequence.size());
  for (const Polynomial& polynomial : sequence) {
    at_0.push_back(polynomial.sign_at_0());
    at_1.push_back(polynomial.sign_at_1());
  }
  return sign_changes(at_0) - sign_changes(at_1);
}

int changes_at(const std::vector<Polynomial>& sequence, double t) {
  std::vector<int> signs;
  signs.reserve(sequence.size());
  for (const Polynomial& polynomial : sequence) signs.push_back(polynomial.sign_at(t));
  return sign_changes(signs);
}

/// Returns the midpoint between the fp32 number with these bits and the next number. The result is exact.
double midpoint_above(std::uint32_t bits) {
  return 0.5 * (static_cast<double>(std::bit_cast<float>(bits)) + static_cast<double>(std::bit_cast<float>(bits + 1)));
}

}  // namespace

UnitRoots::UnitRoots(const Polynomial& polynomial) {
  const Polynomial inner = polynomial.without_end_roots();
  if (inner.degree() < 1) return;
  const std::vector<Polynomial> remainders = signed_remainders(inner, inner.derivative());
  common_ = remainders.back();
  square_free_ = common_.degree() > 0 ? quotient(inner, common_) : inner;
  derivative_ = square_free_.derivative();
  sturm_ = common_.degree() > 0 ? signed_remainders(square_free_, derivative_) : remainders;
  // Sturm's theorem: Basu, Pollack, Roy, theorem 2.50.
  changes_at_0_ = changes_at(sturm_, 0);
  cells_.resize(static_cast<std::size_t>(changes_lost(sturm_)));
  for (std::size_t root = 0; root < cells_.size(); ++root) cells_[root] = find_cell(root);
}

bool UnitRoots::is_at_most(std::size_t root, double t) const {
  if (cells_.size() == 1) return square_free_.sign_at(t) != square_free_.sign_at_0();
  return changes_at_0_ - changes_at(sturm_, t) > static_cast<int>(root);
}

UnitRoots::Cell UnitRoots::find_cell(std::size_t root) const {
  // Bisection over the fp32 numbers: find the first number whose upper midpoint is not below the root.
  std::uint32_t low = 0;
  std::uint32_t high = kBitsOfOne;
  while (low < high) {
    const std::uint32_t middle = low + (high - low) / 2;
    if (is_at_most(root, midpoint_above(middle)))
      high = middle;
    else
      low = middle + 1;
  }
  Cell cell;
  if (low > 0) cell.low = midpoint_above(low - 1);
  if (low < kBitsOfOne) cell.high = midpoint_above(low);
  const bool tie = low < kBitsOfOne && square_free_.sign_at(cell.high) == 0 &&
                   (root + 1 == cells_.size() || !is_at_most(root + 1, cell.high));
  cell.rounded = std::bit_cast<float>(tie && low % 2 == 1 ? low + 1 : low);
  return cell;
}

int UnitRoots::tarski_query(const Polynomial& other) const {
  // The result is the sum, over the roots, of the sign of `other`: Basu, Pollack, Roy, theorem 2.61. The remainder has
  // the same Cauchy index and a lower degree.
  return changes_lost(signed_remainders(square_free_, remainder(derivative_ * other, square_free_)));
}

int UnitRoots::sign_at(std::size_t root, const Polynomial& other) const {
  if (other.degree() < 1) return other.sign_at_0();
  const int seen = other.constant_sign_on(cells_[root].low, cells_[root].high);
  if (seen != 0) return seen;

  const int sum = tarski_query(other);
  if (cells_.size() == 1) return sum;
  // All roots are simple, so the derivative's signs alternate from root to root. A second query separates the even from
  // the odd roots.
  const int first_slope = -square_free_.sign_at_0();
  const int alternating = first_slope * tarski_query(remainder(derivative_ * other, square_free_));
  const int even = (sum + alternating) / 2;
  const int odd = (sum - alternating) / 2;
  if (root == 1) return odd;
  if (cells_.size() == 2) return even;
  // With three roots, the second derivative vanishes at their mean, which lies between the first and the last root. A
  // third query separates these two.
  const Polynomial curvature = derivative_.derivative();
  const int leading = square_free_.leading().sign();
  const int middle_curvature = tarski_query(curvature);
  const int weighed = tarski_query(remainder(curvature * other, square_free_));
  const int last_less_first = leading * (weighed - middle_curvature * odd);
  return root == 0 ? (even - last_less_first) / 2 : (even + last_less_first) / 2;
}

bool UnitRoots::is_before(std::size_t root, const UnitRoots& other, std::size_t other_root) const {
  // Sturm's theorem counts the other's roots above 0 and up to this one.
  std::vector<int> signs;
  signs.reserve(other.sturm_.size());
  for (const Polynomial& polynomial : other.sturm_) signs.push_back(sign_at(root, polynomial));
  return other.changes_at_0_ - sign_changes(signs) <= static_cast<int>(other_root);
}

bool UnitRoots::is_even(std::size_t root) const {
  // A triple root, at which the common divisor has degree 2, is odd.
  return common_.degree() == 1 && sign_at(root, common_) == 0;
}

}  // namespace vestige
