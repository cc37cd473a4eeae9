#include "traces/scene/subdivision.hpp"

#include <gtest/gtest.h>

#include <array>
#include <map>
#include <set>
#include <tuple>

#include "tests/support/builtin_avatar.hpp"
#include "tests/support/small_avatar.hpp"

namespace vestige {
namespace {

using Point = std::tuple<float, float, float>;

Point point_of(const Avatar& avatar, std::uint32_t vertex) {
  const glm::vec3& p = avatar.position_bind[vertex];
  return {p.x + 0.0F, p.y + 0.0F, p.z + 0.0F};
}

/// Edges, by the places of their ends, that are not walked as often in one direction as in the other: 0 for a closed
/// surface, whatever seams its texture has.
std::size_t open_edges(const Avatar& avatar) {
  std::map<std::pair<Point, Point>, int> walked;
  for (const glm::uvec3& corner : avatar.triangles)
    for (int i = 0; i < 3; ++i) {
      const Point from = point_of(avatar, corner[i]);
      const Point to = point_of(avatar, corner[(i + 1) % 3]);
      if (from < to) ++walked[{from, to}];
      if (to < from) --walked[{to, from}];
    }
  std::size_t open = 0;
  for (const auto& [edge, count] : walked)
    if (count != 0) ++open;
  return open;
}

Avatar tetrahedron() {
  return test::rigid_avatar({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}});
}

TEST(Subdivision, HalvesEveryEdgeOnceAndKeepsTheTrianglesOrder) {
  const Avatar fine = subdivided(tetrahedron());
  EXPECT_EQ(fine.triangles.size(), 16U);
  EXPECT_EQ(fine.position_bind.size(), 4U + 6U);
  const glm::uvec3& first = fine.triangles[0];
  EXPECT_EQ(first.x, 0U);
  EXPECT_EQ(fine.position_bind[first.y], glm::vec3(0, 0.5F, 0));
  EXPECT_EQ(fine.texture_coordinate[first.y], glm::vec2(0, 0.5F));
  EXPECT_EQ(fine.position_bind[first.z], glm::vec3(0.5F, 0, 0));
  EXPECT_EQ(fine.influence_count, 1U);
}

TEST(Subdivision, LeavesAClosedSurfaceClosedAlsoAcrossTheSeamsOfItsTexture) {
  Avatar avatar = tetrahedron();
  EXPECT_EQ(open_edges(subdivided(subdivided(avatar))), 0U);
  avatar = test::builtin_avatar();
  ASSERT_EQ(open_edges(avatar), 0U);
  EXPECT_EQ(open_edges(subdivided(avatar)), 0U);
  avatar.triangles.pop_back();
  EXPECT_EQ(open_edges(subdivided(avatar)), 6U);
}

TEST(Subdivision, MovesTheTwoSidesOfASeamAlike) {
  const Avatar fine = subdivided(test::builtin_avatar());
  std::map<Point, std::pair<std::array<std::uint16_t, kMaxInfluences>, std::array<float, kMaxInfluences>>> moved_by;
  for (std::uint32_t i = 0; i < fine.position_bind.size(); ++i) {
    const std::pair influences = {fine.influences[i].palette, fine.influences[i].weight};
    EXPECT_EQ(moved_by.try_emplace(point_of(fine, i), influences).first->second, influences) << i;
  }
}

TEST(Subdivision, MeansWeightsByJointAndKeepsTheHeaviestOfTooMany) {
  Avatar avatar = tetrahedron();
  avatar.influence_count = 8;
  for (std::size_t k = 0; k < 8; ++k) {
    avatar.influences[0].palette[k] = static_cast<std::uint16_t>(k);
    avatar.influences[0].weight[k] = 0.125F;
    avatar.influences[1].palette[k] = static_cast<std::uint16_t>(k + 4);
    avatar.influences[1].weight[k] = 0.125F;
  }
  const Avatar fine = subdivided(avatar);
  const Influences& mean = fine.influences[fine.triangles[0].z];  // between vertices 0 and 1
  EXPECT_EQ(mean.palette, (std::array<std::uint16_t, 8>{0, 1, 2, 3, 4, 5, 6, 7}));
  EXPECT_EQ(mean.weight[0], static_cast<float>(1.0 / 12));
  EXPECT_EQ(mean.weight[7], static_cast<float>(2.0 / 12));
  EXPECT_EQ(fine.influence_count, 8U);
}

}  // namespace
}  // namespace vestige
