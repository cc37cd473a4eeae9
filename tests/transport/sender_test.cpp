#include "transport/sender.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

namespace vestige {
namespace {

using namespace std::chrono_literals;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

using Duties = std::vector<std::uint8_t>;

/// What a sink was told: the duties of a state, or nothing at all for "off".
struct Told {
  Duties duty;
  bool off = false;
  std::uint8_t sequence = 0;
};

/// A vest at hand: it can be busy, silent, unplugged or broken.
class PretendedVest : public ActuatorSink {
 public:
  template <typename Function>
  auto locked(Function function) {
    const std::lock_guard lock(mutex_);
    return function();
  }
  std::string name() const override { return "a vest"; }
  bool ready() override {
    return locked([&] { return !busy; });
  }
  void send(const ActuatorFrame& frame, std::uint8_t sequence) override { tell({frame.duty, false, sequence}); }
  void send_off(std::uint8_t sequence) override { tell({{}, true, sequence}); }
  bool acknowledges() const override { return true; }
  std::vector<Acknowledgement> receive() override {
    return locked([&] { return std::exchange(answers, {}); });
  }
  bool reconnect() override {
    return locked([&] {
      unplugged = tries_until_back-- > 0;
      return !unplugged;
    });
  }
  std::uint64_t bytes_sent() const override { return 0; }

  std::vector<Told> told() {
    return locked([&] { return told_; });
  }

  /// What its actuators do.
  Duties levels() {
    return locked([&] { return levels_; });
  }

  bool busy = false;
  bool silent = false;
  bool knows_off = true;           ///< otherwise it neither obeys nor answers it
  bool answers_offs_late = false;  ///< the first when the second comes, the second never
  bool unplugged = false;
  bool broken = false;
  bool breaks_once = false;
  bool restarted = false;
  int tries_until_back = 0;
  std::uint8_t receive_errors = 0;
  bool outputs_failed = false;  ///< then it is off, and says that, too
  std::vector<Acknowledgement> answers;

 private:
  void tell(const Told& told) {
    locked([&] {
      if (broken || std::exchange(breaks_once, false)) throw Error("a vest", "burns", "use water");
      if (unplugged) throw LinkLost("a vest", "is unplugged", "plug it in");
      told_.push_back(told);
      if (told.off && !knows_off) return;
      levels_ = told.off ? Duties(levels_.size(), 0) : told.duty;
      if (silent) return;
      const bool off = std::exchange(restarted, false) || outputs_failed;
      const Acknowledgement answer = {told.sequence, off, false, receive_errors, outputs_failed};
      if (told.off && answers_offs_late) {
        if (late_) answers.push_back(*late_);
        late_ = answer;
      } else {
        answers.push_back(answer);
      }
    });
  }

  std::mutex mutex_;
  std::vector<Told> told_;
  Duties levels_;
  std::optional<Acknowledgement> late_;
};

class SenderTest : public ::testing::Test {
 protected:
  static SenderOptions options(std::chrono::milliseconds deserted = 1h) {
    return {.floor = 5ms, .refresh = 20ms, .deserted = deserted, .keep_log = true};
  }

  void post(Sender& sender, Duties duty) { sender.post({0, std::move(duty)}, Sender::Clock::now()); }

  /// Waits for it as long as a slow machine may take.
  static void until(const std::function<bool()>& holds) {
    for (int i = 0; i < 5000 && !holds(); ++i) std::this_thread::sleep_for(1ms);
    EXPECT_TRUE(holds());
  }

  /// What the vest was told, repetitions left out; "off" is {}.
  std::vector<Duties> changes() {
    std::vector<Duties> changes;
    for (const Told& told : vest.told()) {
      const Duties duty = told.off ? Duties() : told.duty;
      if (changes.empty() || changes.back() != duty) changes.push_back(duty);
    }
    return changes;
  }

