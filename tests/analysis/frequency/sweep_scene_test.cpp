// A crowd is copies of the people of a trace, far apart, each with their own colliders.

#include "analysis/frequency/sweep_scene.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "analysis/run/detection_run.hpp"
#include "detector/detectors/make_detectors.hpp"
#include "tests/support/builtin_avatar.hpp"
#include "tests/support/scene_run.hpp"

namespace vestige {
namespace {

using ::testing::ElementsAre;

const ActuatorMap kNoMap;

class CrowdOfThree : public ::testing::Test {
 protected:
  SweepScene crowd(bool first_only) const { return with_copies(recorded_, ids_, {3, first_only}); }

  /// The contacts of each person, with these colliders, at the only place.
  static std::vector<std::uint64_t> contacts_of(const SweepScene& scene, const DrawnIds& ids) {
    const std::size_t people = scene.places[0][0].poses.size();
    std::vector<std::unique_ptr<Detector>> detectors;
    std::vector<DetectedPerson> detected;
    for (std::size_t i = 0; i < people; ++i) {
      detectors.push_back(make_cpu_detector(test::builtin_avatar(), kNoMap, {}));
      detected.push_back({i, test::builtin_avatar(), *detectors.back()});
    }
    DetectionRun run(detected, ids);
    std::vector<std::uint64_t> contacts(people);
    for (const TraceFrame& frame : scene.places[0]) {
      run.step(frame);
      for (std::size_t i = 0; i < people; ++i)
        contacts[i] += static_cast<std::uint64_t>(std::ranges::count_if(run.row(i), &Contact::hit));
    }
    return contacts;
  }

  const std::vector<TraceFrame> frames_ = test::scene("swarm", test::builtin_avatar(), 20, 100, 200);
  const DrawnIds ids_ = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16, 17, 18, 19};
  const SweepScene recorded_ = make_sweep_scene({frames_}, ids_, {5, 20}, 1);
};

TEST_F(CrowdOfThree, HasThreeTimesTheContactsIfEachHasColliders) {
  const std::uint64_t one = contacts_of(recorded_, recorded_.drawn[1][0]).front();
  ASSERT_GT(one, 0U);
  const SweepScene each = crowd(false);
  EXPECT_EQ(each.drawn[0][0].size(), 15U);
  EXPECT_EQ(each.drawn_for_any[0].size(), 60U);
  EXPECT_THAT(contacts_of(each, each.drawn[1][0]), ElementsAre(one, one, one));
  const SweepScene first = crowd(true);
  EXPECT_EQ(first.drawn[0][0].size(), 5U);
  EXPECT_THAT(contacts_of(first, first.drawn[1][0]), ElementsAre(one, 0U, 0U));
}

TEST_F(CrowdOfThree, ComesFromASceneWithoutCollidersThatAreNeverDrawn) {
  const SweepScene fewer = make_sweep_scene({frames_}, ids_, {5}, 1);
  for (const TraceFrame& frame : fewer.places[0]) EXPECT_EQ(frame.colliders.size(), 5U);
  const DrawnIds& drawn = recorded_.drawn[0][0];
  EXPECT_EQ(fewer.drawn[0][0], drawn);
  EXPECT_EQ(contacts_of(fewer, drawn), contacts_of(recorded_, drawn));
}

TEST_F(CrowdOfThree, IsFartherApartThanTheSceneIsWide) {
  // A second person, who would stand where the first's copy is 64 m away.
  SweepScene recorded = recorded_;
  for (TraceFrame& frame : recorded.places[0]) {
    frame.poses.push_back(frame.poses.front());
    frame.poses.back().origin_m.x += 64;
  }
  const std::uint64_t one = contacts_of(recorded, recorded.drawn[1][0]).front();
  const SweepScene each = with_copies(recorded, ids_, {2, false});
  EXPECT_THAT(contacts_of(each, each.drawn[1][0]), ElementsAre(one, 0U, one, 0U));
}

TEST_F(CrowdOfThree, KeepsLimbsWithThoseWhomTheyBelongTo) {
  SweepScene recorded = recorded_;
  for (TraceFrame& frame : recorded.places[0])
    for (ColliderSample& collider : frame.colliders) collider.owner = 1;
  const SweepScene each = with_copies(recorded, ids_, {3, false});
  EXPECT_THAT(contacts_of(each, each.drawn[1][0]), ElementsAre(0U, 0U, 0U));
}

TEST_F(CrowdOfThree, JumpsWhereTheRecordedOneJumps) {
  SweepScene recorded = recorded_;
  recorded.places[0][1].teleported = {ids_[3]};
  const SweepScene each = with_copies(recorded, ids_, {2, false});
  EXPECT_THAT(each.places[0][1].teleported, ElementsAre(3U, 23U));
}

}  // namespace
}  // namespace vestige
