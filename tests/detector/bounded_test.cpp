#include "detector/bounded.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "detector/nearest_float.hpp"

namespace vestige {
namespace {

/// A number that knows how many roundings met in the worst of its terms.
struct Counted {
  int roundings = 0;
};
Counted operator*(Counted a, Counted b) {
  return {a.roundings + b.roundings + 1};
}
Counted operator+(Counted a, Counted b) {
  return {std::max(a.roundings, b.roundings) + 1};
}
Counted operator-(Counted a, Counted b) {
  return a + b;
}
struct CountedVector {
  Counted x, y, z;
};

TEST(Bounded, CoversEveryRoundingOfATripleProductAndNoMore) {
  const CountedVector point;
  const CountedVector way = difference(point, point);
  const int roundings = dot_product(way, cross_product(way, way)).roundings;
  EXPECT_GT(kTripleError, roundings * kUnit / (1 - roundings * kUnit));
  EXPECT_LT(kTripleError, (roundings + 1) * kUnit);
}

TEST(NearestFloat, RoundsQuotientsToNearestEven) {
  const auto nearest = [](std::int64_t numerator, std::int64_t denominator) {
    return nearest_float(Integer(numerator), Integer(denominator));
  };
  EXPECT_EQ(nearest(0, 7), 0.0F);
  EXPECT_EQ(nearest(7, 7), 1.0F);
  EXPECT_EQ(nearest(1, 3), 1.0F / 3.0F);
  EXPECT_EQ(nearest(2, 3), 2.0F / 3.0F);
  const std::int64_t two_to_25 = std::int64_t{1} << 25;
  EXPECT_EQ(nearest(two_to_25 - 1, two_to_25), 1.0F) << "half way between 1 and the float below: to even";
  EXPECT_EQ(nearest(two_to_25 - 3, two_to_25), 1 - 0x1p-23F) << "half way again, the even one is below";
  EXPECT_EQ(nearest_float((Integer(two_to_25 - 1) << 100) - 1, Integer(two_to_25) << 100), 1 - 0x1p-24F);
  EXPECT_EQ(nearest_float((Integer(two_to_25 - 3) << 100) + 1, Integer(two_to_25) << 100), 1 - 0x1p-24F);
}

TEST(NearestFloat, RoundsSubnormalsOnce) {
  EXPECT_EQ(nearest_float(1, Integer(1) << 149), 0x1p-149F);
  EXPECT_EQ(nearest_float(1, Integer(1) << 150), 0.0F) << "half of the smallest: to even";
  EXPECT_EQ(nearest_float((Integer(1) << 60) + 1, Integer(1) << 210), 0x1p-149F);
  EXPECT_EQ(nearest_float(3, Integer(1) << 150), 0x1p-148F);
  EXPECT_EQ(nearest_float(1, Integer(1) << 2000), 0.0F);
}

}  // namespace
}  // namespace vestige
