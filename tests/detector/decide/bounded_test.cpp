#include "detector/decide/bounded.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "detector/algebra/nearest_float.hpp"
#include "detector/decide/ccd_formulas.hpp"

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

/// A number of at most this magnitude, that errs by at most `error` units, to first order. Each operation
/// adds a unit of its result.
struct Weighed {
  double magnitude = 0;
  double error = 0;

  Weighed() = default;
  explicit Weighed(double exact) : magnitude(exact) {}
  Weighed(double most, double units) : magnitude(most), error(units) {}
};
Weighed operator*(Weighed a, Weighed b) {
  const double magnitude = a.magnitude * b.magnitude;
  return {magnitude, a.magnitude * b.error + b.magnitude * a.error + magnitude};
}
Weighed operator+(Weighed a, Weighed b) {
  return {a.magnitude + b.magnitude, a.error + b.error + a.magnitude + b.magnitude};
}
Weighed operator-(Weighed a, Weighed b) {
  if (a.error > 0 || b.error > 0) return a + b;
  const double magnitude = std::abs(a.magnitude - b.magnitude);  // of 1 and t, both exact
  return {magnitude, magnitude};
}
struct WeighedVector {
  Weighed x, y, z;
};

TEST(CcdFilter, BoundsCoverWhatItsFormulasMayErrAndHalfOfThemWouldNot) {
  const Weighed corner = {1, 1};  // a difference, rounded once
  const WeighedVector end = {corner, corner, corner};
  double area = 0;
  double volume = 0;
  for (const double t : {0.0, 0.25, 0.5, 1.0}) {
    // (1 - t) + t is 1, whatever t: magnitudes add up to those of the ends.
    WeighedVector at = corner_at(end, end, Weighed(t));
    at.x.magnitude = at.y.magnitude = at.z.magnitude = 1;
    const auto quadratic = quadratic_cross(at, at, at, at);
    area = std::max({area, quadratic.first.x.error, quadratic.twice_middle.x.error / 2});
    const auto cubic = cubic_dot(at, at, quadratic);
    volume = std::max({volume, cubic[0].error, cubic[1].error / 3, cubic[2].error / 3, cubic[3].error});
  }
  EXPECT_GT(kAreaError, area * kUnit * (1 + 0x1p-40));
  EXPECT_GT(kVolumeError, volume * kUnit * (1 + 0x1p-40));
  EXPECT_LT(kAreaError / 2, area * kUnit);
  EXPECT_LT(kVolumeError / 2, volume * kUnit);
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
