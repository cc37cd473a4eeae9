#include "analysis/base/pareto.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

namespace vestige {

std::vector<std::size_t> pareto_front(std::span<const Trade> trades) {
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < trades.size(); ++i)
    if (!std::isnan(trades[i].cost) && !std::isnan(trades[i].error)) order.push_back(i);
  std::ranges::stable_sort(order, [&](std::size_t a, std::size_t b) {
    return std::tie(trades[a].cost, trades[a].error) < std::tie(trades[b].cost, trades[b].error);
  });
  double least = std::numeric_limits<double>::infinity();
  std::erase_if(order, [&](std::size_t i) {
    if (!(trades[i].error < least)) return true;
    least = trades[i].error;
    return false;
  });
  return order;
}

}  // namespace vestige
