// A live run, with input and detector of its own.

#include "analysis/live/live_run.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <deque>
#include <memory>
#include <numeric>
#include <random>

#include "analysis/run/detection_run.hpp"
#include "detector/actuators/actuator_drive.hpp"
#include "detector/output/contacts_hash.hpp"
#include "tests/traces/trace_file/trace_fixture.hpp"

namespace vestige {
namespace {

using namespace std::chrono_literals;
using ::testing::Each;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

/// Finds a contact of actuator 1 on every segment.
class AllSegmentsTouch : public Detector {
 public:
  const char* name() const override { return "all"; }
  DetectorWork detect(const DetectorFrame& frame, ContactRow& row) override {
    row.clear(frame.columns);
    for (const Segment& segment : frame.segments) {
      Contact& contact = row[segment.column];
      contact.triangle = 0;
      contact.t = 0.5F;
      contact.actuator = 1;
    }
    return {};
  }
  void skinned_vertices(const DetectorFrame& /*frame*/, std::vector<glm::vec3>& /*out*/) override {}
};

/// A whole frame, or that nothing comes until the vest is off.
struct Step {
  std::vector<std::uint32_t> ids;
  std::chrono::milliseconds after{1};  ///< the frame before
  bool begins = false;
  bool waits_for_off = false;
};

class ScriptedInput : public LiveInput {
 public:
  ScriptedInput(std::deque<Step> steps, const bool& is_off) : steps_(std::move(steps)), is_off_(is_off) {}

  std::vector<int> descriptors() const override { return {}; }
  void receive() override {
    if (steps_.empty()) {
      ended_ = true;
      return;
    }
    if (steps_.front().waits_for_off && !is_off_) return;
    now_ = steps_.front();
    steps_.pop_front();
    arrived_ = now_.waits_for_off ? Clock::now() : arrived_ + now_.after;
    ++frames_;
  }
  std::uint64_t frames() const override { return frames_; }
  bool has_begun() const override { return frames_ > 0; }
  bool has_ended() const override { return ended_; }
  Clock::time_point arrived() const override { return arrived_; }
  void show(Clock::time_point /*time*/, LiveFrame& out) override {
    out.frame.poses = {Pose{.origin_m = glm::dvec3(0), .nodes = std::vector<NodeLocal>(test::kNodes)}};
    out.frame.colliders.clear();
    for (const std::uint32_t id : now_.ids)
      out.frame.colliders.push_back({.id = id, .position_m = {0, 0, static_cast<double>(frames_)}});
    out.frame.teleported.clear();
    out.arrived = out.decoded = arrived_;
    out.begins = now_.begins;
  }
  std::uint64_t superseded() const override { return 3; }
  std::vector<RecordingNote> take_markers() override {
    return {{.kind = RecordingNote::Kind::kMarker, .text = steps_.empty() ? "last" : "here"}};
  }
  std::vector<std::string> take_problems() override { return {}; }
  LiveLosses losses() const override { return {}; }

 private:
  std::deque<Step> steps_;
  const bool& is_off_;
  Step now_;
  std::uint64_t frames_ = 0;
  bool ended_ = false;
  Clock::time_point arrived_ = Clock::now();
};

class LiveRunTest : public ::testing::Test {
 protected:
  LiveResult run(const std::deque<Step>& steps, const LiveOptions& options = {.ttl = 1h}) {
    ScriptedInput input(steps, is_off_);
    const Avatar avatar = test::skeleton(test::kNodes);
    AllSegmentsTouch detector;
    LiveCalls calls;
    calls.make_laws = [] {
      ActuatorMap map;
      map.actuator_count = 1;
      LawOptions law_options;
      law_options.hold_s = 1000;
      const auto law = [drive = std::make_shared<ActuatorDrive>(make_law("binary", map, law_options))](
                           double time_s, const ContactRow& row, const DetectorFrame*) -> const ActuatorFrame& {
        return drive->next(time_s, row);
      };
      return std::vector<LiveCalls::Law>{law};
    };
    calls.take = [&](std::size_t, const ActuatorFrame& frame, LiveCalls::Clock::time_point) {
      duties_.push_back(frame.duty[0]);
      is_off_ = frame.duty[0] == 0;
    };
    calls.go_on = [] { return true; };
    calls.note = [&](const LiveMoments& moments) { intervals_.push_back(moments.interval_s ? 1 : 0); };
    calls.record = [&](const TraceFrame& frame, const std::vector<RecordingNote>& notes) {
      recorded_.push_back(frame);
      notes_.insert(notes_.end(), notes.begin(), notes.end());
    };
    calls.tell = [](const std::string&) {};
    return run_live(input, std::vector<DetectedPerson>{{0, avatar, detector}}, options, calls);
  }

