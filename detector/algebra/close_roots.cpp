#include "detector/algebra/close_roots.hpp"

#include <algorithm>
#include <cstdlib>
#include <numeric>
#include <utility>

#include "detector/algebra/integer_equations.hpp"
#include "detector/algebra/remainder_sequence.hpp"

namespace vestige {

namespace {

using Columns = std::vector<std::size_t>;

struct KnownSigns {
  Polynomial polynomial;
  std::vector<int> signs;  ///< at the roots
};

/// Returns as many products of the known polynomials as there are columns, such that their signs there are independent.
/// Requires that no two columns have all signs alike.
///
/// Those that are found span all sign vectors: what they span has the constant 1 and, once no more are found, each of
/// its members times each known polynomial, so all polynomials in the known signs.
std::vector<KnownSigns> independent_products(const std::vector<KnownSigns>& known, const Columns& columns) {
  std::vector<KnownSigns> products = {{Polynomial({Integer(1)}), std::vector<int>(columns.size(), 1)}};
  std::vector<std::vector<int>> rows = {products[0].signs};
  products.reserve(columns.size());
  rows.reserve(columns.size());
  for (std::size_t i = 0; i < products.size(); ++i) {
    for (const KnownSigns& factor : known) {
      if (products.size() == columns.size()) return products;
      std::vector<int> signs = products[i].signs;
      for (std::size_t column = 0; column < columns.size(); ++column) signs[column] *= factor.signs[columns[column]];
      rows.push_back(signs);
      if (are_independent(rows))
        products.push_back({products[i].polynomial * factor.polynomial, std::move(signs)});
      else
        rows.pop_back();
    }
  }
  return products;
}

/// Returns the first root of each group. Roots that follow each other are in one group if all known signs are alike.
Columns first_of_groups(const std::vector<KnownSigns>& known, std::size_t count) {
  Columns first = {0};
  first.reserve(count);
  for (std::size_t root = 1; root < count; ++root) {
    const auto differs = [root](const KnownSigns& a) { return a.signs[root] != a.signs[root - 1]; };
    if (std::ranges::any_of(known, differs)) first.push_back(root);
  }
  return first;
}

/// Appends the signs, at `count` points in ascending order, of a function that is monotone there with the sign of its
/// slope. At a single point the slope may be 0.
void append_monotone_signs(std::vector<int>& signs, std::size_t count, int sum, int slope) {
  if (count == 1) {
    signs.push_back(sum);
    return;
  }
  // The function vanishes at most once, which the parity of the sum tells.
  const auto excess = static_cast<std::size_t>(std::abs(sum));
  const std::size_t zeros = (count - excess) % 2;
  const std::size_t fewer = (count - excess - zeros) / 2;
  const std::size_t more = fewer + excess;
  const bool rather_first = sum * slope < 0;
  signs.insert(signs.end(), rather_first ? more : fewer, -slope);
  signs.insert(signs.end(), zeros, 0);
  signs.insert(signs.end(), rather_first ? fewer : more, slope);
}

/// The roots of a polynomial while they are told apart by the signs of its derivatives, the highest first. By Thom's
/// lemma (Basu, Pollack, Roy, proposition 2.28) those at which the known signs are alike, a group, lie on an interval
/// without a root of another group. The next derivative is monotone there.
class Groups {
 public:
  Groups(const Polynomial& polynomial, double low, double high, std::size_t count)
      : polynomial_(polynomial), low_(low), high_(high), first_({0}), slopes_(count, 0) {}

  const std::vector<KnownSigns>& known() const { return known_; }

  std::size_t largest() const {
    std::size_t size = 0;
    for (std::size_t group = 0; group < first_.size(); ++group) size = std::max(size, size_of(group));
    return size;
  }

  /// Takes in the next derivative. The first one is a constant.
  void split(const Polynomial& derivative) {
    const int constant = derivative.constant_sign_on(low_, high_);
    if (constant != 0) {
      slopes_.assign(slopes_.size(), constant);
      return;
    }
    const std::vector<int> sums = sums_of_signs(derivative);
    std::vector<int> signs;
    signs.reserve(slopes_.size());
    for (std::size_t group = 0; group < first_.size(); ++group)
      append_monotone_signs(signs, size_of(group), sums[group], slopes_[first_[group]]);
    known_.push_back({derivative, signs});
    slopes_ = std::move(signs);
    first_ = first_of_groups(known_, slopes_.size());
  }

 private:
  std::size_t size_of(std::size_t group) const {
    return (group + 1 < first_.size() ? first_[group + 1] : slopes_.size()) - first_[group];
  }

  /// Returns, for each group, the sum of the signs at its roots.
  std::vector<int> sums_of_signs(const Polynomial& other) const {
    const Polynomial weighed = polynomial_.derivative() * other;
    std::vector<std::vector<int>> rows;
    std::vector<int> sums;
    rows.reserve(first_.size());
    sums.reserve(first_.size());
    for (KnownSigns& product : independent_products(known_, first_)) {
      sums.push_back(cauchy_index(polynomial_, weighed * product.polynomial, low_, high_));
      rows.push_back(std::move(product.signs));
    }
    return solution(rows, sums);
  }

  const Polynomial& polynomial_;
  double low_;
  double high_;
  std::vector<KnownSigns> known_;
  Columns first_;            ///< the first root of each group
  std::vector<int> slopes_;  ///< signs of the derivative that was taken in last, at the roots
};

}  // namespace

CloseRoots tell_roots_apart(const Polynomial& polynomial, double low, double high, std::size_t count) {
  CloseRoots roots{low, high, {}, {}};
  // The first derivative alternates from root to root. So it separates what is left of a group of two.
  std::vector<int> alternating(count, -polynomial.sign_after(low));
  for (std::size_t root = 1; root < count; ++root) alternating[root] = -alternating[root - 1];
  std::vector<KnownSigns> known;
  if (count > 1) {
    std::vector<Polynomial> derivatives = {polynomial.derivative()};
    derivatives.reserve(static_cast<std::size_t>(polynomial.degree()));
    while (derivatives.back().degree() > 0) derivatives.push_back(derivatives.back().derivative());
    Groups groups(polynomial, low, high, count);
    for (std::size_t i = derivatives.size(); groups.largest() > 2; --i) groups.split(derivatives[i - 1]);
    known = groups.known();
    known.push_back({std::move(derivatives.front()), alternating});
  }
  Columns all(count);
  std::iota(all.begin(), all.end(), std::size_t{0});
  roots.weights.reserve(count);
  roots.rows.reserve(count);
  for (KnownSigns& product : independent_products(known, all)) {
    for (std::size_t root = 0; root < count; ++root) product.signs[root] *= alternating[root];
    roots.weights.push_back(std::move(product.polynomial));
    roots.rows.push_back(std::move(product.signs));
  }
  return roots;
}

std::vector<int> signs_at_roots(const Polynomial& polynomial, const CloseRoots& roots, const Polynomial& other) {
  std::vector<int> indices;
  indices.reserve(roots.weights.size());
  for (const Polynomial& weight : roots.weights)
    indices.push_back(cauchy_index(polynomial, weight * other, roots.low, roots.high));
  return solution(roots.rows, indices);
}

}  // namespace vestige
