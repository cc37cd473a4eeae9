#include "analysis/mapping/uv_overlap.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "tests/support/builtin_avatar.hpp"
#include "tests/support/builtin_map.hpp"

namespace vestige {
namespace {

/// A mesh that is nothing but its texture coordinates.
Avatar flat(std::vector<glm::vec2> coordinates) {
  Avatar avatar;
  avatar.texture_coordinate = std::move(coordinates);
  for (unsigned i = 0; i + 2 < avatar.texture_coordinate.size(); i += 3) avatar.triangles.emplace_back(i, i + 1, i + 2);
  return avatar;
}

TEST(UvCoverage, TwoTrianglesWithACommonEdgeShareNoTexel) {
  const UvCoverage square = uv_coverage(flat({{0, 0}, {1, 0}, {1, 1}, {0, 0}, {1, 1}, {0, 1}}), 64);
  EXPECT_EQ(square.covered_texels, 64U * 64U);
  EXPECT_EQ(square.overlap_texels, 0U);
}

TEST(UvCoverage, MirroredHalvesOnTheSameTexelsOverlapWhicheverWayTheyWind) {
  const UvCoverage twice = uv_coverage(flat({{0, 0}, {0.5F, 0}, {0, 0.5F}, {0, 0}, {0, 0.5F}, {0.5F, 0}}), 100);
  EXPECT_EQ(twice.overlap_texels, twice.covered_texels);
  EXPECT_NEAR(static_cast<double>(twice.overlap_texels), 100 * 100 / 8.0, 50);
  EXPECT_EQ(std::ranges::max(twice.layers), 2);
}

TEST(UvCoverage, CoordinatesOutsideTheTextureWrapAround) {
  const UvCoverage apart = uv_coverage(flat({{0.1F, 0.1F}, {0.4F, 0.1F}, {0.1F, 0.4F}}), 100);
  const UvCoverage tiled =
      uv_coverage(flat({{0.1F, 0.1F}, {0.4F, 0.1F}, {0.1F, 0.4F}, {-0.9F, 3.1F}, {-0.6F, 3.1F}, {-0.9F, 3.4F}}), 100);
  EXPECT_EQ(apart.overlap_texels, 0U);
  EXPECT_NEAR(static_cast<double>(tiled.overlap_texels), static_cast<double>(apart.covered_texels), 20);
}

TEST(UvCoverage, NoCoordinatesAndHugeOnesComeToAnEnd) {
  EXPECT_EQ(uv_coverage(flat({{0, 0}, {0, 0}, {0, 0}}), 64).covered_texels, 0U);
  const float most = std::numeric_limits<float>::max();
  EXPECT_LE(uv_coverage(flat({{-most, 0}, {most, 0}, {0, most}}), 64).covered_texels, 64U * 64U);
}

TEST(UvCoverage, ATriangleThatWrapsAroundTheTextureDoesNotOverlapItself) {
  EXPECT_EQ(uv_coverage(flat({{0, 0}, {2, 0}, {0, 2}}), 64).overlap_texels, 0U);
}

TEST(UvCoverage, ManyLargeTrianglesAreCountedToTheEnd) {
  std::vector<glm::vec2> coordinates;
  for (int i = 0; i < 300000; ++i) coordinates.insert(coordinates.end(), {{0, 0}, {3.9F, 0}, {0, 3.9F}});
  const UvCoverage coverage = uv_coverage(flat(std::move(coordinates)), 256);
  EXPECT_EQ(coverage.overlap_texels, 256U * 256U);
  EXPECT_EQ(std::ranges::min(coverage.layers), 255);
}

TEST(UvCoverage, TheMannequinIsCutWithoutAnyOverlap) {
  const Avatar& mannequin = test::builtin_avatar();
  for (const std::uint32_t side : {512U, 1024U, 4096U})
    EXPECT_EQ(uv_coverage(mannequin, side).overlap_texels, 0U) << side;
}

TEST(MannequinMap, HasSixTorsoRegionsEachOnItsSideAndHeight) {
  const Avatar& mannequin = test::builtin_avatar();
  const ActuatorMap& map = test::builtin_map();
  ASSERT_EQ(map.actuator_count, 6U);
  std::vector<std::size_t> hits(7, 0);
  for (const glm::uvec3& t : mannequin.triangles) {
    const auto mean = [&](const auto& values) { return (values[t.x] + values[t.y] + values[t.z]) / 3.0F; };
    const glm::vec2 uv = mean(mannequin.texture_coordinate);
    const std::uint16_t actuator = map.at(uv);
    ++hits[actuator];
    if (actuator == 0) continue;
    const glm::vec3 p = mean(mannequin.position_bind);
    const bool says_left = map.names[actuator - 1U].ends_with("left");
    EXPECT_EQ(p.x > 0, says_left) << map.names[actuator - 1U] << " at x = " << p.x;
    EXPECT_LT(std::abs(p.x), 0.23) << "on the torso, not on an arm";
    EXPECT_GT(p.y, 0.93);
    EXPECT_LT(p.y, 1.46);
    const int band = (actuator - 1) / 2;
    EXPECT_NEAR(p.y, 1.45 - 0.17 * (band + 0.5), 0.12);
  }
  for (std::size_t actuator = 1; actuator <= 6; ++actuator) EXPECT_GE(hits[actuator], 80U) << actuator;
}

}  // namespace
}  // namespace vestige
