#include "analysis/frequency/stage_pass.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <stdexcept>

#include "tests/support/builtin_avatar.hpp"
#include "tests/support/scene_run.hpp"

namespace vestige {
namespace {

/// Works 200 us in one stage and 100 us in another, for each collider.
class Worker final : public Detector {
 public:
  const char* name() const override { return "worker"; }
  DetectorWork detect(const DetectorFrame& frame, ContactRow& row) override {
    if (throws) throw std::runtime_error("tired");
    ++detected;
    row.clear(frame.columns);
    for (std::size_t i = 0; i < frame.columns; ++i) {
      enter(Stage::kTest);
      work_for(std::chrono::microseconds(200));
      enter(Stage::kDecision);
      work_for(std::chrono::microseconds(100));
    }
    return {};
  }
  void skinned_vertices(const DetectorFrame& /*frame*/, std::vector<glm::vec3>& out) override { out.clear(); }

  bool throws = false;
  std::uint64_t detected = 0;

 private:
  static void work_for(std::chrono::microseconds time) {
    const auto end = std::chrono::steady_clock::now() + time;
    while (std::chrono::steady_clock::now() < end) {
    }
  }
};

class StagePass : public ::testing::Test {
 protected:
  const std::vector<TraceFrame> frames_ = test::scene("swarm", test::builtin_avatar(), 3, 6, 60);
  const std::vector<std::uint32_t> two_ = {0, 2};
  const std::vector<std::uint32_t> one_ = {1};
  /// 4 frames with two colliders, then 2 with one.
  const std::vector<StagePlace> places_ = {{std::span(frames_).first(5), two_}, {std::span(frames_).last(3), one_}};
  Worker worker_;
  const std::vector<DetectedPerson> people_ = {{0, test::builtin_avatar(), worker_}};
};

TEST_F(StagePass, GivesTheMeanOfAFrameOverPlacesWithTheirOwnColliders) {
  const auto start = std::chrono::steady_clock::now();
  const StageMeans means = measure_stages(people_, places_, 0);
  const std::chrono::duration<double, std::micro> wall = std::chrono::steady_clock::now() - start;
  ASSERT_EQ(means.stages.size(), 3U);
  EXPECT_EQ(means.stages[0].stage, Stage::kPose);
  EXPECT_EQ(means.stages[1].stage, Stage::kTest);
  EXPECT_EQ(means.stages[2].stage, Stage::kDecision);
  constexpr double kColliders = (4 * 2 + 2 * 1) / 6.0;
  EXPECT_GT(means.stages[0].us, 0);
  EXPECT_GT(means.stages[1].us, 0.99 * kColliders * 200);
  EXPECT_GT(means.stages[2].us, 0.99 * kColliders * 100);
  EXPECT_EQ(means.drawn_by, DrawnBy::kNothing);
  EXPECT_GE(worker_.detected, 6U * 4) << "several passes, and one to warm up";
  EXPECT_LE(means.total_us() * static_cast<double>(worker_.detected - 6), wall.count());
}

TEST_F(StagePass, AddsUpThoseOfAllPeople) {
  Worker other;
  std::vector<TraceFrame> frames = frames_;
  for (TraceFrame& frame : frames) frame.poses.push_back(frame.poses.front());
  const std::vector<StagePlace> places = {{frames, one_}};
  const std::vector<DetectedPerson> both = {{0, test::builtin_avatar(), worker_}, {1, test::builtin_avatar(), other}};
  const StageMeans means = measure_stages(both, places, 0);
  ASSERT_EQ(means.stages.size(), 3U);
  EXPECT_GT(means.stages[1].us, 0.99 * 2 * 200);
  EXPECT_EQ(worker_.detected, other.detected);
  EXPECT_EQ(other.stage_clock(), nullptr);
}

TEST_F(StagePass, LeavesTheDetectorUntimedEvenIfItThrows) {
  measure_stages(people_, places_, 0);
  EXPECT_EQ(worker_.stage_clock(), nullptr);
  worker_.throws = true;
  EXPECT_THROW(measure_stages(people_, places_, 0), std::runtime_error);
  EXPECT_EQ(worker_.stage_clock(), nullptr);
}

}  // namespace
}  // namespace vestige
