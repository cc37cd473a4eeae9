// Spheres: which contacts the detectors find, and what they say of them.

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <string>
#include <tuple>
#include <vector>

#include "analysis/stress/loose_triangles.hpp"
#include "detector/detector.hpp"
#include "detector/detectors/make_detectors.hpp"
#include "tests/support/builtin_avatar.hpp"
#include "tests/support/builtin_map.hpp"
#include "tests/support/pairs/same_contact.hpp"
#include "tests/support/scene_run.hpp"

namespace vestige {
namespace {

using test::builtin_avatar;
using test::builtin_map;
using test::same;

std::vector<TraceFrame> scene_of_spheres(std::string_view scenario, std::uint32_t colliders, int frames,
                                         float radius_m) {
  std::vector<TraceFrame> scene = test::scene(scenario, builtin_avatar(), colliders, frames, 15);
  for (TraceFrame& frame : scene)
    for (ColliderSample& collider : frame.colliders) collider.radius_m = radius_m * static_cast<float>(1 + collider.id);
  return scene;
}

class SphereContacts : public ::testing::TestWithParam<std::tuple<Method, Surface>> {
 protected:
  DetectorOptions options(Skip skip) const {
    return {std::get<Surface>(GetParam()), PlaneSet::all(), std::get<Method>(GetParam()), skip};
  }
};

INSTANTIATE_TEST_SUITE_P(Each, SphereContacts,
                         ::testing::Combine(::testing::Values(Method::kStatic, Method::kCarried, Method::kCcd),
                                            ::testing::Values(Surface::kAll, Surface::kMapped)),
                         [](const auto& test) {
                           return std::string(name_of(std::get<0>(test.param))) +
                                  (std::get<1>(test.param) == Surface::kMapped ? "_mapped" : "");
                         });

TEST_P(SphereContacts, AreThoseOfTheExactDetectorToTheBit) {
  const auto exact = make_exact_detector(builtin_avatar(), builtin_map(), options(Skip::kOff));
  const auto cpu = make_cpu_detector(builtin_avatar(), builtin_map(), options(Skip::kOff));
  const auto skipping = make_cpu_detector(builtin_avatar(), builtin_map(), options(Skip::kOn));
  for (const char* scenario : {"swarm", "slide", "hug"}) {
    const std::uint32_t colliders = scenario == std::string("slide") ? 1 : 4;
    FrameBuilder builder = test::frame_builder(builtin_avatar(), colliders, exact->method());
    int contacts = 0;
    for (const TraceFrame& trace_frame : scene_of_spheres(scenario, colliders, 8, 0.02F)) {
      const DetectorFrame& frame = builder.next(trace_frame);
      ContactRow expected;
      ContactRow row;
      ContactRow skipped;
      exact->detect(frame, expected);
      const DetectorWork all = cpu->detect(frame, row);
      const DetectorWork some = skipping->detect(frame, skipped);
      EXPECT_EQ(some.pairs_meeting, all.pairs_meeting) << scenario << ", frame " << frame.index;
      for (std::size_t i = 0; i < expected.size(); ++i) {
        ASSERT_TRUE(same(row[i], expected[i])) << scenario << ", frame " << frame.index << ", column " << i;
        ASSERT_TRUE(same(skipped[i], expected[i])) << scenario << ", frame " << frame.index << ", column " << i;
        contacts += expected[i].hit() ? 1 : 0;
      }
    }
    if (scenario == std::string("hug")) {
      EXPECT_GT(contacts, 5);
    }
  }
}

TEST_P(SphereContacts, AreNoneWhereTheSphereIsWhollyInsideTheBody) {
  std::vector<TraceFrame> scene = test::scene("swarm", builtin_avatar(), 1, 3, 15);
  for (const float radius_m : {0.01F, 0.3F}) {
    for (TraceFrame& frame : scene) frame.colliders = {{0, {0, 1.2, 0}, radius_m}};
    for (const Skip skip : {Skip::kOff, Skip::kOn}) {
      std::vector<std::unique_ptr<Detector>> detectors;
      detectors.push_back(make_cpu_detector(builtin_avatar(), builtin_map(), options(skip)));
      detectors.push_back(make_exact_detector(builtin_avatar(), builtin_map(), options(skip)));
      for (const auto& detector : detectors) {
        FrameBuilder builder = test::frame_builder(builtin_avatar(), 1, detector->method());
        ContactRow row;
        for (const TraceFrame& frame : scene) detector->detect(builder.next(frame), row);
        EXPECT_EQ(row[0].hit(), radius_m > 0.1F) << detector->name();
      }
    }
  }
}

TEST_P(SphereContacts, LastAsLongAsTheTouch) {
  const auto cpu = make_cpu_detector(builtin_avatar(), builtin_map(), options(Skip::kOn));
  FrameBuilder builder = test::frame_builder(builtin_avatar(), 1, cpu->method());
  ContactRow row;
  for (const TraceFrame& trace_frame : scene_of_spheres("slide", 1, 30, 0.05F)) {
    const DetectorFrame& frame = builder.next(trace_frame);
    cpu->detect(frame, row);
    EXPECT_EQ(row[0].hit(), frame.index > 0) << frame.index;
    if (frame.index > 0) {
      EXPECT_EQ(row[0].t, 0) << "it touches already at the start";
    }
  }
}

/// Two floors, of which the second is nearer to what comes from above, and a wall at their edge.
struct Floors {
  std::vector<LooseTriangle> triangles = {{{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}}},
                                          {{{0, 0, 0.25F}, {4, 0, 0.25F}, {0, 4, 0.25F}}},
                                          {{{0, 0, 0.25F}, {0, 4, 0.25F}, {0, 0, 9}}}};
  Avatar avatar = loose_triangles(triangles.size());
  ActuatorMap map;

