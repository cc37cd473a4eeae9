#include "analysis/run/playback.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <thread>
#include <vector>

#include "detector/actuators/actuator_drive.hpp"
#include "tests/support/test_data.hpp"
#include "tests/traces/trace_file/trace_fixture.hpp"

namespace vestige {
namespace {

using namespace std::chrono_literals;
using ::testing::Contains;
using ::testing::ElementsAre;

/// Finds a contact of actuator 1 in every frame.
class AlwaysTouched : public Detector {
 public:
  const char* name() const override { return "always"; }
  DetectorWork detect(const DetectorFrame& frame, ContactRow& row) override {
    Contact contact;
    contact.triangle = 0;
    contact.actuator = 1;
    row.clear(frame.columns);
    std::ranges::fill(row, contact);
    return {};
  }
  void skinned_vertices(const DetectorFrame&, std::vector<glm::vec3>&) override {}
};

struct Taken {
  double time_s;
  std::uint8_t duty;
  PlaybackCalls::Clock::duration due;  ///< since the first
};

class PlaybackTest : public ::testing::Test {
 protected:
  void write_trace(const std::vector<double>& times_s) const {
    const std::vector<std::byte> glb = test::skeleton_glb(test::kNodes);
    TraceWriter writer(folder / "trace.mcap", {}, {{test::skeleton(test::kNodes), {.avatar_glb = glb}}},
                       test::steady_options());
    for (std::size_t i = 0; i < times_s.size(); ++i) {
      TraceFrame frame = test::frame(i, test::kNodes, test::kColliders);
      frame.time_ns = std::llround(times_s[i] * 1e9);
      writer.write(frame);
    }
    writer.finish();
  }

  /// Plays until the end, or until `frames` have been handed on.
  std::vector<Taken> played(const PlaybackOptions& options, std::size_t frames = 1000) {
    TraceReader reader(folder / "trace.mcap");
    const Avatar avatar = test::skeleton(test::kNodes);
    AlwaysTouched detector;
    std::vector<Taken> taken;
    PlaybackCalls::Clock::time_point first;
    PlaybackCalls calls;
    calls.make_laws = [] {
      ActuatorMap map;
      map.actuator_count = 1;
      const auto law = [drive = std::make_shared<ActuatorDrive>(make_law("binary", map, {}))](
                           double time_s, const ContactRow& row, const DetectorFrame*) -> const ActuatorFrame& {
        return drive->next(time_s, row);
      };
      return std::vector<PlaybackCalls::Law>{law};
    };
    calls.go_on = [&](double) { return taken.size() < frames; };
    calls.fell_behind = [&] { ++fell_behind; };
    calls.take = [&](std::size_t, const ActuatorFrame& frame, PlaybackCalls::Clock::time_point due) {
      if (taken.empty()) first = due;
      EXPECT_GE(PlaybackCalls::Clock::now(), due);
      taken.push_back({frame.time_s, frame.duty[0], due - first});
      std::this_thread::sleep_for(nap);
    };
    result = play(reader, std::vector<DetectedPerson>{{0, avatar, detector}}, options, calls);
    return taken;
  }

  const test::TemporaryFolder folder;
  PlaybackResult result;
  int fell_behind = 0;
  std::chrono::milliseconds nap{0};  ///< with each frame
};

TEST_F(PlaybackTest, WhatIsMoreThanASecondLateIsSaidOnce) {
  write_trace({0, 0.01, 0.02, 0.03});
  nap = std::chrono::milliseconds(600);
  EXPECT_EQ(played({}).size(), 4U);
  EXPECT_EQ(fell_behind, 1);
  EXPECT_GE(result.most_late_s, 1.7);
}

TEST_F(PlaybackTest, EachFrameIsDueAtTheTracesOwnTimeWhateverTheOthersTook) {
  write_trace({1, 1.02, 1.03, 1.1});
  std::vector<PlaybackCalls::Clock::duration> due;
  for (const Taken& taken : played({})) due.push_back(taken.due);
  EXPECT_THAT(due, ElementsAre(0ms, 20ms, 30ms, 100ms));
  EXPECT_EQ(result.frames, 4U);
  EXPECT_EQ(result.loops, 1U);
  EXPECT_EQ(result.people[0].contacts, 4U * test::kColliders);
  due.clear();
  for (const Taken& taken : played({.rate = 10})) due.push_back(taken.due);
  EXPECT_THAT(due, ElementsAre(0ms, 2ms, 3ms, 10ms));
}

TEST_F(PlaybackTest, NothingIsHeldOnThroughAGapOfTheTrace) {
  write_trace({0, 0.01, 0.6});
  const std::vector<Taken> taken = played({});
  ASSERT_GT(taken.size(), 3U);
  EXPECT_EQ(taken[1].duty, 255);
  EXPECT_EQ(taken[2].duty, 0);
  EXPECT_GT(taken[2].time_s, 0.2);
  EXPECT_LT(taken[2].time_s, 0.6);
  EXPECT_EQ(taken.back().duty, 255);
  EXPECT_EQ(result.frames, 3U);
}

TEST_F(PlaybackTest, ALoopGoesOnInTimeUntilItIsStopped) {
  write_trace({0.5, 0.51, 0.52});
  const std::vector<Taken> taken = played({.rate = 2, .loop = true}, 7);
  ASSERT_EQ(taken.size(), 7U);
  for (std::size_t i = 0; i < taken.size(); ++i) {
    EXPECT_NEAR(taken[i].time_s, 0.5 + 0.01 * static_cast<double>(i), 1e-9);
    EXPECT_NEAR(std::chrono::duration<double>(taken[i].due).count(), 0.005 * static_cast<double>(i), 1e-6);
  }
  EXPECT_EQ(result.loops, 2U);
  EXPECT_EQ(result.frames, 7U);
}

TEST_F(PlaybackTest, ATraceOfOneFrameLoopsWithoutHaste) {
  write_trace({0});
  const std::vector<Taken> taken = played({.rate = 100, .loop = true}, 3);
  ASSERT_EQ(taken.size(), 3U);
  EXPECT_GE(taken[2].due, 2ms);
}

}  // namespace
}  // namespace vestige