  bool is_off_ = false;
  std::vector<int> duties_;
  std::vector<int> intervals_;  ///< 1: told
  std::vector<TraceFrame> recorded_;
  std::vector<RecordingNote> notes_;
};

TEST_F(LiveRunTest, EachWholeFrameIsDetectedAndRecordedAtTheTimeWhenItArrived) {
  const LiveResult result =
      run({{.ids = {7}}, {.ids = {7}, .after = 2ms}, {.ids = {7, 3}, .after = 5ms}, {.ids = {3, 7}}});
  EXPECT_EQ(result.frames, 4U);
  EXPECT_EQ(result.people[0].contacts, 4U) << "a collider's first frame tests nothing, whenever it comes";
  ASSERT_EQ(recorded_.size(), 4U);
  for (std::size_t i = 0; i < recorded_.size(); ++i) EXPECT_EQ(recorded_[i].index, i);
  EXPECT_EQ(recorded_[0].time_ns, 0);
  EXPECT_EQ(recorded_[2].time_ns, 7'000'000);
  EXPECT_EQ(recorded_[2].colliders[1].id, 3U) << "its own id, not that of a column";
  EXPECT_THAT(intervals_, ElementsAre(0, 1, 1, 1));
  const auto superseded = [](const RecordingNote& note) { return note.kind == RecordingNote::Kind::kSuperseded; };
  EXPECT_EQ(std::ranges::count_if(notes_, superseded), 1) << "noted once";
  EXPECT_EQ(std::ranges::find_if(notes_, superseded)->count, 3U);
  EXPECT_EQ(std::ranges::count(notes_, "here", &RecordingNote::text), 3);
  ASSERT_FALSE(result.notes.empty()) << "what came after the last frame is not lost";
  EXPECT_EQ(result.notes.front().text, "last");
}

TEST_F(LiveRunTest, TheHashIsThatOfTheContactsByIdsInTheirOrder) {
  const LiveResult result = run({{.ids = {9, 2}}, {.ids = {9, 2}}});
  Contact contact;
  contact.triangle = 0;
  contact.t = 0.5F;
  contact.actuator = 1;
  const std::vector<std::uint32_t> ids = {2, 9};
  ContactsHash expected;
  expected.add(0, ContactRow(2), ids);
  expected.add(1, ContactRow{contact, contact}, ids);
  EXPECT_THAT(result.contacts_hashes, ElementsAre(expected.hex()));
}

TEST_F(LiveRunTest, TheRecordingHasTheSameContactsWhateverIdsCameAndWent) {
  std::deque<Step> steps;
  std::mt19937 random(1);
  for (const std::size_t count : {3U, 200U, 300U, 50U, 700U, 700U, 20U, 1U, 600U}) {
    Step step;
    std::vector<std::uint32_t> ids(1000);
    std::iota(ids.begin(), ids.end(), 0U);
    std::shuffle(ids.begin(), ids.end(), random);
    step.ids.assign(ids.begin(), ids.begin() + static_cast<std::ptrdiff_t>(count));
    step.begins = count == 50;
    steps.push_back(step);
    steps.push_back(step);
  }
  const LiveResult result = run(steps);
  EXPECT_GT(result.people[0].contacts, 2000U);
  EXPECT_GT(result.colliders, 900U) << "more than there were columns at first";

  std::vector<std::uint32_t> all_ids(1000);
  std::iota(all_ids.begin(), all_ids.end(), 0U);
  const Avatar avatar = test::skeleton(test::kNodes);
  AllSegmentsTouch detector;
  DetectionRun replay(avatar, all_ids, detector);
  ContactsHash expected;
  for (const TraceFrame& frame : recorded_) {
    replay.step(frame);
    expected.add(frame.index, replay.row(), all_ids);
  }
  EXPECT_THAT(result.contacts_hashes, ElementsAre(expected.hex()));
}

TEST_F(LiveRunTest, NothingMovesInAFrameThatBegins) {
  const LiveResult result = run({{.ids = {1, 2}}, {.ids = {1, 2}, .begins = true}, {.ids = {1, 2}}});
  EXPECT_EQ(result.people[0].contacts, 2U);
  EXPECT_THAT(recorded_[1].teleported, ElementsAre(1U, 2U)) << "so a replay finds nothing in it, either";
  EXPECT_THAT(recorded_[2].teleported, IsEmpty());
}

TEST_F(LiveRunTest, SilenceSwitchesOffWhateverTheHoldAndNothingLeadsOutOfIt) {
  const LiveResult result =
      run({{.ids = {1}}, {.ids = {1}}, {.ids = {1}, .waits_for_off = true}, {.ids = {1}}}, {.ttl = 60ms});
  EXPECT_EQ(result.frames, 4U);
  EXPECT_EQ(result.silences, 1U);
  ASSERT_EQ(recorded_.size(), 4U);
  EXPECT_THAT(recorded_[2].teleported, ElementsAre(1U));
  EXPECT_EQ(result.people[0].contacts, 2U);
  ASSERT_GE(duties_.size(), 5U);
  EXPECT_EQ(duties_[0], 0);
  EXPECT_EQ(duties_[1], 255);
  EXPECT_THAT(std::vector<int>(duties_.begin() + 2, duties_.end() - 1), Each(0));
  EXPECT_EQ(duties_.back(), 255);
  EXPECT_EQ(intervals_[2], 0) << "the silence is no interval between two frames";
}

TEST_F(LiveRunTest, WithARateFramesAreMadeAtTheirTimes) {
  const LiveResult result =
      run({{.ids = {1}}, {.ids = {1}}, {.ids = {1}, .waits_for_off = true}}, {.rate_hz = 100, .ttl = 1s});
  EXPECT_EQ(result.silences, 1U);
  EXPECT_EQ(result.superseded, 0U) << "what is between two frames is left out by intent";
  ASSERT_GE(recorded_.size(), 3U);
  EXPECT_EQ(recorded_[1].time_ns % 10'000'000, 0);
  EXPECT_GT(recorded_[1].time_ns, 0);
  for (std::size_t i = 0; i < recorded_.size(); ++i) EXPECT_EQ(recorded_[i].index, i);
}

}  // namespace
}  // namespace vestige
