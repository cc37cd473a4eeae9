// What the scenarios bring about: contacts under the `cpu` detector in 2 s at 100 Hz, with as many colliders as each
// has by default. Whoever changes the built-in avatar, a scenario or what a contact is changes these numbers, and says
// why.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "detector/detector.hpp"
#include "detector/detectors/make_detectors.hpp"
#include "tests/support/builtin_avatar.hpp"
#include "tests/support/scenario_names.hpp"
#include "tests/support/skin_geometry.hpp"
#include "traces/scenarios/scenarios.hpp"
#include "traces/scene/colliders.hpp"

namespace vestige {
namespace {

using test::builtin_avatar;

struct Counts {
  std::string_view scenario;
  std::size_t box_person;
  std::size_t builtin;
};

constexpr Counts kCounts[] = {
    {"swarm", 385, 968}, {"rain", 1305, 1164}, {"orbit", 1040, 547}, {"punch", 466, 468}, {"slide", 100, 82},
    {"hug", 2026, 1789}, {"still", 0, 0},      {"rest", 148, 113},   {"brush", 123, 124},
};

struct Touch {
  int frame = 0;
  std::uint32_t collider = 0;
  glm::dvec3 place_m = glm::dvec3(0);
  int side = 0;
};

std::vector<Touch> touches_of(std::string_view name, const Avatar& avatar, const Animation* animation) {
  constexpr double kRate_hz = 100;
  constexpr int kFrames = 200;
  const Scenario& scenario = *find_scenario(name);
  const auto source = scenario.make(avatar, animation, {scenario.default_count, 1});
  ActuatorMap map;
  const auto detector = make_cpu_detector(avatar, map, {Surface::kAll, PlaneSet::all()});
  std::vector<std::uint32_t> ids(scenario.default_count);
  std::iota(ids.begin(), ids.end(), 0U);
  FrameBuilder builder(avatar, ids);
  std::vector<Touch> touches;
  TraceFrame trace_frame;
  ContactRow row;
  for (int k = 0; k < kFrames; ++k) {
    trace_frame.index = static_cast<std::uint64_t>(k);
    trace_frame.time_ns = std::llround(k / kRate_hz * 1e9);
    trace_frame.poses.front() = looped_pose(avatar, animation, k / kRate_hz);
    source->sample(k / kRate_hz, trace_frame.colliders);
    trace_frame.teleported = source->teleported();
    const DetectorFrame& frame = builder.next(trace_frame);
    detector->detect(frame, row);
    for (std::uint32_t column = 0; column < row.size(); ++column)
      if (row[column].hit()) touches.push_back({k, column, frame.origin_m + row[column].position, row[column].side});
  }
  return touches;
}

class ScenarioContacts : public ::testing::TestWithParam<std::string_view> {};

TEST_P(ScenarioContacts, AreAsManyAsEver) {
  Avatar box = test::box_person();
  test::add_sway(box);
  const std::size_t on_box = touches_of(GetParam(), box, &box.animations.front()).size();
  const Avatar& avatar = builtin_avatar();
  const std::size_t on_builtin = touches_of(GetParam(), avatar, &avatar.animations.front()).size();
  const auto* const expected = std::ranges::find(kCounts, GetParam(), &Counts::scenario);
  ASSERT_NE(expected, std::end(kCounts)) << "kCounts has no row for the scenario '" << GetParam() << "'; add {\""
                                         << GetParam() << "\", " << on_box << ", " << on_builtin << "}";
  EXPECT_EQ(on_box, expected->box_person);
  EXPECT_EQ(on_builtin, expected->builtin);
}

TEST_P(ScenarioContacts, GoInAndComeOutOfABodyAtRest) {
  const auto touches = touches_of(GetParam(), builtin_avatar(), nullptr);
  EXPECT_EQ(touches.empty(), GetParam() == "still");
  const auto entering = std::ranges::count_if(touches, [](const Touch& touch) { return touch.side > 0; });
  const auto leaving = std::ranges::count_if(touches, [](const Touch& touch) { return touch.side < 0; });
  if (GetParam() == "rest" || GetParam() == "brush") {  // spheres, whose centres stay outside
    EXPECT_EQ(entering, std::ssize(touches));
    return;
  }
  EXPECT_GE(entering, std::ssize(touches) / 3);
  EXPECT_GE(leaving, std::ssize(touches) / 3);
}

INSTANTIATE_TEST_SUITE_P(Scenarios, ScenarioContacts, ::testing::ValuesIn(test::scenario_names()),
                         [](const auto& test) { return std::string(test.param); });

TEST(SlideContacts, LieAllAlongTheWayAcrossTheChestAndBack) {
  std::set<int> there;  // every 2 cm from the left to the right
  std::set<int> back;
  for (const Touch& touch : touches_of("slide", builtin_avatar(), nullptr))
    (touch.frame < 100 ? there : back).insert(static_cast<int>(std::floor(touch.place_m.x / 0.02)));
  const std::set<int> all = {-6, -5, -4, -3, -2, -1, 0, 1, 2, 3, 4, 5};
  EXPECT_TRUE(std::ranges::includes(there, all));
  EXPECT_TRUE(std::ranges::includes(back, all));
}

TEST(PunchContacts, LieOnTheFrontOfTorsoAndHead) {
  for (const Touch& touch : touches_of("punch", builtin_avatar(), nullptr)) {
    EXPECT_GT(touch.place_m.z, -0.02);
    EXPECT_GT(touch.place_m.y, 0.45 * 1.75);
  }
}

TEST(HugContacts, ComeToEveryCollider) {
  std::set<std::uint32_t> touched;
  for (const Touch& touch : touches_of("hug", builtin_avatar(), nullptr)) touched.insert(touch.collider);
  EXPECT_EQ(touched.size(), 100U);
}

TEST(RestContacts, LastWhileTheHandIsLaidOnTheShoulder) {
  std::vector<int> frames;
  for (const Touch& touch : touches_of("rest", builtin_avatar(), nullptr)) {
    frames.push_back(touch.frame);
    EXPECT_GT(touch.place_m.y, 0.75 * 1.75) << "on the shoulder";
    EXPECT_GT(touch.place_m.x, 0.1) << "on the left";
  }
  ASSERT_FALSE(frames.empty());
  int breaks = 0;
  for (std::size_t i = 1; i < frames.size(); ++i) breaks += frames[i] == frames[i - 1] + 1 ? 0 : 1;
  EXPECT_LE(breaks, 1) << "in two seconds there are at most two touches, each without a gap";
  EXPECT_GT(frames.size(), 80U);
}

TEST(BrushContacts, LieAllAlongTheArm) {
  std::set<int> places;  // every 2 cm
  for (const Touch& touch : touches_of("brush", builtin_avatar(), nullptr))
    places.insert(static_cast<int>(std::floor(touch.place_m.y / 0.02)));
  EXPECT_GT(places.size(), 12U);
}

TEST(RainContacts, ComeFromAboveOnly) {
  for (const Touch& touch : touches_of("rain", test::box_person(), nullptr)) {
    EXPECT_NEAR(touch.place_m.y, touch.side > 0 ? 1.75 : 0, 1e-6);
  }
}

}  // namespace
}  // namespace vestige
