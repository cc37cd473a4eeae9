#include "detector/detectors/contact_description.hpp"

#include <gtest/gtest.h>

namespace vestige {
namespace {

const Corners kTriangle = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};

TEST(Barycentric, WeighsTheSecondAndThirdCorner) {
  EXPECT_EQ(barycentric_of({0.25, 0.5, 0}, kTriangle), glm::dvec2(0.25, 0.5));
  EXPECT_EQ(barycentric_of(kTriangle.b, kTriangle), glm::dvec2(1, 0));
  EXPECT_EQ(barycentric_of({-1, -1, 0}, kTriangle), glm::dvec2(0, 0));
  EXPECT_EQ(barycentric_of({1.5, 0, 0}, {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}), glm::dvec2(0, 0.75));
}

}  // namespace
}  // namespace vestige
