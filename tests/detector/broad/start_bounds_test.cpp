#include "detector/broad/start_bounds.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <random>

#include "detector/nearest_in_triangle.hpp"

namespace vestige {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// In `long double`, which holds the squares of all floats.
long double length_to(const glm::vec3& point, const glm::vec3& corner) {
  long double sum = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const long double away = static_cast<long double>(corner[axis]) - static_cast<long double>(point[axis]);
    sum += away * away;
  }
  return std::sqrt(sum);
}

class StartBoundsOf : public ::testing::TestWithParam<float> {};
INSTANTIATE_TEST_SUITE_P(Scales, StartBoundsOf, ::testing::Values(1e-30F, 1e-22F, 1e-3F, 1.0F, 1e4F, 1e19F, 1e30F));

TEST_P(StartBoundsOf, SayOnlyWhatIsTrue) {
  std::mt19937 random(7);
  std::uniform_real_distribution<float> any(-GetParam(), GetParam());
  const auto somewhere = [&] { return glm::vec3(any(random), any(random), any(random)); };
  int farther = 0;
  int within = 0;
  for (int round = 0; round < 200; ++round) {
    const glm::vec3 point = somewhere();
    MeshletCorners corners = {};
    for (std::size_t i = 0; i < kMeshletTriangles; ++i)
      for (std::size_t corner = 0; corner < 3; ++corner) {
        const glm::vec3 place = i == 3 && corner == 1 ? point : somewhere();
        for (int axis = 0; axis < 3; ++axis) corners.position[static_cast<std::size_t>(axis)][corner][i] = place[axis];
      }
    StartBounds bounds;
    bounds.find(corners, point);
    const double limit = std::abs(any(random));
    const double radius = std::abs(any(random));
    const StartMasks masks = bounds.compare(limit, radius);
    EXPECT_EQ(bounds.compare(kInfinity, radius).farther, 0U);
    for (std::size_t i = 0; i < kMeshletTriangles; ++i) {
      const std::uint32_t bit = 1U << i;
      long double to_corner = kInfinity;
      for (std::size_t corner = 0; corner < 3; ++corner)
        to_corner = std::min(to_corner, length_to(point, corners.at(corner, i)));
      if ((masks.corner_within & bit) != 0) {
        EXPECT_LE(to_corner, static_cast<long double>(radius));
        ++within;
      }
      // No farther away than any point of the triangle.
      for (int k = 0; k <= 4; ++k) {
        const glm::dvec3 weights(k / 4.0, (4 - k) / 8.0, (4 - k) / 8.0);
        const double away = glm::length(weighed(weights, corners.corners(i)) - glm::dvec3(point));
        if ((masks.farther & bit) != 0) {
          EXPECT_GT(away, limit);
        }
        if ((masks.apart & bit) != 0) {
          EXPECT_GT(away, radius);
        }
      }
      farther += (masks.farther & bit) != 0 ? 1 : 0;
    }
  }
  if (GetParam() > 1e-10F && GetParam() < 1e18F) {
    EXPECT_GT(farther, 100);
    EXPECT_GT(within, 100);
  }
}

TEST(StartBounds, NameTheTriangleWhoseBoxIsNearest) {
  MeshletCorners corners = {};
  for (std::size_t i = 0; i < kMeshletTriangles; ++i)
    for (std::size_t corner = 0; corner < 3; ++corner)
      corners.position[0][corner][i] = 100.0F - static_cast<float>(i) + static_cast<float>(corner);
  StartBounds bounds;
  bounds.find(corners, glm::vec3(0));
  EXPECT_EQ(bounds.nearest(0xFFFFFFFF), 31U);
  EXPECT_EQ(bounds.nearest(0b10110), 4U);
}

}  // namespace
}  // namespace vestige