  PretendedVest vest;
  std::mutex events_mutex;
  std::vector<std::string> events;
  std::function<void(const std::string&)> note = [this](const std::string& event) {
    const std::lock_guard lock(events_mutex);
    events.push_back(event);
  };
};

TEST_F(SenderTest, AStateIsSentAndRefreshedUntilTheEndSwitchesItOff) {
  Sender sender(vest, options(), note);
  post(sender, {255, 0});
  until([&] { return vest.told().size() >= 4; });
  const SenderStatistics statistics = sender.finish();
  EXPECT_THAT(changes(), ElementsAre(Duties{255, 0}, Duties{0, 0}, Duties{}));
  EXPECT_EQ(statistics.changes, 1U);
  EXPECT_EQ(statistics.sent, vest.told().size());
  EXPECT_EQ(statistics.acknowledged, statistics.sent);
  EXPECT_EQ(statistics.superseded, 0U);
  EXPECT_TRUE(statistics.off_acknowledged);
  EXPECT_TRUE(statistics.zeros_acknowledged);
  EXPECT_EQ(statistics.most_unanswered, 1U) << "each state was answered before the next";
}

TEST_F(SenderTest, ABoardThatDoesNotKnowOffEndsOffAllTheSame) {
  vest.knows_off = false;
  Sender sender(vest, options(1s), note);
  post(sender, {200, 7});
  until([&] { return changes().size() >= 3; });  // nobody calls, so the vest is switched off
  EXPECT_THAT(changes(), ElementsAre(Duties{200, 7}, Duties{0, 0}, Duties{}));
  post(sender, {1, 2});
  until([&] { return sender.heard(); });
  const SenderStatistics statistics = sender.finish();
  EXPECT_EQ(vest.levels(), (Duties{0, 0}));
  EXPECT_TRUE(statistics.off_sent);
  EXPECT_FALSE(statistics.off_acknowledged);
  EXPECT_TRUE(statistics.zeros_acknowledged);
}

TEST_F(SenderTest, NothingIsSentBeforeThereIsAStateButTheOffAtTheEnd) {
  Sender sender(vest, options(), note);
  std::this_thread::sleep_for(60ms);
  EXPECT_EQ(vest.told().size(), 0U);
  sender.finish();
  EXPECT_THAT(changes(), ElementsAre(Duties{}));
}

TEST_F(SenderTest, ABusyLineGetsTheLatestStateAndTheOthersAreReported) {
  vest.busy = true;
  Sender sender(vest, options(), note);
  for (const Duties& duty : {Duties{10}, Duties{20}, Duties{20}, Duties{30}}) post(sender, duty);
  vest.locked([&] { vest.busy = false; });
  until([&] { return !vest.told().empty(); });
  const SenderStatistics statistics = sender.finish();
  EXPECT_THAT(changes(), ElementsAre(Duties{30}, Duties{0}, Duties{}));
  EXPECT_EQ(statistics.superseded, 2U);
  const std::vector<SentState> log = sender.take_log();
  ASSERT_EQ(log.size(), 3U);
  EXPECT_EQ(log[0].frame.duty, Duties{10});
  EXPECT_EQ(log[0].fate, SentState::Fate::kSuperseded);
  EXPECT_EQ(log[1].fate, SentState::Fate::kSuperseded);
  EXPECT_EQ(log[2].frame.duty, Duties{30});
  EXPECT_EQ(log[2].fate, SentState::Fate::kSent);
}

TEST_F(SenderTest, AStateIsHeardWhenItWasAnswered) {
  Sender sender(vest, options(), note);
  EXPECT_TRUE(sender.heard());
  vest.locked([&] { vest.silent = true; });
  post(sender, {1});
  EXPECT_FALSE(sender.heard());
  until([&] { return vest.told().size() > 2; });
  EXPECT_FALSE(sender.heard());
  vest.locked([&] { vest.silent = false; });
  until([&] { return sender.heard(); });  // a repetition of it was answered
  vest.locked([&] { vest.busy = true; });
  post(sender, {2});
  EXPECT_FALSE(sender.heard());
  vest.locked([&] { vest.busy = false; });
  until([&] { return sender.heard(); });
  EXPECT_THAT(changes(), ElementsAre(Duties{1}, Duties{2}));
}

TEST_F(SenderTest, TheLastStateIsStillSentBeforeTheOff) {
  Sender sender(vest, options(), note);
  post(sender, {1});
  until([&] { return !vest.told().empty(); });
  post(sender, {2});  // within the floor of the first
  sender.finish();
  EXPECT_THAT(changes(), ElementsAre(Duties{1}, Duties{2}, Duties{0}, Duties{}));
}

TEST_F(SenderTest, AnOffThatIsNotAnsweredIsRepeated) {
  vest.silent = true;
  Sender sender(vest, options(), note);
  post(sender, {200});
  until([&] { return !vest.told().empty(); });
  const SenderStatistics statistics = sender.finish();
  EXPECT_THAT(changes(), ElementsAre(Duties{200}, Duties{0}, Duties{}, Duties{0}, Duties{}));
  EXPECT_FALSE(statistics.off_acknowledged);
  EXPECT_EQ(statistics.acknowledged, 0U);
}

TEST_F(SenderTest, AnOffThatIsAnsweredLateIsAnswered) {
  vest.answers_offs_late = true;
  Sender sender(vest, options(), note);
  post(sender, {200});
  until([&] { return sender.heard(); });
  const SenderStatistics statistics = sender.finish();
  EXPECT_THAT(changes(), ElementsAre(Duties{200}, Duties{0}, Duties{}, Duties{0}, Duties{}));
  EXPECT_TRUE(statistics.off_acknowledged);
}

TEST_F(SenderTest, AVestThatWasUnpluggedGetsTheLatestStateWhenItIsBack) {
  Sender sender(vest, options(), note);
  post(sender, {1});
  until([&] { return !vest.told().empty(); });
  vest.locked([&] {
    vest.unplugged = true;
    vest.tries_until_back = 1000000;
  });
  until([&] {
    const std::lock_guard lock(events_mutex);
    return !events.empty();
  });
  post(sender, {2});
  post(sender, {3});
  vest.locked([&] { vest.tries_until_back = 0; });
  until([&] { return changes().size() == 2; });
  const SenderStatistics statistics = sender.finish();
  EXPECT_THAT(changes(), ElementsAre(Duties{1}, Duties{3}, Duties{0}, Duties{}));
  EXPECT_THAT(events, ElementsAre(HasSubstr("is unplugged"), HasSubstr("the link is back")));
  EXPECT_EQ(statistics.links_lost, 1U);
  EXPECT_EQ(statistics.superseded, 1U);
}

TEST_F(SenderTest, AStateThatCouldNotBeWrittenIsSentWhenTheLinkIsBackAndLoggedOnce) {
  vest.unplugged = true;
  vest.tries_until_back = 1;
  Sender sender(vest, options(), note);
  post(sender, {7});
  until([&] { return !vest.told().empty(); });
  const SenderStatistics statistics = sender.finish();
  EXPECT_THAT(changes(), ElementsAre(Duties{7}, Duties{0}, Duties{}));
  EXPECT_EQ(statistics.changes, 1U);
  EXPECT_EQ(statistics.superseded, 0U);
  const std::vector<SentState> log = sender.take_log();
  ASSERT_EQ(log.size(), 1U);
  EXPECT_EQ(log[0].fate, SentState::Fate::kSent);
  EXPECT_GT(log[0].written_s, 0);
}

TEST_F(SenderTest, AVestThatStaysUnpluggedEndsWithoutAnError) {
  vest.unplugged = true;
  vest.tries_until_back = 1000;
  Sender sender(vest, options(), note);
  post(sender, {1});
  EXPECT_NO_THROW(sender.finish());
  EXPECT_TRUE(vest.told().empty());
}

TEST_F(SenderTest, WhatWillNotMendItselfIsThrownWhereStatesAreLeft) {
  vest.broken = true;
  Sender sender(vest, options(), note);
  EXPECT_THROW(
      for (int i = 0; i < 5000; ++i) {
        post(sender, {static_cast<std::uint8_t>(i)});
        std::this_thread::sleep_for(1ms);
      },
      Error);
  vest.locked([&] { vest.broken = false; });
  EXPECT_THROW(sender.finish(), Error);
}

TEST_F(SenderTest, AfterAnErrorTheVestIsSwitchedOffIfItStillListens) {
  vest.breaks_once = true;
  Sender sender(vest, options(), note);
  post(sender, {200});
  until([&] { return vest.told().size() == 2; });
  EXPECT_THROW(sender.finish(), Error);
  EXPECT_THAT(changes(), ElementsAre(Duties{0}, Duties{}));
}

TEST_F(SenderTest, AVestWhosePlaybackHasStoppedIsSwitchedOffUntilItGoesOn) {
  Sender sender(vest, options(1s), note);
  post(sender, {200});
  until([&] { return changes().size() == 3; });
  std::this_thread::sleep_for(100ms);
  EXPECT_THAT(changes(), ElementsAre(Duties{200}, Duties{0}, Duties{}));
  sender.still_here();
  until([&] { return changes().size() == 4; });
  sender.finish();
  EXPECT_THAT(changes(), ElementsAre(Duties{200}, Duties{0}, Duties{}, Duties{200}, Duties{0}, Duties{}));
  EXPECT_THAT(events, ElementsAre(HasSubstr("the playback has stopped")));
}

TEST_F(SenderTest, AVestWhosePlaybackHasStoppedIsSwitchedOffBeforeAnybodyIsTold) {
  std::vector<Duties> when_told;
  Sender sender(vest, options(1s), [&](const std::string& event) {
    note(event);
    when_told = changes();
  });
  post(sender, {200});
  until([&] { return changes().size() == 3; });
  sender.finish();
  EXPECT_THAT(events, ElementsAre(HasSubstr("the playback has stopped")));
  EXPECT_THAT(when_told, ElementsAre(Duties{200}, Duties{0}, Duties{}));
}

TEST_F(SenderTest, AStateThatOnlyTheOffReplacesIsReported) {
  vest.busy = true;
  Sender sender(vest, options(), note);
  post(sender, {1});
  EXPECT_EQ(sender.finish().superseded, 1U);
  ASSERT_EQ(sender.take_log().size(), 1U);
  EXPECT_THAT(changes(), ElementsAre(Duties{}));
}

TEST_F(SenderTest, ABoardThatRestartsIsReportedAndItsNewCountIsNotTakenForDamage) {
  vest.receive_errors = 3;
  Sender sender(vest, options(), note);
  post(sender, {1});
  until([&] { return vest.told().size() >= 2; });
  vest.locked([&] {
    vest.receive_errors = 0;
    vest.restarted = true;
  });
  const std::size_t before = vest.told().size();
  until([&] { return vest.told().size() >= before + 3; });
  const SenderStatistics statistics = sender.finish();
  EXPECT_EQ(statistics.fail_safes, 1U);
  EXPECT_EQ(statistics.receive_errors, 0U);
}

TEST_F(SenderTest, AnswersOfABoardWhoseOutputsFailAreCountedAndAreNoFailSafes) {
  Sender sender(vest, options(), note);
  post(sender, {1});
  until([&] { return vest.told().size() >= 2; });
  vest.locked([&] { vest.outputs_failed = true; });
  const std::size_t before = vest.told().size();
  until([&] { return vest.told().size() >= before + 3; });
  vest.locked([&] { vest.outputs_failed = false; });
  const SenderStatistics statistics = sender.finish();
  EXPECT_GE(statistics.output_failures, 2U);
  EXPECT_EQ(statistics.fail_safes, 0U);
}

TEST_F(SenderTest, DamagedFramesAreCountedAsTheBoardCountsThemModulo256) {
  vest.receive_errors = 254;
  Sender sender(vest, options(), note);
  post(sender, {1});
  until([&] { return vest.told().size() >= 2; });
  vest.locked([&] { vest.receive_errors = 3; });
  const std::size_t before = vest.told().size();
  until([&] { return vest.told().size() >= before + 2; });
  EXPECT_EQ(sender.finish().receive_errors, 5U);
}

TEST(LatencyHistogram, QuantilesLieWithinAHundredthAboveWhatWasMeasured) {
  LatencyHistogram histogram;
  EXPECT_EQ(histogram.quantile_us(0.5), 0);
  for (int ms = 1; ms <= 100; ++ms) histogram.add(ms * 1e-3);
  EXPECT_EQ(histogram.count(), 100U);
  EXPECT_GE(histogram.quantile_us(0.5), 50e3);
  EXPECT_LE(histogram.quantile_us(0.5), 50.5e3);
  EXPECT_GE(histogram.quantile_us(0.99), 99e3);
  EXPECT_LE(histogram.quantile_us(0.99), 100e3);
  EXPECT_EQ(histogram.quantile_us(1), 100e3);
  EXPECT_EQ(histogram.max_us(), 100e3);
}

TEST(LatencyHistogram, WhatIsBelowOrBeyondItsClassesStaysInTheOutermost) {
  LatencyHistogram histogram;
  histogram.add(0);
  histogram.add(-1);
  histogram.add(1e6);
  EXPECT_LE(histogram.quantile_us(0.5), 1);
  EXPECT_EQ(histogram.max_us(), 1e12);
}

}  // namespace
}  // namespace vestige