  Contact contact(const glm::vec3& start, const glm::vec3& end, float radius_m, const char* detector = "cpu") const {
    const DetectorOptions options = {Surface::kAll, PlaneSet::all(), Method::kCcd, Skip::kOff};
    const auto made = detector == std::string("cpu") ? make_cpu_detector(avatar, map, options)
                                                     : make_exact_detector(avatar, map, options);
    ContactRow row;
    made->detect(loose_frame(triangles, triangles, {{0, start, end, radius_m}}), row);
    return row[0];
  }
};

TEST(SphereContact, IsWithTheNearestTriangleAtTheStart) {
  const Floors floors;
  const Contact resting = floors.contact({1, 1, 0.75F}, {1, 1, 0.75F}, 1);
  EXPECT_EQ(resting.triangle, 1U);
  EXPECT_EQ(resting.side, 1);
  EXPECT_EQ(resting.position, glm::dvec3(1, 1, 0.25));
  EXPECT_EQ(resting.barycentric, glm::dvec2(0.25, 0.25));
  EXPECT_EQ(resting.speed_m_per_s, 0);
  EXPECT_EQ(floors.contact({1, 1, 0.0625F}, {1, 1, 0.0625F}, 1).triangle, 0U) << "from below, the other is nearer";
  EXPECT_EQ(floors.contact({1, 1, 0.125F}, {1, 1, 0.125F}, 1).triangle, 0U) << "of two equally near, the first";
  EXPECT_EQ(floors.contact({0.25F, 1, 0.5F}, {1, 1, 0.5F}, 1).triangle, 1U) << "a floor and a wall, equally near";
  EXPECT_EQ(floors.contact({0.25F, 1, 0.75F}, {1, 1, 0.5F}, 1).triangle, 2U) << "the wall is nearer";
}

TEST(SphereContact, IsWithTheFirstTriangleThatItMeets) {
  const Floors floors;
  const Contact falling = floors.contact({1.5F, 1, 2.25F}, {1.5F, 1, 0.25F}, 1);
  EXPECT_EQ(falling.triangle, 1U);
  EXPECT_EQ(falling.t, 0.5F);
  EXPECT_EQ(falling.side, 1);
  EXPECT_DOUBLE_EQ(falling.speed_m_per_s, 2 / 0.01) << "the whole way in a frame of 10 ms";
  const Contact oblique = floors.contact({2.5F, 1, 2.25F}, {1.5F, 1, 0.25F}, 1);
  EXPECT_DOUBLE_EQ(oblique.speed_m_per_s, 2 / 0.01) << "only what is along the line to the centre";
  EXPECT_FALSE(floors.contact({1.5F, 1, 3}, {1.5F, 1, 1.5F}, 1).hit());
}

TEST(SphereContact, OfAPointIsThatOfTheSegment) {
  const Floors floors;
  for (const char* detector : {"cpu", "exact"}) {
    const Contact point = floors.contact({1, 1, 1.25F}, {1, 1, -0.75F}, 0, detector);
    EXPECT_EQ(point.triangle, 1U) << detector;
    EXPECT_EQ(point.t, 0.5F) << detector;
  }
}

}  // namespace
}  // namespace vestige
