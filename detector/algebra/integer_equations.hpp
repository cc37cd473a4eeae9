#pragma once

#include <vector>

namespace vestige {

/// Returns whether no row is a sum of multiples of the others. Requires at most 6 rows, of numbers from -1 to 1.
bool are_independent(const std::vector<std::vector<int>>& rows);

/// Returns the x with rows x = right. Requires that x has integers only, that the rows are independent and as many as
/// x has numbers, at most 6, and that they hold numbers from -1 to 1.
std::vector<int> solution(const std::vector<std::vector<int>>& rows, const std::vector<int>& right);

}  // namespace vestige
