#include "traces/body/limbs.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <glm/geometric.hpp>
#include <limits>

#include "tests/support/builtin_avatar.hpp"
#include "tests/support/small_avatar.hpp"
#include "traces/scene/pose.hpp"
#include "traces/scene/reference_skinning.hpp"

namespace vestige {
namespace {

/// A sphere of a limb at rest.
struct Placed {
  glm::dvec3 centre_m;
  double radius_m;
};

std::vector<Placed> at_rest(const Avatar& avatar, const std::string& limb) {
  std::vector<glm::dmat4> world;
  world_matrices(avatar, rest_pose(avatar), world);
  std::vector<Placed> placed;
  for (const LimbSphere& sphere : fit_limb(avatar, limb))
    placed.push_back({glm::dvec3(world[sphere.node] * glm::dvec4(sphere.centre, 1)), double{sphere.radius_m}});
  return placed;
}

TEST(Limbs, AreWhereTheBodyIsAndAsLarge) {
  const Avatar& avatar = test::builtin_avatar();
  for (const std::string& limb : limb_names()) {
    const std::vector<Placed> spheres = at_rest(avatar, limb);
    ASSERT_FALSE(spheres.empty()) << limb;
    EXPECT_LE(spheres.size(), 8U) << limb;
    for (const Placed& sphere : spheres) {
      EXPECT_GT(sphere.radius_m, 0.02) << limb;
      EXPECT_LT(sphere.radius_m, 0.25) << limb;
    }
  }
  // The mannequin stands with its arms stretched out sideways; its left is +x.
  for (const Placed& sphere : at_rest(avatar, "hand_left")) EXPECT_GT(sphere.centre_m.x, 0.5);
  for (const Placed& sphere : at_rest(avatar, "hand_right")) EXPECT_LT(sphere.centre_m.x, -0.5);
  for (const Placed& sphere : at_rest(avatar, "head")) EXPECT_GT(sphere.centre_m.y, 1.5);
  for (const Placed& sphere : at_rest(avatar, "foot_left")) EXPECT_LT(sphere.centre_m.y, 0.15);
  EXPECT_GE(at_rest(avatar, "forearm_left").size(), 2U) << "longer than thick";
}

TEST(Limbs, TogetherFillTheSkin) {
  const Avatar& avatar = test::builtin_avatar();
  std::vector<Placed> all;
  for (const std::string& limb : limb_names())
    for (const Placed& sphere : at_rest(avatar, limb)) all.push_back(sphere);
  double worst_m = 0;
  double sum_m = 0;
  const std::vector<glm::dvec3> skin = skin_at_rest(avatar);
  for (const glm::dvec3& vertex : skin) {
    double nearest_m = std::numeric_limits<double>::infinity();
    for (const Placed& sphere : all)
      nearest_m = std::min(nearest_m, std::abs(glm::distance(vertex, sphere.centre_m) - sphere.radius_m));
    worst_m = std::max(worst_m, nearest_m);
    sum_m += nearest_m;
  }
  EXPECT_LT(worst_m, 0.12);
  EXPECT_LT(sum_m / static_cast<double>(skin.size()), 0.025);
}

TEST(Limbs, AreNotGuessedWhereJointsDoNotTellThem) {
  const Avatar triangle = test::rigid_avatar({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}});
  for (const std::string& limb : limb_names()) EXPECT_TRUE(fit_limb(triangle, limb).empty()) << limb;
  EXPECT_TRUE(fit_limb(test::builtin_avatar(), "tail").empty());
}

}  // namespace
}  // namespace vestige
