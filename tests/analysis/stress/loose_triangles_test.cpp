#include "analysis/stress/loose_triangles.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <random>
#include <stdexcept>

#include "detector/detector.hpp"
#include "detector/detectors/make_detectors.hpp"
#include "detector/skinning.hpp"

namespace vestige {
namespace {

/// Any finite float: denormals and huge ones too.
float any_float(std::mt19937& random) {
  for (;;) {
    const float value = std::bit_cast<float>(static_cast<std::uint32_t>(random()));
    if (std::isfinite(value) && value != 0) return value;
  }
}

TEST(LooseTriangles, AreSkinnedToExactlyTheirCorners) {
  std::mt19937 random(1);
  std::vector<LooseTriangle> before(500);
  std::vector<LooseTriangle> now(500);
  for (auto* triangles : {&before, &now})
    for (LooseTriangle& triangle : *triangles)
      for (glm::vec3& corner : triangle) corner = {any_float(random), any_float(random), any_float(random)};
  const Avatar avatar = loose_triangles(now.size());
  const DetectorFrame frame = loose_frame(before, now, {});
  std::vector<glm::vec3> skinned_before;
  std::vector<glm::vec3> skinned_now;
  skin_vertices(avatar, frame.palette_before, skinned_before);
  skin_vertices(avatar, frame.palette, skinned_now);
  for (std::size_t i = 0; i < now.size(); ++i)
    for (int corner = 0; corner < 3; ++corner) {
      const glm::uint vertex = avatar.triangles[i][corner];
      const auto place = static_cast<std::size_t>(corner);
      ASSERT_EQ(skinned_before[vertex], before[i][place]) << i;
      ASSERT_EQ(skinned_now[vertex], now[i][place]) << i;
    }
}

TEST(LooseTriangles, AreFoundByADetectorUnderTheirNumber) {
  const LooseTriangle far = {glm::vec3(5, 0, 0), glm::vec3(6, 0, 0), glm::vec3(5, 1, 0)};
  const LooseTriangle hit = {glm::vec3(0, 0, 0), glm::vec3(1, 0, 0), glm::vec3(0, 1, 0)};
  const std::vector<LooseTriangle> triangles = {far, hit};
  const Avatar avatar = loose_triangles(2);
  const ActuatorMap map;
  const auto detector = make_cpu_detector(avatar, map, {});
  ContactRow row;
  detector->detect(
      loose_frame(triangles, triangles, {{0, {9, 9, 1}, {9, 9, -1}}, {1, {0.25F, 0.25F, 1}, {0.25F, 0.25F, -1}}}), row);
  ASSERT_EQ(row.size(), 2U);
  EXPECT_FALSE(row[0].hit());
  EXPECT_EQ(row[1].triangle, 1U);
  EXPECT_EQ(row[1].t, 0.5F);
}

TEST(LooseTriangles, RefuseMoreThanAPaletteCanMove) {
  EXPECT_NO_THROW(loose_triangles(kMostLooseTriangles));
  EXPECT_THROW(loose_triangles(kMostLooseTriangles + 1), std::invalid_argument);
}

}  // namespace
}  // namespace vestige
