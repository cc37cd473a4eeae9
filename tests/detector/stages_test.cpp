#include "detector/stages.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>

namespace vestige {
namespace {

using std::chrono::microseconds;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

void work_for(microseconds time) {
  const auto end = std::chrono::steady_clock::now() + time;
  while (std::chrono::steady_clock::now() < end) {
  }
}

std::vector<std::string> names_of(const StageClock& clock) {
  std::vector<std::string> names;
  for (const StageTime& time : clock.times()) names.emplace_back(kStageNames[static_cast<std::size_t>(time.stage)]);
  return names;
}

double total_us(const StageClock& clock) {
  double total = 0;
  for (const StageTime& time : clock.times()) total += time.us;
  return total;
}

TEST(StageClock, ChargesTimeToTheStageThatWasEnteredLastAndToNoneAfterItIsLeft) {
  StageClock clock;
  EXPECT_THAT(clock.times(), IsEmpty());
  const auto start = std::chrono::steady_clock::now();
  clock.enter(Stage::kTest);
  work_for(microseconds(2000));
  clock.enter(Stage::kPose);
  work_for(microseconds(1000));
  clock.enter(Stage::kPose);
  work_for(microseconds(1000));
  clock.leave();
  const std::chrono::duration<double, std::micro> wall = std::chrono::steady_clock::now() - start;
  work_for(microseconds(1000));
  EXPECT_EQ(clock.leave().count(), 0);
  ASSERT_THAT(names_of(clock), ElementsAre("pose", "test"));
  EXPECT_GT(clock.times()[0].us, 1900);
  EXPECT_GT(clock.times()[1].us, 1900);
  EXPECT_LE(total_us(clock), wall.count());
  clock.reset();
  EXPECT_THAT(clock.times(), IsEmpty());
}

TEST(StageClock, ItsOwnSwitchesDoNotLookLikeWork) {
  double least_share = 1;
  for (int i = 0; i < 50; ++i) {  // of which some are not interrupted
    StageClock clock;
    const auto start = std::chrono::steady_clock::now();
    for (int k = 0; k < 1000; ++k) {
      clock.enter(Stage::kTest);
      clock.enter(Stage::kDecision);
    }
    clock.leave();
    const std::chrono::duration<double, std::micro> wall = std::chrono::steady_clock::now() - start;
    least_share = std::min(least_share, total_us(clock) / wall.count());
  }
  EXPECT_LT(least_share, 0.5);
}

/// A clock after a draw of some 4 ms that the driver's timer measured as `timer`.
StageClock clock_after_draw(microseconds timer) {
  StageClock clock;
  clock.enter(Stage::kDraw);
  work_for(microseconds(4000));
  const std::chrono::nanoseconds wall = clock.leave();
  clock.note_draw(wall, timer);
  return clock;
}

TEST(StageClock, BelievesADriversTimerUnlessItsAnswerIsImpossible) {
  const StageClock timed = clock_after_draw(microseconds(1500));
  EXPECT_EQ(timed.drawn_by(), DrawnBy::kTimer);
  ASSERT_THAT(names_of(timed), ElementsAre("draw", "wait"));
  EXPECT_DOUBLE_EQ(timed.times()[0].us, 1500);
  EXPECT_GT(timed.times()[1].us, 2400);
  for (const microseconds impossible : {microseconds(0), microseconds(3600000000)}) {
    const StageClock clocked = clock_after_draw(impossible);
    EXPECT_EQ(clocked.drawn_by(), DrawnBy::kClock);
    ASSERT_THAT(names_of(clocked), ElementsAre("draw"));
    EXPECT_GT(clocked.times()[0].us, 3900);
  }
  EXPECT_EQ(StageClock().drawn_by(), DrawnBy::kNothing);
}

}  // namespace
}  // namespace vestige
