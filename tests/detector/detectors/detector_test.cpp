#include "detector/detector.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <memory>

#include "analysis/run/comparison.hpp"
#include "analysis/run/skinning_error.hpp"
#include "detector/detectors/make_detectors.hpp"
#include "detector/gl/gl_context.hpp"
#include "tests/support/builtin_avatar.hpp"
#include "tests/support/builtin_map.hpp"
#include "tests/support/gl/gl_context.hpp"
#include "tests/support/small_avatar.hpp"
#include "tests/support/test_data.hpp"
#include "traces/gltf/avatar_gltf.hpp"
#include "traces/scenarios/scenarios.hpp"
#include "traces/scene/colliders.hpp"

namespace vestige {
namespace {

using test::builtin_avatar;
using test::builtin_map;

/// A map of 2 x 1 texels: nothing left of u = 0.5, actuator 1 right of it.
ActuatorMap half_map() {
  ActuatorMap map;
  map.width = 2;
  map.actuator = {0, 1};
  map.actuator_count = 1;
  map.names = {"right half"};
  return map;
}

/// Every detector that there is, in every kind of context: what holds for one must hold for all.
struct Kind {
  const char* name;
  std::unique_ptr<Detector> (*make)(const Avatar&, const ActuatorMap&, const DetectorOptions&);
};

std::unique_ptr<Detector> paper(const Avatar& avatar, const ActuatorMap& map, const DetectorOptions& options) {
  return make_paper_detector(test::make_context(), avatar, map, options);
}
std::unique_ptr<Detector> paper_as_on_gpu(const Avatar& avatar, const ActuatorMap& map,
                                          const DetectorOptions& options) {
  DetectorOptions as_on_gpu = options;
  as_on_gpu.as_on_gpu = true;
  return make_paper_detector(test::make_context(), avatar, map, as_on_gpu);
}
// own context: a device is made another way
std::unique_ptr<Detector> paper_on_egl_device(const Avatar& avatar, const ActuatorMap& map,
                                              const DetectorOptions& options) {
  return make_paper_detector(make_egl_device_context(0), avatar, map, options);
}
// own context: OSMesa is another library, with its own way of being current
std::unique_ptr<Detector> paper_on_osmesa(const Avatar& avatar, const ActuatorMap& map,
                                          const DetectorOptions& options) {
  return make_paper_detector(make_osmesa_context(), avatar, map, options);
}

std::unique_ptr<Detector> geometry(const Avatar& avatar, const ActuatorMap& map, const DetectorOptions& options) {
  return make_geometry_detector(test::make_context(), avatar, map, options);
}
// own context: as above
std::unique_ptr<Detector> geometry_on_osmesa(const Avatar& avatar, const ActuatorMap& map,
                                             const DetectorOptions& options) {
  return make_geometry_detector(make_osmesa_context(), avatar, map, options);
}

class DetectorTest : public ::testing::TestWithParam<Kind> {
 protected:
  static DetectorOptions options(Surface surface = Surface::kAll) { return {surface, PlaneSet::all()}; }
};

INSTANTIATE_TEST_SUITE_P(Each, DetectorTest,
                         ::testing::Values(Kind{"cpu", make_cpu_detector}, Kind{"paper", paper},
                                           Kind{"paper_as_on_gpu", paper_as_on_gpu},
                                           Kind{"paper_egl_device", paper_on_egl_device},
                                           Kind{"paper_osmesa", paper_on_osmesa}, Kind{"geometry", geometry},
                                           Kind{"geometry_osmesa", geometry_on_osmesa}),
                         [](const auto& test) { return test.param.name; });

const std::vector<glm::vec3> kUnitTriangle = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};

TEST_P(DetectorTest, DescribesAContactCompletely) {
  const Avatar avatar = test::rigid_avatar(kUnitTriangle, {{0, 1, 2}});
  const ActuatorMap map = half_map();
  const auto detector = GetParam().make(avatar, map, options());
  ContactRow row;
  detector->detect(test::frame_of(avatar, {{0, {0.625F, 0.25F, 1}, {0.625F, 0.25F, -3}}}), row);
  ASSERT_EQ(row.size(), 1U);
  EXPECT_EQ(row[0].triangle, 0U);
  EXPECT_EQ(row[0].t, 0.25F);
  EXPECT_EQ(row[0].actuator, 1);
  EXPECT_EQ(row[0].side, 1);
  EXPECT_EQ(row[0].barycentric, glm::dvec2(0.625, 0.25));
  EXPECT_EQ(row[0].texture_coordinate, glm::dvec2(0.625, 0.25));
  EXPECT_EQ(row[0].position, glm::dvec3(0.625, 0.25, 0));
  EXPECT_NEAR(row[0].speed_m_per_s, 400, 1e-3);
}

TEST_P(DetectorTest, KeepsTheEarliestContactAndAmongEqualsTheSmallestTriangle) {
  std::vector<glm::vec3> vertices;
  std::vector<glm::uvec3> triangles;
  for (const float z : {0.25F, 0.75F, 0.5F, 0.75F})
    for (const glm::vec3& vertex : kUnitTriangle) vertices.emplace_back(vertex.x, vertex.y, z);
  for (std::uint32_t i = 0; i < 4; ++i) triangles.emplace_back(3 * i, 3 * i + 1, 3 * i + 2);
  const Avatar avatar = test::rigid_avatar(vertices, triangles);
  const ActuatorMap map = half_map();
  const auto detector = GetParam().make(avatar, map, options());
  ContactRow row;
  detector->detect(
      test::frame_of(avatar, {{0, {0.25F, 0.25F, 1}, {0.25F, 0.25F, 0}}, {1, {0.25F, 0.25F, 0}, {0.25F, 0.25F, 1}}}),
      row);
  EXPECT_EQ(row[0].triangle, 1U);
  EXPECT_EQ(row[0].t, 0.25F);
  EXPECT_EQ(row[1].triangle, 0U);
  EXPECT_EQ(row[1].side, -1);
}

TEST_P(DetectorTest, FindsContactsAtBothEndsOfTheSegment) {
  const Avatar avatar = test::rigid_avatar(kUnitTriangle, {{0, 1, 2}});
  const ActuatorMap map = half_map();
  const auto detector = GetParam().make(avatar, map, options());
  ContactRow row;
  detector->detect(test::frame_of(avatar, {{0, {0.25F, 0.25F, 1}, {0.25F, 0.25F, 0}},
                                           {1, {0.25F, 0.25F, 0}, {0.25F, 0.25F, 1}},
                                           {2, {0.25F, 0.25F, 1}, {0.25F, 0.25F, 0.001F}}}),
                   row);
  EXPECT_EQ(row[0].t, 1.0F);
  EXPECT_EQ(row[1].t, 0.0F);
  EXPECT_FALSE(std::signbit(row[1].t));
  EXPECT_FALSE(row[2].hit());
  EXPECT_TRUE(std::isinf(row[2].t));
}

TEST_P(DetectorTest, DropsNoContactWhenAThousandCollidersHitOneTriangle) {
  const Avatar avatar = test::rigid_avatar(kUnitTriangle, {{0, 1, 2}});
  const ActuatorMap map = half_map();
  const auto detector = GetParam().make(avatar, map, options());
  std::vector<Segment> segments;
  for (std::uint32_t i = 0; i < 1000; ++i) {
    const float x = 0.9F * static_cast<float>(i) / 1000;
    segments.push_back({i, {x, 0.05F, 1}, {x, 0.05F, -1}});
  }
  ContactRow row;
  detector->detect(test::frame_of(avatar, segments), row);
  for (std::uint32_t i = 0; i < 1000; ++i) {
    ASSERT_TRUE(row[i].hit()) << i;
    EXPECT_EQ(row[i].actuator, segments[i].start.x >= 0.5F ? 1 : 0) << i;
  }
}

TEST_P(DetectorTest, HasRoomForMoreCollidersThanATextureIsWide) {
  const Avatar avatar = test::rigid_avatar(kUnitTriangle, {{0, 1, 2}});
  const ActuatorMap map = half_map();
  const auto detector = GetParam().make(avatar, map, options());
  constexpr std::uint32_t kCount = 20000;
  std::vector<Segment> segments;
  for (std::uint32_t i = 0; i < kCount; ++i) {
    const float z = i % 3 == 0 ? 1.0F : -1.0F;
    segments.push_back({i, {0.25F, 0.25F, 1}, {0.25F, 0.25F, z * 0.5F}});
  }
  ContactRow row;
  detector->detect(test::frame_of(avatar, segments), row);
  for (std::uint32_t i = 0; i < kCount; ++i) ASSERT_EQ(row[i].hit(), i % 3 != 0) << i;
}

TEST_P(DetectorTest, PassesThroughUnmappedSkinOnlyWhenAsked) {
  std::vector<glm::vec3> vertices;
  for (const float z : {0.75F, 0.5F})
    for (const glm::vec3& vertex : kUnitTriangle) vertices.emplace_back(vertex.x, vertex.y, z);
  Avatar avatar = test::rigid_avatar(vertices, {{0, 1, 2}, {3, 4, 5}});
  for (std::size_t i = 3; i < 6; ++i) avatar.texture_coordinate[i] = {0.75F, 0.5F};
  for (std::size_t i = 0; i < 3; ++i) avatar.texture_coordinate[i] = {0.25F, 0.5F};
  const ActuatorMap map = half_map();
  const DetectorFrame frame = test::frame_of(avatar, {{0, {0.25F, 0.25F, 1}, {0.25F, 0.25F, 0}}});
  ContactRow row;
  GetParam().make(avatar, map, options(Surface::kAll))->detect(frame, row);
  EXPECT_EQ(row[0].triangle, 0U);
  EXPECT_EQ(row[0].actuator, 0);
  GetParam().make(avatar, map, options(Surface::kMapped))->detect(frame, row);
  EXPECT_EQ(row[0].triangle, 1U);
  EXPECT_EQ(row[0].actuator, 1);
}

TEST_P(DetectorTest, GivesTheSameActuatorsWhateverPlanesAreAskedFor) {
  const Avatar avatar = test::rigid_avatar(kUnitTriangle, {{0, 1, 2}});
  const ActuatorMap map = half_map();
  const DetectorFrame frame =
      test::frame_of(avatar, {{0, {0.75F, 0.125F, 1}, {0.75F, 0.125F, -1}}, {2, {2, 2, 1}, {2, 2, -1}}});
  ContactRow row;
  GetParam().make(avatar, map, {Surface::kAll, PlaneSet()})->detect(frame, row);
  ASSERT_EQ(row.size(), 3U);
  EXPECT_TRUE(row[0].hit());
  EXPECT_EQ(row[0].actuator, 1);
  EXPECT_FALSE(row[1].hit());
  EXPECT_FALSE(row[2].hit());
}

TEST_P(DetectorTest, AnswersAFrameWithoutSegments) {
  const Avatar avatar = test::rigid_avatar(kUnitTriangle, {{0, 1, 2}});
  const ActuatorMap map = half_map();
  const auto detector = GetParam().make(avatar, map, options());
  ContactRow row;
  DetectorFrame frame = test::frame_of(avatar, {});
  detector->detect(frame, row);
  EXPECT_TRUE(row.empty());
  frame.columns = 5;
  detector->detect(frame, row);
  EXPECT_EQ(row.size(), 5U);
  EXPECT_FALSE(row[4].hit());
}

/// Runs `frames` frames of a swarm over an avatar and hands each to `visit`.
template <typename Visit>
void swarm_over(const Avatar& avatar, std::uint32_t colliders, int frames, double rate_hz, Visit visit) {
  const Animation* animation = avatar.animations.empty() ? nullptr : &avatar.animations.front();
  const auto swarm = find_scenario("swarm")->make(avatar, animation, {colliders, 1});
  std::vector<std::uint32_t> ids;
  for (std::uint32_t i = 0; i < colliders; ++i) ids.push_back(i);
  FrameBuilder builder(avatar, ids);
  TraceFrame trace_frame;
  for (int k = 0; k < frames; ++k) {
    trace_frame.index = static_cast<std::uint64_t>(k);
    trace_frame.time_ns = std::llround(k / rate_hz * 1e9);
    trace_frame.poses.front() = looped_pose(avatar, animation, k / rate_hz);
    swarm->sample(k / rate_hz, trace_frame.colliders);
    visit(trace_frame, builder.next(trace_frame));
  }
}

TEST_P(DetectorTest, SkinsWithinAMillionthOfTheAvatarsHeight) {
  std::vector<std::pair<std::string, Avatar>> avatars = {{"builtin", builtin_avatar()}};
  for (const char* folder : {"avatars/avatars", "avatars/skin"}) {
    VESTIGE_REQUIRE_DATA(test::data(folder));
    for (const auto& entry : std::filesystem::recursive_directory_iterator(test::data(folder)))
      if (entry.path().extension() == ".glb" || entry.path().extension() == ".gltf")
        avatars.emplace_back(entry.path().string(),
                             parse_avatar_glb(read_avatar_glb(entry.path()), entry.path().string()));
  }
  EXPECT_GT(avatars.size(), 15U);
  for (const auto& named : avatars) {
    const std::string& name = named.first;
    const Avatar& avatar = named.second;
    const auto detector = GetParam().make(avatar, builtin_map(), options());
    SkinningError error;
    swarm_over(avatar, 1, 5, 3, [&](const TraceFrame& trace_frame, const DetectorFrame& frame) {
      error.add(avatar, trace_frame.poses.front(), frame, *detector);
    });
    EXPECT_EQ(error.vertices, 5 * avatar.position_bind.size());
    EXPECT_LT(error.largest_m, 1e-6 * error.height_m) << name;
    EXPECT_GT(error.height_m, 0) << name;
  }
}

/// What a user would notice: the same contacts as in double precision, on the built-in avatar and a real one. The full
/// comparison, 2000 frames, is `vestige replay --detector paper --verify cpu`.
TEST_P(DetectorTest, FindsTheContactsThatTheCpuFinds) {
  std::vector<Avatar> avatars = {builtin_avatar()};
  const auto path = test::data("avatars/avatars/CesiumMan.glb");
  VESTIGE_REQUIRE_DATA(path);
  avatars.push_back(parse_avatar_glb(read_avatar_glb(path), "CesiumMan.glb"));
  for (const Avatar& avatar : avatars) {
    const auto detector = GetParam().make(avatar, builtin_map(), options());
    const auto cpu = make_cpu_detector(avatar, builtin_map(), options());
    Comparison comparison;
    ContactRow row;
    ContactRow expected;
    swarm_over(avatar, 100, 60, 60, [&](const TraceFrame&, const DetectorFrame& frame) {
      detector->detect(frame, row);
      cpu->detect(frame, expected);
      comparison.add(row, expected);
    });
    EXPECT_GT(comparison.expected, 200U);
    EXPECT_EQ(comparison.differing(), 0U) << describe(comparison);
    EXPECT_LT(comparison.largest_t_difference, 1e-4);
  }
}

TEST(GlContext, ListsDevicesAndNamesWhatIsMissing) {
  const auto devices = list_egl_devices();
  EXPECT_FALSE(devices.empty());
  // own context: one that is not there
  EXPECT_THROW(make_egl_device_context(static_cast<int>(devices.size())), std::exception);
}

TEST(GlContext, SurvivesTwoContextsTakingTurnsOnOneThread) {
  const Avatar avatar = test::rigid_avatar(kUnitTriangle, {{0, 1, 2}});
  const ActuatorMap map = half_map();
  const auto one = paper(avatar, map, {});
  const auto osmesa = paper_on_osmesa(avatar, map, {});
  const DetectorFrame frame = test::frame_of(avatar, {{0, {0.75F, 0.125F, 1}, {0.75F, 0.125F, -1}}});
  ContactRow row;
  for (int i = 0; i < 20; ++i) {
    (i % 2 == 0 ? one : osmesa)->detect(frame, row);
    ASSERT_TRUE(row[0].hit()) << i;
  }
}

}  // namespace
}  // namespace vestige
