#include <gtest/gtest.h>

#include <cmath>
#include <glm/common.hpp>
#include <set>
#include <string_view>
#include <vector>

#include "tests/support/builtin_avatar.hpp"
#include "tests/support/made/edited_glb.hpp"
#include "tests/support/scenario_names.hpp"
#include "tests/support/skin_geometry.hpp"
#include "traces/scenarios/scenarios.hpp"
#include "traces/scene/colliders.hpp"

namespace vestige {
namespace {

using test::builtin_avatar;

constexpr double kGridStep_m = 0x1p-20;

std::unique_ptr<ColliderSource> make(std::string_view name, const Avatar& avatar, const Animation* animation,
                                     std::uint32_t count = 100, std::uint64_t seed = 1) {
  return find_scenario(name)->make(avatar, animation, {count, seed});
}

std::vector<ColliderSample> at(ColliderSource& source, double time_s) {
  std::vector<ColliderSample> samples;
  source.sample(time_s, samples);
  return samples;
}

bool is_finite(const glm::dvec3& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

class EveryScenario : public ::testing::TestWithParam<std::string_view> {};

TEST_P(EveryScenario, PutsEveryColliderOnTheGridNearTheBody) {
  const Avatar& avatar = builtin_avatar();
  const auto source = make(GetParam(), avatar, &avatar.animations.front());
  for (int k = 0; k < 120; ++k) {
    const auto samples = at(*source, k / 60.0);
    ASSERT_EQ(samples.size(), 100U);
    for (std::uint32_t id = 0; id < 100; ++id) {
      EXPECT_EQ(samples[id].id, id);
      const glm::dvec3 position_m = samples[id].position_m;
      EXPECT_EQ(position_m / kGridStep_m, glm::round(position_m / kGridStep_m));
      EXPECT_LT(glm::distance(position_m, glm::dvec3(0, 0.9, 0)), 3);
    }
  }
}

TEST_P(EveryScenario, IsTheSameAtAnyRateAndEveryTime) {
  const Avatar& avatar = builtin_avatar();
  const auto often = make(GetParam(), avatar, &avatar.animations.front(), 20);
  const auto seldom = make(GetParam(), avatar, &avatar.animations.front(), 20);
  for (int k = 0; k <= 2500; ++k) {
    const double time_s = k / 500.0;  // through more than one loop of the animation
    const auto here = at(*often, time_s);
    if (k % 125 != 0) continue;
    const auto there = at(*seldom, time_s);
    for (std::uint32_t id = 0; id < 20; ++id) EXPECT_EQ(here[id].position_m, there[id].position_m) << time_s;
  }
}

TEST_P(EveryScenario, DiffersBySeed) {
  const Avatar& avatar = builtin_avatar();
  std::set<double> places;
  for (const std::uint64_t seed : {0UL, 1UL, 2UL, ~0UL}) {
    const auto source = make(GetParam(), avatar, &avatar.animations.front(), 1, seed);
    places.insert(at(*source, 0.1).front().position_m.z);
  }
  EXPECT_EQ(places.size(), 4U);
}

TEST_P(EveryScenario, FollowsAnAvatarInAnotherUnit) {
  constexpr float kScale = 128;
  Avatar small = test::box_person();
  Avatar large = test::box_person(kScale);
  test::add_sway(small);
  test::add_sway(large, kScale);
  const auto near = make(GetParam(), small, &small.animations.front(), 20);
  const auto far = make(GetParam(), large, &large.animations.front(), 20);
  for (int k = 0; k < 240; ++k) {
    const auto here = at(*near, k / 60.0);
    const auto there = at(*far, k / 60.0);
    for (std::uint32_t id = 0; id < 20; ++id)
      EXPECT_LT(glm::distance(there[id].position_m / double{kScale}, here[id].position_m), 2 * kGridStep_m);
  }
}

TEST_P(EveryScenario, BearsAvatarsWithoutExtent) {
  const std::vector<Avatar> avatars = {
      test::rigid_avatar({{0, 0, 0}, {0, 0, 0}, {0, 0, 0}}, {{0, 1, 2}}),             // a point
      test::rigid_avatar({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}, {{0, 1, 2}}),             // a line, no height
      test::rigid_avatar({{0, 0, 0}, {1, 0, 0}, {0, 0, 1}}, {{0, 1, 2}}),             // one triangle, lying
      test::rigid_avatar({{0, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {{0, 1, 2}}),             // edge on from the front
      test::rigid_avatar({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {9, 9, 9}}, {{0, 1, 2}}),  // a vertex without a triangle
  };
  for (const Avatar& avatar : avatars) {
    const auto source = make(GetParam(), avatar, nullptr, 50);
    for (int k = 0; k < 60; ++k)
      for (const ColliderSample& sample : at(*source, k / 20.0)) ASSERT_TRUE(is_finite(sample.position_m));
  }
}

INSTANTIATE_TEST_SUITE_P(Scenarios, EveryScenario, ::testing::ValuesIn(test::scenario_names()),
                         [](const auto& test) { return std::string(test.param); });

TEST(Scenarios, AreFoundByTheirNames) {
  for (const Scenario& scenario : scenarios()) EXPECT_EQ(find_scenario(scenario.name), &scenario) << scenario.name;
  EXPECT_EQ(find_scenario("tornado"), nullptr);
}

TEST(Rain, FallsStraightDownAndSaysWhenADropIsANewOne) {
  const Avatar& avatar = builtin_avatar();
  const auto rain = make("rain", avatar, nullptr);
  auto before = at(*rain, 0);
  EXPECT_TRUE(rain->teleported().empty());
  int drops = 0;
  for (int k = 1; k < 1000; ++k) {
    const auto now = at(*rain, k / 1000.0);
    const std::set<std::uint32_t> fresh(rain->teleported().begin(), rain->teleported().end());
    drops += static_cast<int>(fresh.size());
    for (std::uint32_t id = 0; id < now.size(); ++id) {
      const glm::dvec3 way_m = now[id].position_m - before[id].position_m;
      EXPECT_EQ(fresh.contains(id), way_m.y > 0);
      if (fresh.contains(id)) continue;
      EXPECT_NEAR(way_m.y, -0.009, 2 * kGridStep_m);
      EXPECT_EQ(way_m.x, 0);
      EXPECT_EQ(way_m.z, 0);
    }
    before = now;
  }
  EXPECT_GT(drops, 250);
}

TEST(Rain, IsEvenOverTheGroundThatTheBodyCovers) {
  const Avatar avatar = test::box_person();
  const auto rain = make("rain", avatar, nullptr, 4000);
  int quadrants[4] = {};
  for (const ColliderSample& sample : at(*rain, 0)) {
    EXPECT_LE(std::abs(sample.position_m.x), 0.25);
    EXPECT_LE(std::abs(sample.position_m.z), 0.125);
    ++quadrants[(sample.position_m.x > 0 ? 1 : 0) + (sample.position_m.z > 0 ? 2 : 0)];
  }
  for (const int drops : quadrants) EXPECT_NEAR(drops, 1000, 120);
}

TEST(Orbit, CirclesLevelAroundTheBodyBothWays) {
  const Avatar avatar = test::box_person();
  const auto orbit = make("orbit", avatar, nullptr);
  auto before = at(*orbit, 0);
  const auto first = before;
  int left = 0;
  for (int k = 1; k < 100; ++k) {
    const auto now = at(*orbit, k / 100.0);
    for (std::uint32_t id = 0; id < now.size(); ++id) {
      const glm::dvec3 p = now[id].position_m;
      EXPECT_EQ(p.y, first[id].position_m.y);
      EXPECT_NEAR(std::hypot(p.x, p.z), std::hypot(first[id].position_m.x, first[id].position_m.z), 2 * kGridStep_m);
      if (k == 1 && glm::cross(before[id].position_m, p).y > 0) ++left;
    }
    before = now;
  }
  EXPECT_GT(left, 30);
  EXPECT_LT(left, 70);
}

TEST(Punch, StrikesTheFrontAtEightMetresASecondAndStopsFourCentimetresDeep) {
  const Avatar avatar = test::box_person();
  const auto punch = make("punch", avatar, nullptr, 80);
  std::vector<double> fastest(80, 0);
  std::vector<double> deepest_z(80, 1);
  auto before = at(*punch, 0);
  for (int k = 1; k < 2000; ++k) {
    const auto now = at(*punch, k / 1000.0);
    for (std::uint32_t id = 0; id < 80; ++id) {
      fastest[id] = std::max(fastest[id], 1000 * glm::distance(now[id].position_m, before[id].position_m));
      deepest_z[id] = std::min(deepest_z[id], now[id].position_m.z);
    }
    before = now;
  }
  for (std::uint32_t id = 0; id < 80; ++id) {
    EXPECT_NEAR(fastest[id], 8, 0.1);
    // The front is at 0.125; a fist that strikes aslant is tilted.
    EXPECT_NEAR(deepest_z[id], 0.125 - 0.04, id % 8 == 0 ? 0.004 : 0.01);
  }
}

TEST(Slide, GoesOverTheChestFromLeftToRightAndBack) {
  const Avatar& avatar = builtin_avatar();
  const auto slide = make("slide", avatar, nullptr, 1);
  EXPECT_TRUE(slide->warnings().empty());
  const auto rest = test::posed_at(avatar, nullptr, 0);
  double before_x = at(*slide, 0).front().position_m.x;
  EXPECT_GT(before_x, 0.1);
  for (int k = 1; k <= 200; ++k) {
    const glm::dvec3 p = at(*slide, k / 100.0).front().position_m;
    // Dips lean sideways where the chest does.
    if (k <= 100) {
      EXPECT_LT(p.x, before_x + 0.003);
    }
    if (k > 100) {
      EXPECT_GT(p.x, before_x - 0.003);
    }
    EXPECT_NEAR(p.y, 0.72 * 1.75, 0.01);
    EXPECT_GT(p.z, 0);
    EXPECT_LT(test::distance_to_skin(avatar, rest, p), 0.0042);
    if (k == 100) {
      EXPECT_LT(p.x, -0.1);
    }
    before_x = p.x;
  }
}

/// The mannequin turned to its left by quarters of a turn.
Avatar turned_mannequin(int quarters) {
  return parse_avatar_glb(test::turned_glb(builtin_avatar_glb(), quarters), "turned");
}

TEST(Punch, StrikesTheFrontWhicheverWayTheAvatarFaces) {
  for (int quarters = 0; quarters < 4; ++quarters) {
    const Avatar avatar = turned_mannequin(quarters);
    const auto punch = make("punch", avatar, nullptr, 40);
    ASSERT_EQ(at(*punch, 0).size(), 40U);
    for (int k = 0; k < 200; ++k)
      for (const ColliderSample& sample : at(*punch, k / 100.0))
        ASSERT_GT(turned_to_front(sample.position_m, avatar.facing.axis).z, -0.1)
            << quarters << " quarters, frame " << k;
  }
}

TEST(Slide, GoesTheSameWayWhicheverWayTheAvatarFaces) {
  const auto slide = make("slide", builtin_avatar(), nullptr, 10);
  for (int quarters = 1; quarters < 4; ++quarters) {
    const Avatar avatar = turned_mannequin(quarters);
    const auto turned = make("slide", avatar, nullptr, 10);
    for (int k = 0; k < 100; ++k) {
      const auto here = at(*slide, k / 40.0);
      const auto there = at(*turned, k / 40.0);
      for (std::size_t i = 0; i < here.size(); ++i)
        ASSERT_LT(glm::distance(turned_to_front(there[i].position_m, avatar.facing.axis), here[i].position_m), 1e-4)
            << quarters << " quarters, frame " << k;
    }
  }
}

TEST(Slide, KeepsItsObjectTogetherOnTheMovingSkin) {
  const Avatar& avatar = builtin_avatar();
  const Animation* sway = &avatar.animations.front();
  const auto slide = make("slide", avatar, sway, 30);
  for (int k = 0; k <= 40; ++k) {
    const auto samples = at(*slide, k / 10.0);
    const auto posed = test::posed_at(avatar, sway, k / 10.0);
    for (const ColliderSample& sample : samples) {
      EXPECT_LT(glm::distance(sample.position_m, samples.front().position_m), 0.05);
      EXPECT_LT(test::distance_to_skin(avatar, posed, sample.position_m), 0.0045);
    }
  }
}

TEST(Slide, SaysWhenThereIsNoChest) {
  const Avatar avatar = test::rigid_avatar({{0, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {{0, 1, 2}});
  EXPECT_EQ(make("slide", avatar, nullptr)->warnings().size(), 1U);
}

void expect_hugged(const Avatar& avatar, const Animation* animation, double limit_m) {
  const auto hug = make("hug", avatar, animation, 40);
  std::vector<glm::dvec3> first;
  double farthest_m = 0;
  double wandered_m = 0;
  for (int k = 0; k < 60; ++k) {
    const double time_s = k / 13.0;
    const auto posed = test::posed_at(avatar, animation, time_s);
    for (const ColliderSample& sample : at(*hug, time_s)) {
      const double distance_m = test::distance_to_skin(avatar, posed, sample.position_m);
      ASSERT_LE(distance_m, limit_m) << "collider " << sample.id << " at " << time_s << " s";
      farthest_m = std::max(farthest_m, distance_m);
      if (k == 0) first.push_back(sample.position_m);
      wandered_m = std::max(wandered_m, glm::distance(sample.position_m, first[sample.id]));
    }
  }
  EXPECT_GT(farthest_m, limit_m / 2);
  EXPECT_GT(wandered_m, 15 * limit_m);
}

TEST(Hug, StaysWithinTwoCentimetresOfTheMovingSkinAndWandersOverIt) {
  expect_hugged(builtin_avatar(), &builtin_avatar().animations.front(), 0.02);
  Avatar box = test::box_person();
  test::add_sway(box);
  expect_hugged(box, &box.animations.front(), 0.02);
}

TEST(Hug, StaysAsNearToAnAvatarInAnotherUnit) {
  const Avatar giant = test::box_person(100);
  expect_hugged(giant, nullptr, 2);
}

TEST(Hug, GoesInAndOut) {
  const Avatar& avatar = builtin_avatar();
  const Animation* sway = &avatar.animations.front();
  const auto hug = make("hug", avatar, sway, 20);
  std::vector<int> inside(20, 0);
  for (int k = 0; k < 50; ++k) {
    const auto posed = test::posed_at(avatar, sway, k / 50.0);
    for (const ColliderSample& sample : at(*hug, k / 50.0))
      inside[sample.id] += test::is_inside(avatar, posed, sample.position_m) ? 1 : 0;
  }
  for (const int frames : inside) {
    EXPECT_GT(frames, 5);
    EXPECT_LT(frames, 45);
  }
}

TEST(Still, RestsWhereTheMovingBodyRunsIntoIt) {
  const Avatar& avatar = builtin_avatar();
  const Animation* sway = &avatar.animations.front();
  const auto still = make("still", avatar, sway, 40);
  EXPECT_TRUE(still->warnings().empty());
  const auto resting = at(*still, 0);
  std::vector<int> inside(40, 0);
  constexpr int kFrames = 400;
  for (int k = 0; k < kFrames; ++k) {
    const double time_s = sway->duration_s * k / kFrames;
    const auto posed = test::posed_at(avatar, sway, time_s);
    const auto samples = at(*still, time_s);
    for (std::uint32_t id = 0; id < 40; ++id) {
      EXPECT_EQ(samples[id].position_m, resting[id].position_m);
      inside[id] += test::is_inside(avatar, posed, samples[id].position_m) ? 1 : 0;
    }
  }
  EXPECT_EQ(std::ranges::count_if(inside, [](int frames) { return frames > 0 && frames < kFrames; }), 40);
}

TEST(Still, SaysThatABodyAtRestMeetsNothing) {
  const Avatar avatar = test::box_person();
  const auto still = make("still", avatar, nullptr, 20);
  EXPECT_EQ(still->warnings().size(), 1U);
  const auto rest = test::posed_at(avatar, nullptr, 0);
  for (const ColliderSample& sample : at(*still, 0))
    EXPECT_GT(test::distance_to_skin(avatar, rest, sample.position_m), 0.001);
}

/// A body that walks away and begins anew where it started.
TEST(Scenarios, GoAlongWithABodyThatStartsAnew) {
  Avatar walker = test::box_person();
  test::add_sway(walker);
  walker.animations.front().channels.front().values = {0, 0, 0, 0, 0, 1, 0, 0, 2};
  for (const char* name : {"orbit", "slide", "hug"}) {
    const auto source = make(name, walker, &walker.animations.front(), 5);
    auto before = at(*source, 1.5);
    EXPECT_GT(at(*source, 1.9).front().position_m.z, 1) << name;
    EXPECT_TRUE(source->teleported().empty()) << name;
    EXPECT_LT(at(*source, 2.1).front().position_m.z, 1) << name;
    EXPECT_EQ(source->teleported().size(), 5U) << name;
    at(*source, 2.2);
    EXPECT_TRUE(source->teleported().empty()) << name;
  }
}

}  // namespace
}  // namespace vestige
