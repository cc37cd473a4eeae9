#include "detector/approximate/approximate_detectors.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <string_view>
#include <vector>

#include "detector/detectors/make_detectors.hpp"
#include "detector/stages.hpp"
#include "tests/support/builtin_avatar.hpp"
#include "tests/support/builtin_map.hpp"
#include "tests/support/scenario_names.hpp"
#include "tests/support/scene_run.hpp"
#include "tests/support/small_avatar.hpp"
#include "tests/support/test_data.hpp"
#include "traces/base/error.hpp"
#include "traces/gltf/avatar_gltf.hpp"
#include "traces/scenarios/scenarios.hpp"

namespace vestige {
namespace {

using test::builtin_avatar;
using test::builtin_map;

using Maker = std::unique_ptr<Detector> (*)(const Avatar&, const ActuatorMap&, const DetectorOptions&);

struct Kind {
  const char* name;
  Maker make;
};

std::unique_ptr<Detector> make_decimated(const Avatar& avatar, const ActuatorMap& map, const DetectorOptions& options) {
  return make_decimated_detector(0.1, avatar, map, options);
}

std::string name_of_kind(const ::testing::TestParamInfo<Kind>& test) {
  return test.param.name;
}

class ApproximateDetector : public ::testing::TestWithParam<Kind> {};
INSTANTIATE_TEST_SUITE_P(Each, ApproximateDetector,
                         ::testing::Values(Kind{"boxes", make_boxes_detector}, Kind{"capsules", make_capsules_detector},
                                           Kind{"decimated", make_decimated}),
                         name_of_kind);

class ShapesDetector : public ::testing::TestWithParam<Kind> {};
INSTANTIATE_TEST_SUITE_P(Each, ShapesDetector,
                         ::testing::Values(Kind{"boxes", make_boxes_detector},
                                           Kind{"capsules", make_capsules_detector}),
                         name_of_kind);

DetectorOptions with(Method method) {
  return {Surface::kAll, PlaneSet::all(), method};
}

/// Two bones in a row along x, each with a rod of 1 x 0.2 x 0.2: the first from 0 to 1 moved by node 0, the second
/// from 1 to 2 by node 1, whose origin is the elbow at x = 1. Texture coordinates: u is x / 2.
Avatar limb() {
  Avatar avatar;
  avatar.nodes.resize(2);
  avatar.nodes[1].parent = 0;
  avatar.nodes[1].rest.translation = {1, 0, 0};
  avatar.node_order = {0, 1};
  avatar.palette.resize(2);
  avatar.palette[1].node = 1;
  avatar.palette[1].inverse_bind[3] = {-1, 0, 0, 1};
  avatar.joint_count = 2;
  for (std::uint16_t bone = 0; bone < 2; ++bone) {
    const auto first = static_cast<std::uint32_t>(avatar.position_bind.size());
    for (int corner = 0; corner < 8; ++corner) {
      const float x = static_cast<float>(bone) + static_cast<float>(corner & 1);
      avatar.position_bind.emplace_back(x, (corner & 2) != 0 ? 0.1F : -0.1F, (corner & 4) != 0 ? 0.1F : -0.1F);
      avatar.texture_coordinate.emplace_back(x / 2, 0.5F);
      Influences moved;
      moved.palette[0] = bone;
      moved.weight[0] = 1;
      avatar.influences.push_back(moved);
    }
    for (const glm::uvec3& triangle : {glm::uvec3(0, 4, 6),
                                       {0, 6, 2},
                                       {1, 3, 7},
                                       {1, 7, 5},
                                       {0, 1, 5},
                                       {0, 5, 4},
                                       {2, 6, 7},
                                       {2, 7, 3},
                                       {0, 2, 3},
                                       {0, 3, 1},
                                       {4, 5, 7},
                                       {4, 7, 6}})
      avatar.triangles.push_back(first + triangle);
  }
  return avatar;
}

/// Actuator k + 1 covers a quarter of the limb's length.
ActuatorMap quarters() {
  ActuatorMap map;
  map.width = 4;
  map.actuator = {1, 2, 3, 4};
  map.actuator_count = 4;
  map.names = {"a", "b", "c", "d"};
  return map;
}

TEST_P(ShapesDetector, FindsWhereALimbOfTwoBonesIsEnteredAndLeft) {
  const Avatar avatar = limb();
  const ActuatorMap map = quarters();
  const auto detector = GetParam().make(avatar, map, with(Method::kStatic));
  std::vector<Segment> segments;
  for (std::uint32_t i = 0; i < 4; ++i) {
    const float x = 0.25F + 0.5F * static_cast<float>(i);
    segments.push_back({i, {x, 0, 1}, {x, 0, 0}});  // from above into the limb
  }
  segments.push_back({4, {0.25F, 0, 0}, {0.25F, 0, 1}});  // out of it
  segments.push_back({5, {0.25F, 0, 0.5F}, {0.25F, 0, 1}});
  segments.push_back({6, {0.5F, 0, 0}, {1.5F, 0, 0}});  // from one bone into the other
  ContactRow row;
  const DetectorWork work = detector->detect(test::frame_of(avatar, segments), row);
  EXPECT_EQ(work.pairs_meeting, 5U);
  for (std::uint32_t i = 0; i < 4; ++i) {
    ASSERT_TRUE(row[i].hit()) << i;
    EXPECT_EQ(row[i].actuator, i + 1);
    EXPECT_EQ(row[i].side, 1);
    EXPECT_NEAR(row[i].t, 0.9, 0.03);  // the skin is at 0.1; a capsule bulges and shrinks around it
    EXPECT_NEAR(row[i].position.z, 0.1, 0.03);
    EXPECT_NEAR(row[i].speed_m_per_s, 100, 1e-6);
    EXPECT_EQ(row[i].actuator, map.at(row[i].triangle, row[i].texture_coordinate));
  }
  ASSERT_TRUE(row[4].hit());
  EXPECT_EQ(row[4].side, -1);
  EXPECT_NEAR(row[4].t, 0.1, 0.03);
  EXPECT_FALSE(row[5].hit());
  EXPECT_FALSE(row[6].hit());
}

TEST_P(ShapesDetector, FindsWhenASphereFirstTouchesTheLimb) {
  const Avatar avatar = limb();
  const ActuatorMap map = quarters();
  for (const Method method : {Method::kStatic, Method::kCarried}) {
    const auto detector = GetParam().make(avatar, map, with(method));
    DetectorFrame frame = test::frame_of(avatar, {{0, {0.25F, 0, 1}, {0.25F, 0, 0}, 0.2F},
                                                  {1, {1.25F, 0, 0.25F}, {1.25F, 0, 0.25F}, 0.2F},
                                                  {2, {0.5F, 0, 0}, {0.5F, 0, 0.01F}, 0.02F},
                                                  {3, {0.25F, 0, 0}, {0.25F, 0, 1}, 0.02F},
                                                  {4, {0.25F, 0, 1}, {0.25F, 0, 0.4F}, 0.2F},
                                                  {5, {1.75F, 0, 1}, {1.75F, 0, 0}, 0.2F}});
    frame.palette_before = frame.palette;
    ContactRow row;
    detector->detect(frame, row);
    ASSERT_TRUE(row[0].hit() && row[1].hit() && row[3].hit() && row[5].hit());
    EXPECT_NEAR(row[0].t, 0.7, 0.03);
    EXPECT_EQ(row[0].side, 1);
    EXPECT_EQ(row[0].actuator, 1);
    EXPECT_NEAR(row[0].position.z, 0.1, 0.03) << "on the skin";
    EXPECT_NEAR(row[0].speed_m_per_s, 100, 1e-6);
    EXPECT_EQ(row[1].t, 0) << "it rests";
    EXPECT_EQ(row[1].actuator, 3);
    EXPECT_EQ(row[1].speed_m_per_s, 0);
    EXPECT_FALSE(row[2].hit()) << "wholly inside";
    EXPECT_NEAR(row[3].t, 0.08, 0.03) << "from inside";
    EXPECT_EQ(row[3].side, -1);
    EXPECT_FALSE(row[4].hit()) << "it stays away";
    EXPECT_EQ(row[5].actuator, 4);
  }
}

TEST_P(ShapesDetector, TestsSpheresThatAreLargerThanAShape) {
  const Avatar avatar = limb();
  const ActuatorMap map = quarters();
  const auto detector = GetParam().make(avatar, map, with(Method::kStatic));
  ContactRow row;
  detector->detect(test::frame_of(avatar, {{0, {0.25F, 0.03F, 0.03F}, {0.26F, 0.04F, 0.04F}, 0.2F},
                                           {1, {0.25F, 0.03F, 0.03F}, {0.25F, 0.03F, 0.03F}, 0.2F}}),
                   row);
  for (const Contact& contact : row) {
    ASSERT_TRUE(contact.hit()) << "nothing of the limb is deeper inside than the sphere reaches";
    EXPECT_EQ(contact.t, 0);
  }
}

TEST_P(ShapesDetector, CarriesSpheresAlongAndScalesThemWithTheJoint) {
  const Avatar avatar = limb();
  const ActuatorMap map = quarters();
  const auto detector = GetParam().make(avatar, map, with(Method::kCarried));
  // The limb moves 1 m up through a sphere that stays, and then becomes twice as thick.
  DetectorFrame frame = test::frame_of(avatar, {{0, {0.25F, 0, 0.5F}, {0.25F, 0, 0.5F}, 0.1F}});
  frame.palette_before = frame.palette;
  for (SkinMatrix& matrix : frame.palette) matrix.column[3].z += 1;
  ContactRow row;
  detector->detect(frame, row);
  ASSERT_TRUE(row[0].hit());
  EXPECT_NEAR(row[0].t, 0.3, 0.03) << "the skin at 0.1 reaches the sphere's lower end at 0.4";
  EXPECT_EQ(row[0].side, 1);
  frame = test::frame_of(avatar, {{0, {0.5F, 0, 1}, {0.5F, 0, 0}, 0.1F}});
  for (SkinMatrix& matrix : frame.palette)
    for (int column = 0; column < 3; ++column) matrix.column[static_cast<std::size_t>(column)] *= 2.0F;
  frame.palette_before = frame.palette;
  detector->detect(frame, row);
  ASSERT_TRUE(row[0].hit());
  EXPECT_NEAR(row[0].t, 0.7, 0.06) << "the skin at 0.2, the centre at 0.3";
  EXPECT_NEAR(row[0].position.z, 0.2, 0.06);
}

TEST_P(ShapesDetector, GoesAlongWithTheBones) {
  const Avatar avatar = limb();
  const ActuatorMap map = quarters();
  const auto detector = GetParam().make(avatar, map, with(Method::kStatic));
  DetectorFrame frame = test::frame_of(avatar, {{0, {1, 0.6F, 1}, {1, 0.6F, 0}}, {1, {1.5F, 0, 1}, {1.5F, 0, 0}}});
  Pose pose = rest_pose(avatar);
  const float half = std::sqrt(0.5F);
  pose.nodes[1].rotation = glm::quat(half, 0, 0, half);  // the elbow bends up by a right angle
  std::vector<glm::dmat4> world;
  world_matrices(avatar, pose, world);
  build_palette(avatar, world, glm::dvec3(0), frame.palette);
  ContactRow row;
  detector->detect(frame, row);
  ASSERT_TRUE(row[0].hit());
  EXPECT_TRUE(row[0].actuator == 3 || row[0].actuator == 4) << row[0].actuator;
  EXPECT_NEAR(row[0].t, 0.9, 0.03);
  EXPECT_FALSE(row[1].hit());
}

TEST_P(ShapesDetector, CarriedSeesWhatALimbSweepsOver) {
  const Avatar avatar = limb();
  const ActuatorMap map = quarters();
  const Segment still = {0, {0.5F, 0, 0.5F}, {0.5F, 0, 0.5F}};
  DetectorFrame frame = test::frame_of(avatar, {still});
  frame.palette_before = frame.palette;
  for (SkinMatrix& matrix : frame.palette) matrix.column[3].z += 1;  // the limb moves from below it to above it
  ContactRow row;
  GetParam().make(avatar, map, with(Method::kStatic))->detect(frame, row);
  EXPECT_FALSE(row[0].hit());
  GetParam().make(avatar, map, with(Method::kCarried))->detect(frame, row);
  ASSERT_TRUE(row[0].hit());
  EXPECT_NEAR(row[0].t, 0.4, 0.03);
  EXPECT_NEAR(row[0].speed_m_per_s, 100, 1e-4);
}

TEST_P(ShapesDetector, HasNoContinuousMotion) {
  EXPECT_THROW(GetParam().make(limb(), quarters(), with(Method::kCcd)), UsageError);
}

TEST_P(ShapesDetector, PassesThroughSkinWithoutActuatorsIfAsked) {
  const Avatar avatar = limb();
  ActuatorMap map = quarters();
  map.actuator = {0, 0, 0, 4};
  const std::vector<Segment> segments = {{0, {1.25F, 0, 1}, {1.25F, 0, 0}}, {1, {1.75F, 0, 1}, {1.75F, 0, 0}}};
  ContactRow row;
  GetParam().make(avatar, map, {Surface::kMapped, PlaneSet::all()})->detect(test::frame_of(avatar, segments), row);
  EXPECT_FALSE(row[0].hit());
  EXPECT_EQ(row[1].actuator, 4);
  GetParam().make(avatar, map, {Surface::kAll, PlaneSet::all()})->detect(test::frame_of(avatar, segments), row);
  ASSERT_TRUE(row[0].hit());
  EXPECT_EQ(row[0].actuator, 0);
}

TEST_P(ApproximateDetector, FindsAboutAsManyContactsAsTheSkinHas) {
  const std::uint32_t colliders = 50;
  const auto scene = test::scene("swarm", builtin_avatar(), colliders, 120, 60);
  for (const Method method : {Method::kStatic, Method::kCarried}) {
    const auto exact = make_cpu_detector(builtin_avatar(), builtin_map(), with(method));
    const std::size_t truth = test::run_scene(scene, builtin_avatar(), colliders, *exact).contacts();
    const auto detector = GetParam().make(builtin_avatar(), builtin_map(), with(method));
    EXPECT_TRUE(detector->is_approximate());
    EXPECT_STREQ(detector->name(), GetParam().name);
    const std::size_t found = test::run_scene(scene, builtin_avatar(), colliders, *detector).contacts();
    EXPECT_GT(truth, 30U);
    EXPECT_GT(found, truth * 2 / 3) << name_of(method);
    EXPECT_LT(found, truth * 3 / 2) << name_of(method);
  }
}

// A collider that moves far makes every part's margin so wide that all pairs are tested.
TEST_P(ShapesDetector, LosesNoContactBecausePartsAreFarAway) {
  const std::uint32_t colliders = 50;
  auto scene = test::scene("swarm", builtin_avatar(), colliders, 60, 30);
  const auto detector = GetParam().make(builtin_avatar(), builtin_map(), with(Method::kCarried));
  const test::SceneRun near = test::run_scene(scene, builtin_avatar(), colliders, *detector);
  for (std::size_t k = 0; k < scene.size(); ++k)
    scene[k].colliders.push_back({colliders, {k % 2 == 0 ? 1e5 : 2e5, 0, 0}});
  test::SceneRun all = test::run_scene(scene, builtin_avatar(), colliders + 1, *detector);
  for (ContactRow& row : all.rows) {  // without the last column
    ContactRow first(colliders);
    std::copy_n(row.begin(), colliders, first.begin());
    row = first;
  }
  EXPECT_GT(near.contacts(), 20U);
  EXPECT_EQ(hash_of(all), hash_of(near));
}

TEST_P(ApproximateDetector, SaysWhereItsTimeGoesWhichChangesNoBit) {
  const auto scene = test::scene("hug", builtin_avatar(), 12, 8, 20);
  const auto detector = GetParam().make(builtin_avatar(), builtin_map(), with(Method::kStatic));
  const test::SceneRun untimed = test::run_scene(scene, builtin_avatar(), 12, *detector);
  ASSERT_GT(untimed.contacts(), 0U);
  StageClock clock;
  detector->time_stages(&clock);
  EXPECT_EQ(hash_of(test::run_scene(scene, builtin_avatar(), 12, *detector)), hash_of(untimed));
  std::vector<std::string> names;
  for (const StageTime& time : clock.times()) names.emplace_back(kStageNames[static_cast<std::size_t>(time.stage)]);
  EXPECT_EQ(names, (std::vector<std::string>{"candidates", "skinning", "test", "decision"}));
}

TEST_P(ApproximateDetector, RunsThroughEveryScenario) {
  const auto detector = GetParam().make(builtin_avatar(), builtin_map(), with(Method::kCarried));
  for (const std::string_view scenario : test::scenario_names()) {
    const std::uint32_t colliders = find_scenario(scenario)->default_count;
    const auto scene = test::scene(scenario, builtin_avatar(), colliders, 60, 30);
    const std::size_t contacts = test::run_scene(scene, builtin_avatar(), colliders, *detector).contacts();
    // The 4 mm of slide may stay within one shape, and the 7 mm of rest outside of all.
    EXPECT_TRUE(contacts > 0 || scenario == "slide" || scenario == "rest") << scenario;
  }
}

TEST_P(ApproximateDetector, RunsWithAvatarsFromElsewhere) {
  VESTIGE_REQUIRE_DATA(test::data("avatars"));
  for (const char* file : {"CesiumMan.glb", "KayKit_Knight.glb", "MakeHumanBase_cc0_8inf.glb"}) {
    const Avatar avatar = parse_avatar_glb(read_avatar_glb(test::data("avatars/avatars") / file), file);
    const auto detector = GetParam().make(avatar, ActuatorMap(), with(Method::kCarried));
    const auto scene = test::scene("swarm", avatar, 50, 30, 30);
    EXPECT_GT(test::run_scene(scene, avatar, 50, *detector).contacts(), 10U) << file;
  }
}

/// A plate from (0, 0) to (1, 1) of `across` x `across` squares. Its texture coordinates are x and y.
Avatar plate(std::uint32_t across) {
  std::vector<glm::vec3> vertices;
  std::vector<glm::uvec3> triangles;
  for (std::uint32_t y = 0; y <= across; ++y)
    for (std::uint32_t x = 0; x <= across; ++x) {
      vertices.emplace_back(static_cast<float>(x) / static_cast<float>(across),
                            static_cast<float>(y) / static_cast<float>(across), 0);
      if (x == across || y == across) continue;
      const std::uint32_t first = y * (across + 1) + x;
      triangles.push_back({first, first + 1, first + across + 2});
      triangles.push_back({first, first + across + 2, first + across + 1});
    }
  return test::rigid_avatar(vertices, triangles);
}

TEST(DecimatedDetector, TellsTheActuatorOfTheSkinThatItStandsFor) {
  const Avatar avatar = plate(20);
  const ActuatorMap map = quarters();
  std::vector<Segment> segments;
  for (std::uint32_t i = 0; i < 12; ++i) {
    const float x = (static_cast<float>(i) + 0.5F) / 12;
    segments.push_back({i, {x, 0.4F, 1}, {x, 0.4F, -1}});
  }
  ContactRow row;
  const auto detector = make_decimated_detector(0.1, avatar, map, with(Method::kStatic));
  const DetectorWork work = detector->detect(test::frame_of(avatar, segments), row);
  EXPECT_LT(work.triangles_tested, avatar.triangles.size() / 5);
  for (std::uint32_t i = 0; i < 12; ++i) {
    ASSERT_TRUE(row[i].hit());
    EXPECT_EQ(row[i].t, 0.5F);
    EXPECT_EQ(row[i].side, 1);
    // The place stands for the middle of its cell, which is up to a twelfth away.
    EXPECT_NEAR(row[i].texture_coordinate.x, segments[i].start.x, 0.1);
    EXPECT_EQ(row[i].actuator, map.at(row[i].triangle, row[i].texture_coordinate));
  }
}

TEST(DecimatedDetector, KnowsTheSkinAtEveryPlaceOfATrianglesEdges) {
  const Avatar avatar = test::rigid_avatar({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}});
  const ActuatorMap map = quarters();
  const auto detector = make_decimated_detector(1, avatar, map, with(Method::kStatic));
  std::vector<Segment> segments;
  for (std::uint32_t i = 0; i <= 16; ++i) {
    const float x = static_cast<float>(i) / 16;
    segments.push_back({3 * i, {x, 0, 1}, {x, 0, -1}});
    segments.push_back({3 * i + 1, {x, 1 - x, 1}, {x, 1 - x, -1}});
    segments.push_back({3 * i + 2, {0, x, 1}, {0, x, -1}});
  }
  ContactRow row;
  detector->detect(test::frame_of(avatar, segments), row);
  for (const Segment& segment : segments) {
    EXPECT_EQ(row[segment.column].triangle, 0U) << segment.start.x << ' ' << segment.start.y;
    EXPECT_GT(row[segment.column].actuator, 0) << segment.start.x << ' ' << segment.start.y;
  }
}

TEST(DecimatedDetector, ThatKeepsEveryTriangleFindsTheExactContacts) {
  const auto scene = test::scene("swarm", builtin_avatar(), 50, 60, 30);
  const auto exact = make_cpu_detector(builtin_avatar(), builtin_map(), with(Method::kCcd));
  const auto decimated = make_decimated_detector(1, builtin_avatar(), builtin_map(), with(Method::kCcd));
  const test::SceneRun truth = test::run_scene(scene, builtin_avatar(), 50, *exact);
  const test::SceneRun run = test::run_scene(scene, builtin_avatar(), 50, *decimated);
  std::size_t contacts = 0;
  std::size_t same_actuator = 0;
  for (std::size_t k = 0; k < scene.size(); ++k)
    for (std::size_t i = 0; i < 50; ++i) {
      EXPECT_EQ(run.rows[k][i].t, truth.rows[k][i].t);
      EXPECT_EQ(run.rows[k][i].hit(), truth.rows[k][i].hit());
      if (!truth.rows[k][i].hit()) continue;
      ++contacts;
      if (run.rows[k][i].actuator == truth.rows[k][i].actuator) ++same_actuator;
    }
  EXPECT_GT(contacts, 20U);
  EXPECT_GE(same_actuator, contacts * 9 / 10);
}

}  // namespace
}  // namespace vestige
