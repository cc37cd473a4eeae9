// The built-in avatar: a closed body that bends without collapsing, as its users see it.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <map>
#include <set>
#include <tuple>

#include "tests/support/builtin_avatar.hpp"
#include "traces/scene/pose.hpp"
#include "traces/scene/reference_skinning.hpp"

namespace vestige {
namespace {

using test::builtin_avatar;

/// Triangles with one number for each place: vertices that only texture seams split are one.
std::vector<glm::uvec3> welded_triangles() {
  std::map<std::tuple<float, float, float>, unsigned> places;
  std::vector<unsigned> place;
  for (const glm::vec3& p : builtin_avatar().position_bind)
    place.push_back(places.try_emplace({p.x, p.y, p.z}, static_cast<unsigned>(places.size())).first->second);
  std::vector<glm::uvec3> triangles;
  for (const glm::uvec3& t : builtin_avatar().triangles) triangles.emplace_back(place[t.x], place[t.y], place[t.z]);
  return triangles;
}

std::vector<glm::dvec3> skinned(const Pose& pose) {
  std::vector<glm::dvec3> positions;
  skin_reference(builtin_avatar(), pose, glm::dvec3(0), positions);
  return positions;
}

double volume_m3(const std::vector<glm::dvec3>& positions) {
  double volume = 0;
  for (const glm::uvec3& t : builtin_avatar().triangles)
    volume += glm::dot(positions[t.x], glm::cross(positions[t.y], positions[t.z])) / 6;
  return volume;
}

TEST(Mannequin, IsOneClosedManifoldWithoutHandles) {
  const auto triangles = welded_triangles();
  std::map<std::pair<unsigned, unsigned>, int> edges;
  std::set<unsigned> vertices;
  for (const glm::uvec3& t : triangles)
    for (int i = 0; i < 3; ++i) {
      ++edges[{t[i], t[(i + 1) % 3]}];
      vertices.insert(t[i]);
    }
  for (const auto& [edge, count] : edges) {
    ASSERT_EQ(count, 1) << "two triangles run along an edge in the same direction";
    ASSERT_TRUE(edges.contains({edge.second, edge.first})) << "an open edge";
  }
  EXPECT_EQ(vertices.size() + triangles.size() - edges.size() / 2, 2U) << "one piece, of the topology of a sphere";
  // No two fans may share a vertex: walking around it over its triangles meets all of them.
  std::map<unsigned, std::map<unsigned, unsigned>> fans;
  for (const glm::uvec3& t : triangles)
    for (int i = 0; i < 3; ++i) fans[t[i]][t[(i + 1) % 3]] = t[(i + 2) % 3];
  for (const auto& [vertex, next] : fans) {
    std::size_t steps = 1;
    for (unsigned at = next.begin()->second; at != next.begin()->first; at = next.at(at)) ++steps;
    EXPECT_EQ(steps, next.size()) << "at vertex " << vertex;
  }
}

TEST(Mannequin, HasThePapersSizeAndAPersonsHeight) {
  EXPECT_NEAR(static_cast<double>(builtin_avatar().triangles.size()), 5000, 250);
  EXPECT_NEAR(static_cast<double>(builtin_avatar().position_bind.size()), 3000, 150);
  EXPECT_THAT(builtin_avatar().joint_count, testing::AllOf(testing::Ge(18U), testing::Le(22U)));
  EXPECT_LE(builtin_avatar().influence_count, 4U);
  EXPECT_TRUE(builtin_avatar().warnings.empty());
  const auto positions = skinned(rest_pose(builtin_avatar()));
  const auto [low, high] = std::ranges::minmax(positions, {}, &glm::dvec3::y);
  EXPECT_NEAR(low.y, 0, 0.002);
  EXPECT_NEAR(high.y, 1.75, 0.01);
  EXPECT_NEAR(volume_m3(positions), 0.065, 0.015);  // a person of this height weighs about as many kilograms as litres
}

TEST(Mannequin, NamesItsJointsAsAnatomyDoes) {
  std::set<std::string> names;
  for (const Node& node : builtin_avatar().nodes) names.insert(node.name);
  for (const char* name :
       {"pelvis", "lumbar_spine", "thoracic_spine", "neck", "head", "clavicle_left", "upper_arm_right", "forearm_left",
        "hand_right", "thigh_left", "shin_right", "foot_left", "toes_right"})
    EXPECT_TRUE(names.contains(name)) << name;
}

TEST(Mannequin, IsItsOwnMirrorImage) {
  std::map<std::tuple<float, float, float>, int> places;
  for (const glm::vec3& p : builtin_avatar().position_bind) ++places[{p.x, p.y, p.z}];
  for (const auto& [place, count] : places) {
    const auto& [x, y, z] = place;
    EXPECT_TRUE(places.contains({-x, y, z})) << x << " " << y << " " << z;
  }
}

double distance_to_segment_m(const glm::dvec3& p, const glm::dvec3& a, const glm::dvec3& b) {
  const glm::dvec3 ab = b - a;
  const double length_squared = glm::dot(ab, ab);
  const double along = length_squared > 0 ? std::clamp(glm::dot(p - a, ab) / length_squared, 0.0, 1.0) : 0;
  return glm::distance(p, a + along * ab);
}

TEST(Mannequin, FollowsOnlyTheBonesThatAreNear) {
  const Avatar& avatar = builtin_avatar();
  std::vector<glm::dmat4> world;
  world_matrices(avatar, rest_pose(avatar), world);
  const auto at_m = [&](int node) { return glm::dvec3(world[static_cast<std::size_t>(node)][3]); };
  for (std::size_t i = 0; i < avatar.influences.size(); ++i)
    for (std::size_t k = 0; k < kMaxInfluences && avatar.influences[i].weight[k] > 0; ++k) {
      const int joint = avatar.palette[avatar.influences[i].palette[k]].node;
      double nearest_m = glm::distance(glm::dvec3(avatar.position_bind[i]), at_m(joint));
      for (int child = 0; child < static_cast<int>(avatar.nodes.size()); ++child)
        if (avatar.nodes[static_cast<std::size_t>(child)].parent == joint)
          nearest_m = std::min(nearest_m, distance_to_segment_m(avatar.position_bind[i], at_m(joint), at_m(child)));
      EXPECT_LT(nearest_m, 0.27) << "vertex " << i << " and " << avatar.nodes[static_cast<std::size_t>(joint)].name;
    }
}

class MannequinMoves : public testing::TestWithParam<const char*> {
 protected:
  const Animation& animation() const {
    return *std::ranges::find(builtin_avatar().animations, GetParam(), &Animation::name);
  }
};

INSTANTIATE_TEST_SUITE_P(Animations, MannequinMoves, testing::Values("idle", "walk", "reach", "spin"),
                         [](const auto& animation) { return std::string(animation.param); });

/// What a twisted or folded joint does wrong: it loses volume, or pulls its surface together into a point.
TEST_P(MannequinMoves, WithoutCollapse) {
  const auto rest = skinned(rest_pose(builtin_avatar()));
  const double rest_volume_m3 = volume_m3(rest);
  constexpr int kPoses = 60;
  for (int k = 0; k < kPoses; ++k) {
    const auto positions =
        skinned(sample_animation(builtin_avatar(), animation(), animation().duration_s * k / kPoses));
    EXPECT_NEAR(volume_m3(positions) / rest_volume_m3, 1, 0.05) << k;
    std::size_t collapsed = 0;
    for (const glm::uvec3& t : builtin_avatar().triangles)
      for (int i = 0; i < 3; ++i) {
        const double before_m = glm::distance(rest[t[i]], rest[t[(i + 1) % 3]]);
        const double now_m = glm::distance(positions[t[i]], positions[t[(i + 1) % 3]]);
        collapsed += now_m < 0.25 * before_m ? 1U : 0U;
        EXPECT_LT(now_m, 4 * before_m + 0.005) << "triangle at edge " << i << ", pose " << k;
      }
    EXPECT_LT(collapsed, 3 * builtin_avatar().triangles.size() / 200)
        << "edges under a quarter of their length, pose " << k;
  }
}

TEST_P(MannequinMoves, OnTheGround) {
  constexpr int kPoses = 60;
  for (int k = 0; k < kPoses; ++k) {
    const auto positions =
        skinned(sample_animation(builtin_avatar(), animation(), animation().duration_s * k / kPoses));
    const double lowest_m = std::ranges::min(positions, {}, &glm::dvec3::y).y;
    EXPECT_NEAR(lowest_m, 0, 0.015) << "pose " << k;
  }
}

TEST_P(MannequinMoves, InALoop) {
  const auto first = skinned(sample_animation(builtin_avatar(), animation(), 0));
  const auto last = skinned(sample_animation(builtin_avatar(), animation(), animation().duration_s));
  double moved_m = 0;
  const auto middle = skinned(sample_animation(builtin_avatar(), animation(), animation().duration_s * 0.3));
  for (std::size_t i = 0; i < first.size(); ++i) {
    EXPECT_LT(glm::distance(first[i], last[i]), 1e-6);
    moved_m = std::max(moved_m, glm::distance(first[i], middle[i]));
  }
  EXPECT_GT(moved_m, 0.02) << "it does move";
}

}  // namespace
}  // namespace vestige
