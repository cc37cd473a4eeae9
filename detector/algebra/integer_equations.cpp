#include "detector/algebra/integer_equations.hpp"

#include <cstddef>
#include <cstdint>
#include <utility>

namespace vestige {

namespace {

using Rows = std::vector<std::vector<std::int64_t>>;

/// Eliminates without fractions (Bareiss 1968): afterwards each row has, at its own pivot, the same number as the other
/// rows at theirs, and 0 at those of the others. All numbers on the way are determinants of parts of the rows, so the
/// division is exact and nothing overflows. Returns the columns of the pivots, at most one for each row.
std::vector<std::size_t> eliminate(Rows& rows, std::size_t columns) {
  std::vector<std::size_t> pivots;
  std::int64_t last = 1;
  for (std::size_t column = 0; column < columns && pivots.size() < rows.size(); ++column) {
    const std::size_t top = pivots.size();
    std::size_t found = top;
    while (found < rows.size() && rows[found][column] == 0) ++found;
    if (found == rows.size()) continue;
    std::swap(rows[top], rows[found]);
    const std::int64_t pivot = rows[top][column];
    for (std::size_t row = 0; row < rows.size(); ++row) {
      if (row == top) continue;
      const std::int64_t factor = rows[row][column];
      for (std::size_t i = 0; i < rows[row].size(); ++i)
        rows[row][i] = (rows[row][i] * pivot - rows[top][i] * factor) / last;
    }
    last = pivot;
    pivots.push_back(column);
  }
  return pivots;
}

}  // namespace

bool are_independent(const std::vector<std::vector<int>>& rows) {
  Rows wide;
  wide.reserve(rows.size());
  for (const std::vector<int>& row : rows) wide.emplace_back(row.begin(), row.end());
  return eliminate(wide, rows.front().size()).size() == rows.size();
}

std::vector<int> solution(const std::vector<std::vector<int>>& rows, const std::vector<int>& right) {
  Rows wide;
  wide.reserve(rows.size());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    wide.emplace_back(rows[i].begin(), rows[i].end());
    wide.back().push_back(right[i]);
  }
  eliminate(wide, rows.size());
  std::vector<int> x(rows.size());
  for (std::size_t i = 0; i < x.size(); ++i) x[i] = static_cast<int>(wide[i].back() / wide[i][i]);
  return x;
}

}  // namespace vestige
