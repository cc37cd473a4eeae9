// `compute` where shaders find and skin what segments may meet: what it does when they cannot, and how well they prove.
#include <gtest/gtest.h>

#include <cstdint>
#include <glm/vec3.hpp>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "detector/detector.hpp"
#include "detector/detectors/make_detectors.hpp"
#include "detector/gl/gl_context.hpp"
#include "tests/support/builtin_avatar.hpp"
#include "tests/support/builtin_map.hpp"
#include "tests/support/gl/gl_context.hpp"
#include "tests/support/gl/limited_context.hpp"
#include "tests/support/pairs/pile.hpp"
#include "tests/support/pairs/same_contact.hpp"
#include "tests/support/scene_run.hpp"

namespace vestige {
namespace {

using test::builtin_avatar;
using test::builtin_map;

DetectorOptions culling_options(Method method) {
  return {.planes = PlaneSet::all(), .method = method, .skip = Skip::kOn, .culling = Culling::kGpu};
}

class CullingCompute : public ::testing::TestWithParam<Method> {};

INSTANTIATE_TEST_SUITE_P(Each, CullingCompute, ::testing::Values(Method::kStatic, Method::kCarried, Method::kCcd),
                         [](const auto& test) { return std::string(name_of(test.param)); });

/// 1600 segments at each of 40 patches need more slots than there are; 5000 segments are more than a group tests.
TEST_P(CullingCompute, LeavesFramesThatAreTooLargeToTheCpuAndTakesTheNextRunAgain) {
  const Avatar pile = test::pile_of(1280);
  const ActuatorMap map;
  const auto compute = make_compute_detector(test::LimitedContext::make({}), pile, map, culling_options(GetParam()));
  ContactRow row;
  const auto dispatches = [&](std::uint64_t index, std::uint32_t colliders) {
    DetectorFrame frame = test::frame_through(pile, colliders);
    frame.index = index;
    const int before = test::LimitedContext::dispatches();
    const DetectorWork work = compute->detect(frame, row);
    EXPECT_EQ(work.pairs_meeting, 1280U * colliders);
    EXPECT_EQ(row.size(), colliders);
    for (const Contact& contact : row) EXPECT_EQ(contact.triangle, 1279U);
    return test::LimitedContext::dispatches() - before;
  };
  const std::uint64_t run = compute->run_length();
  EXPECT_EQ(dispatches(run - 3, 20), 2);  // one that culls and skins, and one that proves
  EXPECT_EQ(dispatches(run - 2, 1600), 2);
  EXPECT_EQ(dispatches(run - 1, 20), 0);  // the rest of that run
  EXPECT_EQ(dispatches(run, 20), 2);
  EXPECT_EQ(dispatches(run + 1, 5000), 0);  // this one alone
  EXPECT_EQ(dispatches(run + 2, 20), 2);
  EXPECT_EQ(dispatches(run + 3, 1600), 2);
  EXPECT_EQ(dispatches(run + 3, 20), 2);  // another pass, through the same run
}

/// Two detectors, whose threads take turns in another order.
TEST_P(CullingCompute, DoesTheSameWorkInTheSameFrameAndProvesAlmostEveryMiss) {
  const auto scene = test::scene("hug", builtin_avatar(), 100, 100, 1000);
  DetectorWork work;
  for (int round = 0; round < 2; ++round) {
    const auto compute =
        make_compute_detector(test::make_context(), builtin_avatar(), builtin_map(), culling_options(GetParam()));
    FrameBuilder builder = test::frame_builder(builtin_avatar(), 100, GetParam());
    DetectorWork of_round;
    ContactRow row;
    for (const TraceFrame& frame : scene) of_round += compute->detect(builder.next(frame), row);
    if (round > 0) {
      EXPECT_EQ(of_round.pairs_tested, work.pairs_tested);
      EXPECT_EQ(of_round.meshlets_skinned, work.meshlets_skinned);
      EXPECT_EQ(of_round.pairs_captured, work.pairs_captured);
    }
    work = of_round;
  }
  EXPECT_GT(work.pairs_meeting, 50U);
  EXPECT_LE(work.pairs_captured - work.pairs_meeting, work.pairs_tested / 4000);
}

/// Ways along a triangle's edges and through its corners, which the driver skins up to 2 µm beside where they are. The
/// margins cover that: 2^-19 of how far the skin reaches is more.
TEST_P(CullingCompute, LosesNoGrazingPairOfASkinThatBends) {
  const auto cpu_options = DetectorOptions{.planes = PlaneSet::all(), .method = GetParam()};
  const auto cpu = make_cpu_detector(builtin_avatar(), builtin_map(), cpu_options);
  auto context = test::LimitedContext::make({});
  test::LimitedContext::misread_shaders("= position[axis];",
                                        "= position[axis] + (float((corner * 7u + axis) % 3u) - 1.0) * 2e-6;");
  const auto compute =
      make_compute_detector(std::move(context), builtin_avatar(), builtin_map(), culling_options(GetParam()));
  EXPECT_GT(test::LimitedContext::times_misread(), 0);
  FrameBuilder builder = test::frame_builder(builtin_avatar(), 1, GetParam());
  ContactRow row;
  ContactRow expected;
  std::uint64_t meeting = 0;
  for (const TraceFrame& trace_frame : test::scene("hug", builtin_avatar(), 1, 10, 10)) {
    DetectorFrame frame = builder.next(trace_frame);
    if (frame.palette_before.empty()) frame.palette_before = frame.palette;
    std::vector<glm::vec3> skin;
    cpu->skinned_vertices(frame, skin);
    frame.segments.clear();
    frame.columns = 300;
    for (std::uint32_t i = 0; i < 300; ++i) {
      const glm::uvec3& triangle = builtin_avatar().triangles[i * 16];
      const glm::vec3 place = i % 2 == 0 ? skin[triangle.x] : 0.5F * (skin[triangle.x] + skin[triangle.y]);
      const glm::vec3 way(0.02F, i % 3 == 0 ? 0.01F : 0, 0.01F);
      frame.segments.push_back({i, place - way, i % 5 == 0 ? place : place + way});
    }
    const DetectorWork work = compute->detect(frame, row);
    EXPECT_EQ(work.pairs_meeting, cpu->detect(frame, expected).pairs_meeting);
    for (std::size_t i = 0; i < row.size(); ++i) EXPECT_TRUE(test::same(row[i], expected[i])) << i;
    meeting += work.pairs_meeting;
  }
  EXPECT_GT(meeting, 1000U);
}

}  // namespace
}  // namespace vestige
