// Skipping changes the work, and no bit of the result.

#include <gtest/gtest.h>

#include <ostream>
#include <string>

#include "detector/detector.hpp"
#include "detector/detectors/make_detectors.hpp"
#include "tests/support/builtin_avatar.hpp"
#include "tests/support/builtin_map.hpp"
#include "tests/support/scenario_names.hpp"
#include "tests/support/scene_run.hpp"
#include "tests/support/simd_targets.hpp"
#include "tests/support/small_avatar.hpp"
#include "tests/support/test_data.hpp"
#include "traces/gltf/avatar_gltf.hpp"

namespace vestige {
namespace {

using test::builtin_avatar;
using test::builtin_map;

test::SceneRun run(const std::vector<TraceFrame>& scene, const Avatar& avatar, std::uint32_t colliders,
                   const DetectorOptions& options) {
  return test::run_scene(scene, avatar, colliders, *make_cpu_detector(avatar, builtin_map(), options));
}

using Question = std::tuple<std::string_view, Method>;

class SkippingOnTheCpu : public ::testing::TestWithParam<Question> {
 protected:
  /// Of `frames` frames around `avatar`; returns how many contacts there were.
  static std::size_t expect_same_bits(const Avatar& avatar, int frames, double rate_hz, const glm::dvec3& origin_m) {
    const auto [scenario, method] = GetParam();
    const std::uint32_t colliders = find_scenario(scenario)->default_count;
    const auto scene = test::scene(scenario, avatar, colliders, frames, rate_hz, origin_m);
    const DetectorOptions off = {Surface::kAll, kHashedPlanes, method, Skip::kOff};
    const DetectorOptions on = {Surface::kAll, kHashedPlanes, method, Skip::kOn};
    const test::SceneRun expected = run(scene, avatar, colliders, off);
    EXPECT_EQ(hash_of(run(scene, avatar, colliders, on)), hash_of(expected));
    return expected.contacts();
  }
};

TEST_P(SkippingOnTheCpu, ChangesNoBitNearOrFarQuickOrSlow) {
  const auto [scenario, method] = GetParam();
  const std::size_t contacts = expect_same_bits(builtin_avatar(), 30, 5, glm::dvec3(0)) +
                               expect_same_bits(builtin_avatar(), 30, 1000, glm::dvec3(0)) +
                               expect_same_bits(builtin_avatar(), 10, 20, {1e7, -3e6, 0.25});
  EXPECT_EQ(contacts > 0, scenario != "still" || method != Method::kStatic);
}

TEST_P(SkippingOnTheCpu, ChangesNoBitWithAvatarsFromElsewhere) {
  for (const char* name : {"CesiumMan.glb", "KayKit_Knight.glb", "MakeHumanBase_cc0_8inf.glb"}) {
    const auto path = test::data("avatars/avatars") / name;
    VESTIGE_REQUIRE_DATA(path);
    SCOPED_TRACE(name);
    expect_same_bits(parse_avatar_glb(read_avatar_glb(path), name), 8, 10, glm::dvec3(0));
  }
}

INSTANTIATE_TEST_SUITE_P(Each, SkippingOnTheCpu,
                         ::testing::Combine(::testing::ValuesIn(test::scenario_names()),
                                            ::testing::Values(Method::kStatic, Method::kCarried, Method::kCcd)),
                         [](const auto& test) {
                           return std::string(std::get<0>(test.param)) + "_" + name_of(std::get<1>(test.param));
                         });

TEST(Skipping, ChangesNoBitOfAMappedSurfaceOnAnyInstructionSet) {
  const auto scene = test::scene("hug", builtin_avatar(), 60, 20, 20);
  for (const Method method : {Method::kStatic, Method::kCarried, Method::kCcd}) {
    DetectorOptions options = {Surface::kMapped, kHashedPlanes, method, Skip::kOff};
    const test::SceneRun expected = run(scene, builtin_avatar(), 60, options);
    EXPECT_GT(expected.contacts(), 10U);
    options.skip = Skip::kOn;
    test::on_every_simd_target([&](const char* target) {
      EXPECT_EQ(hash_of(run(scene, builtin_avatar(), 60, options)), hash_of(expected)) << target;
    });
  }
}

TEST(Skipping, CountsWhatItLeavesOut) {
  const Avatar avatar = test::rigid_avatar({{-1, -1, 0}, {1, -1, 0}, {0, 1, 0}, {99, -1, 0}, {101, -1, 0}, {100, 1, 0}},
                                           {{0, 1, 2}, {3, 4, 5}});
  const ActuatorMap map;
  const auto cpu = make_cpu_detector(avatar, map, {Surface::kAll, kHashedPlanes, Method::kStatic, Skip::kOn});
  ContactRow row;

  const DetectorWork nothing = cpu->detect(test::frame_of(avatar, {}), row);
  EXPECT_EQ(nothing.frames_skipped, 0U);
  EXPECT_EQ(nothing.pairs_tested, 0U);

  const DetectorWork far = cpu->detect(test::frame_of(avatar, {{0, {0, 0, 5}, {0, 0, 4}}}), row);
  EXPECT_EQ(far.frames_skipped, 1U);
  EXPECT_EQ(far.meshlets_skinned, 0U);
  EXPECT_EQ(far.triangles_tested, 0U);
  EXPECT_EQ(far.pairs_tested, 0U);

  const DetectorWork close =
      cpu->detect(test::frame_of(avatar, {{0, {0, 0, 5}, {0, 0, 4}}, {1, {0, 0, 1}, {0, 0, -1}}}), row);
  EXPECT_EQ(close.frames_skipped, 0U);
  EXPECT_EQ(close.meshlets_skinned, 1U);
  EXPECT_EQ(close.triangles_tested, 2U);
  EXPECT_EQ(close.pairs_tested, 2U);
  EXPECT_EQ(close.pairs_meeting, 1U);
  EXPECT_FALSE(row[0].hit());
  EXPECT_EQ(row[1].triangle, 0U);
}

TEST(Skipping, SkinsFewMeshletsAndFindsAsManyPairs) {
  const auto scene = test::scene("swarm", builtin_avatar(), 40, 20, 1000);
  DetectorWork all;
  DetectorWork some;
  for (const Skip skip : {Skip::kOff, Skip::kOn}) {
    const auto cpu =
        make_cpu_detector(builtin_avatar(), builtin_map(), {Surface::kAll, kHashedPlanes, Method::kStatic, skip});
    DetectorWork& sum = skip == Skip::kOn ? some : all;
    FrameBuilder builder = test::frame_builder(builtin_avatar(), 40, Method::kStatic);
    ContactRow row;
    for (const TraceFrame& frame : scene) sum += cpu->detect(builder.next(frame), row);
  }
  EXPECT_EQ(all.meshlets_skinned, 0U);
  EXPECT_GT(some.meshlets_skinned, 0U);
  EXPECT_EQ(some.pairs_meeting, all.pairs_meeting);
  EXPECT_LT(some.pairs_tested, all.pairs_tested / 20);
}

}  // namespace
}  // namespace vestige
