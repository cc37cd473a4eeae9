#include "analysis/base/pareto.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

namespace vestige {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

TEST(ParetoFront, HasWhatNothingElseBeatsByAscendingCost) {
  const std::vector<Trade> trades = {{3, 1}, {1, 5}, {2, 5}, {2, 3}, {3, 2}, {9, 0}, {4, 1}};
  EXPECT_THAT(pareto_front(trades), ElementsAre(1, 3, 0, 5));
}

TEST(ParetoFront, HasTheFirstOfEqualsAndNothingThatIsNoNumber) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(pareto_front(std::vector<Trade>{{kNan, 0}, {1, kNan}, {1, 1}, {1, 1}}), ElementsAre(2));
  EXPECT_THAT(pareto_front({}), IsEmpty());
}

}  // namespace
}  // namespace vestige
