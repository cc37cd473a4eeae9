// Segments out of the skin's reach are left out, and no bit of the result changes.

#include <gtest/gtest.h>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "detector/detectors/make_detectors.hpp"
#include "tests/support/builtin_avatar.hpp"
#include "tests/support/builtin_map.hpp"
#include "tests/support/pairs/same_contact.hpp"
#include "tests/support/scene_run.hpp"

namespace vestige {
namespace {

constexpr std::uint32_t kReachColliders = 60;

class Reach : public ::testing::TestWithParam<Method> {};

INSTANTIATE_TEST_SUITE_P(Each, Reach, ::testing::Values(Method::kStatic, Method::kCarried, Method::kCcd),
                         [](const auto& test) { return name_of(test.param); });

/// A scene whose colliders go from within the body to several metres away; every third is a sphere.
std::vector<TraceFrame> spread_scene(const char* scenario) {
  std::vector<TraceFrame> frames = test::scene(scenario, test::builtin_avatar(), kReachColliders, 40, 30);
  for (TraceFrame& frame : frames)
    for (ColliderSample& collider : frame.colliders) {
      const double factor = 0.5 + 0.2 * static_cast<double>((collider.id * 7 + frame.index) % 40);
      collider.position_m = glm::dvec3(0, 1, 0) + (collider.position_m - glm::dvec3(0, 1, 0)) * factor;
      if (collider.id % 3 == 0) collider.radius_m = 0.3F;
    }
  return frames;
}

TEST_P(Reach, LeavingSegmentsOutChangesNoContact) {
  const auto detector = make_cpu_detector(test::builtin_avatar(), test::builtin_map(),
                                          {.planes = PlaneSet::all(), .method = GetParam(), .skip = Skip::kOn});
  EXPECT_EQ(detector->skip(), Skip::kOn);
  std::vector<std::uint32_t> ids(kReachColliders);
  for (std::uint32_t id = 0; id < kReachColliders; ++id) ids[id] = id;
  std::size_t left_out = 0;
  std::size_t contacts = 0;
  ContactRow row;
  ContactRow expected;
  for (const char* scenario : {"swarm", "hug", "still"}) {
    FrameBuilder all(test::builtin_avatar(), ids, GetParam());
    FrameBuilder near(test::builtin_avatar(), ids, GetParam(), 0, Skip::kOn);
    for (const TraceFrame& trace_frame : spread_scene(scenario)) {
      detector->detect(all.next(trace_frame), expected);
      const DetectorFrame& frame = near.next(trace_frame);
      const DetectorWork work = detector->detect(frame, row);
      left_out += frame.out_of_reach;
      if (frame.segments.empty()) {
        EXPECT_EQ(work.frames_skipped, frame.out_of_reach > 0 ? 1U : 0U);
      }
      for (std::size_t i = 0; i < row.size(); ++i) {
        contacts += expected[i].hit() ? 1U : 0U;
        EXPECT_TRUE(test::same(row[i], expected[i])) << scenario << ", frame " << frame.index << ", column " << i;
      }
    }
  }
  EXPECT_GT(left_out, 500U);
  EXPECT_GT(contacts, 500U);
}

/// What flies past a fingertip or a sole by less than a millimetre is in reach, however the body stands.
TEST_P(Reach, HoldsEveryVertexOfTheSkin) {
  const Avatar& avatar = test::builtin_avatar();
  std::vector<glm::vec3> skin;
  for (const char* scenario : {"hug", "still"}) {
    std::vector<TraceFrame> frames = test::scene(scenario, avatar, 1, 30, 15);
    std::vector<std::uint32_t> ids(avatar.position_bind.size());
    for (std::uint32_t id = 0; id < ids.size(); ++id) ids[id] = id;
    FrameBuilder builder(avatar, ids, GetParam(), 0, Skip::kOn);
    FrameBuilder poses(avatar, {}, GetParam());
    for (TraceFrame& trace_frame : frames) {
      trace_frame.colliders.clear();
      const DetectorFrame& pose = poses.next(trace_frame);
      skin_vertices(avatar, pose.palette, skin);
      for (const std::uint32_t id : ids)
        trace_frame.colliders.push_back({.id = id, .position_m = pose.origin_m + glm::dvec3(skin[id]) * 1.0005});
      const DetectorFrame& frame = builder.next(trace_frame);
      EXPECT_EQ(frame.out_of_reach, 0U) << scenario << ", frame " << frame.index;
    }
  }
}

}  // namespace
}  // namespace vestige
