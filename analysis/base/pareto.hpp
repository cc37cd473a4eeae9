#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace vestige {

/// What something costs and how much of it is wrong. Less is better of both.
struct Trade {
  double cost = 0;
  double error = 0;
};

/// Returns the indices of the Pareto front by ascending cost: those for which no other has at most the cost and at most
/// the error, and less of one. Of equal trades, the first. A trade that is not a number is not on the front.
std::vector<std::size_t> pareto_front(std::span<const Trade> trades);

}  // namespace vestige
