#include "detector/algebra/unit_roots.hpp"

#include <algorithm>
#include <bit>

#include "detector/algebra/remainder_sequence.hpp"

namespace vestige {

namespace {

constexpr std::uint32_t kBitsOfOne = std::bit_cast<std::uint32_t>(1.0F);

/// Returns the midpoint between the fp32 number with these bits and the next number. The result is exact.
double midpoint_above(std::uint32_t bits) {
  return 0.5 * (static_cast<double>(std::bit_cast<float>(bits)) + static_cast<double>(std::bit_cast<float>(bits + 1)));
}

/// Between these two lies what rounds to the fp32 number with these bits.
double cell_low(std::uint32_t bits) {
  return bits > 0 ? midpoint_above(bits - 1) : 0;
}

double cell_high(std::uint32_t bits) {
  return bits < kBitsOfOne ? midpoint_above(bits) : 1;
}

}  // namespace

UnitRoots::UnitRoots(const Polynomial& polynomial) : polynomial_(polynomial.without_end_roots()) {
  if (polynomial_.degree() < 1) return;
  find_cells(0, kBitsOfOne);
  place_roots();
}

void UnitRoots::find_cells(std::uint32_t low, std::uint32_t high) {
  const double from = cell_low(low);
  const double to = cell_high(high);
  const int most = sign_changes(polynomial_.bernstein_signs(from, to));
  if (most == 0) return;
  if (most == 1) return find_single(low, high);
  if (low == high) {
    cells_.push_back({{from, to, {}, {}}, std::bit_cast<float>(low), true});
    return;
  }
  const std::uint32_t middle = low + (high - low) / 2;
  find_cells(low, middle);
  if (polynomial_.sign_at(cell_high(middle)) == 0) add_midpoint(middle);
  find_cells(middle + 1, high);
}

void UnitRoots::find_single(std::uint32_t low, std::uint32_t high) {
  // Bisection over the fp32 numbers: find the first number whose upper midpoint is not below the root.
  const int sign_below = polynomial_.sign_after(cell_low(low));
  while (low < high) {
    const std::uint32_t middle = low + (high - low) / 2;
    const int sign = polynomial_.sign_at(cell_high(middle));
    if (sign == 0) return add_midpoint(middle);
    if (sign == sign_below)
      low = middle + 1;
    else
      high = middle;
  }
  cells_.push_back({{cell_low(low), cell_high(low), {}, {}}, std::bit_cast<float>(low), false});
}

void UnitRoots::add_midpoint(std::uint32_t below) {
  const double at = midpoint_above(below);
  cells_.push_back({{at, at, {}, {}}, std::bit_cast<float>(below + below % 2), false});
}

void UnitRoots::place_roots() {
  std::vector<Polynomial> remainders;
  square_free_ = polynomial_;
  if (std::ranges::any_of(cells_, &Cell::crowded)) {
    remainders = signed_remainders(polynomial_, polynomial_.derivative());
    repeated_ = repeated_part(remainders);
    if (repeated_.degree() > 0) square_free_ = quotient(polynomial_, repeated_);
  }
  places_.reserve(static_cast<std::size_t>(polynomial_.degree()));
  for (std::size_t i = 0; i < cells_.size(); ++i) {
    CloseRoots& roots = cells_[i].roots;
    // Sturm's theorem: Basu, Pollack, Roy, theorem 2.50.
    const int count = cells_[i].crowded ? changes_lost(remainders, roots.low, roots.high) : 1;
    for (int index = 0; index < count; ++index) places_.push_back({i, static_cast<std::size_t>(index)});
    if (count > 0 && !cells_[i].is_midpoint())
      roots = tell_roots_apart(square_free_, roots.low, roots.high, static_cast<std::size_t>(count));
  }
}

int UnitRoots::sign_at(std::size_t root, const Polynomial& other) const {
  if (other.degree() < 1) return other.sign_at_0();
  const Cell& cell = cells_[places_[root].cell];
  const CloseRoots& roots = cell.roots;
  if (cell.is_midpoint()) return other.sign_at(roots.low);
  const int seen = other.constant_sign_on(roots.low, roots.high);
  return seen != 0 ? seen : signs_at_roots(square_free_, roots, other)[places_[root].index];
}

bool UnitRoots::is_before(std::size_t root, const UnitRoots& other, std::size_t other_root) const {
  const float mine = rounded(root);
  const float its = other.rounded(other_root);
  if (mine != its) return mine < its;
  // Sturm's theorem counts the other's roots above 0 and up to this one.
  std::vector<int> at_0;
  std::vector<int> at_root;
  for (const Polynomial& polynomial : signed_remainders(other.square_free_, other.square_free_.derivative())) {
    at_0.push_back(polynomial.sign_at_0());
    at_root.push_back(sign_at(root, polynomial));
  }
  return sign_changes(at_0) - sign_changes(at_root) <= static_cast<int>(other_root);
}

int UnitRoots::multiplicity(std::size_t root) const {
  const Cell& cell = cells_[places_[root].cell];
  int times = 1;
  if (cell.is_midpoint()) {
    for (Polynomial derived = polynomial_.derivative(); derived.sign_at(cell.roots.low) == 0; ++times)
      derived = derived.derivative();
  } else if (cell.crowded) {
    for (Polynomial rest = repeated_; rest.degree() > 0 && sign_at(root, rest) == 0; ++times)
      rest = repeated_part(signed_remainders(rest, rest.derivative()));
  }
  return times;
}

}  // namespace vestige
