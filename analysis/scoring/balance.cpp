#include "analysis/scoring/balance.hpp"

#include <limits>
#include <numeric>

#include "detector/actuators/portable_math.hpp"

namespace vestige {

double use_evenness(std::span<const double> use) {
  const double all = std::accumulate(use.begin(), use.end(), 0.0);
  if (use.size() < 2 || !(all > 0)) return std::numeric_limits<double>::quiet_NaN();
  double bits = 0;
  for (const double one : use)
    if (one > 0) bits -= one / all * portable_log2(one / all);
  return bits / portable_log2(static_cast<double>(use.size()));
}

}  // namespace vestige
