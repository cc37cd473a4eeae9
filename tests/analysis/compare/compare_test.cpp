// Verdicts about runs whose frames were made by hand.

#include "analysis/compare/compare.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "analysis/compare/compare_report.hpp"
#include "tests/support/message_of.hpp"

namespace vestige {
namespace {

using ::testing::AllOf;
using ::testing::DoubleNear;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr double kThreshold = 0.05;
constexpr double kClose = 1e-12;

/// So many passes over three frames of 10, 20 and 70 us, times `factor`. Every second one takes 1 % longer.
std::vector<double> steady_us(std::size_t passes, double factor = 1) {
  std::vector<double> us;
  for (std::size_t pass = 0; pass < passes; ++pass)
    for (const double frame : {10.0, 20.0, 70.0}) us.push_back(frame * factor * (pass % 2 == 0 ? 1 : 1.01));
  return us;
}

TEST(PassTimes, OfEqualPassesAreThatPass) {
  const std::vector<double> us = {10, 20, 70, 10, 20, 70, 10};  // the last one is of no complete pass
  const PassTime time = pass_time(us, 3);
  EXPECT_EQ(time.passes, 2U);
  EXPECT_NEAR(time.us, 100, kClose);
  EXPECT_NEAR(time.scatter, 0, kClose);
  EXPECT_TRUE(std::isnan(time.error)) << "two passes do not tell how passes differ";
}

/// A third of all frames, never the same in two passes after each other, is interrupted for 4 ms.
TEST(PassTimes, LeaveOutWhatOtherProgramsAdd) {
  std::vector<double> us = steady_us(30);
  for (std::size_t i = 0; i < us.size(); i += 4) us[i] += 4000;
  EXPECT_NEAR(pass_time(us, 3).us, pass_time(steady_us(30), 3).us, 0.5);
}

TEST(PassTimes, CompareEachFrameWithItselfOnly) {
  // The lower quartile of all frames together would be a skipped one's.
  std::vector<double> us;
  for (int pass = 0; pass < 10; ++pass) us.insert(us.end(), {1, 1, 1, 1000});
  EXPECT_NEAR(pass_time(us, 4).us, 1003, kClose);
}

/// Ten passes of 100, 101, …, 109 us of one frame. The lower quartile of all is 102.25 us. Without one of the three
/// lowest it is 103, without 103 to 109 it is 102.
TEST(PassTimes, HaveTheErrorOfTheJackknife) {
  std::vector<double> us;
  for (int pass = 0; pass < 10; ++pass) us.push_back(100 + pass);
  const PassTime time = pass_time(us, 1);
  EXPECT_NEAR(time.us, 102.25, kClose);
  EXPECT_NEAR(time.scatter, std::log(104.5 / 102.25), kClose);
  const double difference = std::log(103.0 / 102.0);
  EXPECT_NEAR(time.error, difference * std::sqrt(0.9 * 10 * 0.3 * 0.7), kClose);
  EXPECT_EQ(time.batches, 10U);
}

TEST(SpeedRatios, SayHowManyTimesAsFastBIs) {
  const SpeedRatio ratio = speed_ratio(pass_time(steady_us(20), 3), pass_time(steady_us(20, 1.25), 3));
  EXPECT_NEAR(ratio.ratio, 0.8, kClose);
  EXPECT_LT(ratio.low, 0.8);
  EXPECT_GT(ratio.high, 0.8);
  EXPECT_NEAR(ratio.low * ratio.high, 0.64, kClose) << "symmetric on the scale of logarithms";
}

TEST(SpeedRatios, AreNeverSurerThanTwoRunsOfOneProgramAreAlike) {
  const PassTime same = {.passes = 100, .us = 100, .error = 0, .batches = 10, .scatter = 0};
  const SpeedRatio ratio = speed_ratio(same, same);
  EXPECT_NEAR(std::log(ratio.high), 1.959963984540054 * 0.02, 1e-9);
}

TEST(SpeedRatios, AreUnsureIfOneRunScattersMore) {
  const PassTime steady = {.passes = 100, .us = 100, .error = 0, .batches = 10, .scatter = 0.02};
  PassTime scattered = steady;
  scattered.scatter = 0.22;
  EXPECT_NEAR(speed_ratio(steady, scattered).high, std::exp(1.959963984540054 * std::hypot(0.02, 0.12)), 1e-9);
  EXPECT_NEAR(speed_ratio(scattered, scattered).high, speed_ratio(steady, steady).high, kClose);
  scattered.scatter = 0.26;
  EXPECT_TRUE(std::isnan(speed_ratio(steady, scattered).low)) << "too much for any interval";
  EXPECT_TRUE(std::isnan(speed_ratio(scattered, steady).high));
}

TEST(SpeedRatios, HaveStudentsIntervalForFewBatches) {
  const PassTime eight = {.passes = 8, .us = 100, .error = 0.03, .batches = 8, .scatter = 0};
  EXPECT_NEAR(std::log(speed_ratio(eight, eight).high),
              std::hypot(2.365 * 0.03 * std::sqrt(2), 1.959963984540054 * 0.02), 1e-9);
  PassTime seven = eight;
  seven.passes = seven.batches = 7;
  EXPECT_TRUE(std::isnan(speed_ratio(eight, seven).low));
  EXPECT_TRUE(std::isnan(speed_ratio(seven, eight).high));
}

TEST(SpeedVerdicts, NeedTheIntervalAndTheThreshold) {
  const auto verdict = [](double ratio, double low, double high) {
    return std::string(name_of(verdict_of({ratio, low, high}, kThreshold)));
  };
  EXPECT_EQ(verdict(0.90, 0.87, 0.93), "slower");
  EXPECT_EQ(verdict(0.90, 0.80, 1.01), "unclear") << "the interval holds 1";
  EXPECT_EQ(verdict(0.96, 0.94, 0.98), "unclear") << "below the threshold, but not surely";
  EXPECT_EQ(verdict(0.953, 0.94, 0.97), "unclear") << "5 % more time is 1 / 1.05 = 0.9524 of the frequency";
  EXPECT_EQ(verdict(0.952, 0.94, 0.97), "slower");
  EXPECT_EQ(verdict(0.98, 0.96, 0.99), "same") << "a sure change, but a small one";
  EXPECT_EQ(verdict(1.00, 0.96, 1.04), "same");
  EXPECT_EQ(verdict(1.00, 0.96, 1.06), "unclear");
  EXPECT_EQ(verdict(1.051, 1.01, 1.09), "faster");
  EXPECT_EQ(verdict(1.10, 0.99, 1.20), "unclear");
  EXPECT_EQ(verdict(0.5, std::nan(""), std::nan("")), "unclear") << "too few passes";
}

MeasuredPoint point(const std::string& name, double factor, std::size_t passes = 20) {
  MeasuredPoint made;
  made.name = name;
  made.pass_frames = 3;
  made.time = pass_time(steady_us(passes, factor), 3);
  made.texture_hash = "00";
  return made;
}

MeasuredSweep sweep(const std::string& place, const std::vector<MeasuredPoint>& points) {
  MeasuredSweep made;
  made.file = place + "/sweep.json";
  made.place = place;
  made.schema_version = 1;
  made.commit = "c0ffee";
  made.processor = "Abacus";
  made.cores = 2;
  made.question = {{"avatar.joints", "21"}, {"run_frames", "40"}};
  made.points = points;
  return made;
}

SweepComparison compare(const MeasuredSweep& a, const MeasuredSweep& b, Machines machines = Machines::kSame) {
  return compare_sweeps({a}, {b}, kThreshold, machines);
}

TEST(ComparedSweeps, ListTheSlowestFirstAndCountVerdicts) {
  const auto comparison = compare_sweeps({sweep("", {point("p", 1), point("q", 1), point("r", 1), point("s", 1, 3)}),
                                          sweep("hug", {point("p", 1)}), sweep("rain", {point("p", 1)})},
                                         {sweep("", {point("p", 1), point("q", 0.8), point("s", 1, 3), point("t", 1)}),
                                          sweep("hug", {point("p", 1.25)}), sweep("still", {point("p", 1)})},
                                         kThreshold, Machines::kSame);
  std::vector<std::string> shown;
  for (const ComparedPoint& one : comparison.points) shown.push_back(one.name + " " + name_of(one.verdict));
  EXPECT_THAT(shown, ElementsAre("hug: p slower", "p same", "s unclear", "q faster"));
  EXPECT_THAT(comparison.only_a, ElementsAre("r", "rain: p"));
  EXPECT_THAT(comparison.only_b, ElementsAre("t", "still: p"));
  EXPECT_THAT(comparison_table(comparison, kThreshold),
              AllOf(HasSubstr("4 points: 1 slower, 1 faster, 1 same, 1 unclear (by more than 5 %)\n"),
                    HasSubstr("not compared: 2 points only in A, 2 points only in B\n")));
  EXPECT_THAT(comparison_warnings(comparison),
              ElementsAre(HasSubstr("at 1 of 4 points a frame was repeated fewer than 8 times")));
  const auto json = to_json(comparison);
  EXPECT_EQ(json["points"][0]["name"], "hug: p");
  EXPECT_EQ(json["points"][0]["verdict"], "slower");
  EXPECT_NEAR(json["points"][0]["ratio"].get<double>(), 0.8, kClose);
  EXPECT_NEAR(json["points"][0]["hz_a"].get<double>(), 3e6 / 100, 1e-6 * 3e4);
  EXPECT_TRUE(json["points"][2]["low"].is_null());
  EXPECT_EQ(json["counts"]["unclear"], 1);
}

TEST(ComparedSweeps, SayWhatElseChanged) {
  MeasuredSweep a = sweep("", {point("p", 1)});
  MeasuredSweep b = a;
  EXPECT_THAT(compare(a, b).changes, IsEmpty());
  b.commit = "facade";
  b.system = "Debian 13";
  b.points[0].driver = "Mesa 25";
  EXPECT_THAT(compare(a, b).changes,
              ElementsAre("commit: c0ffee -> facade", HasSubstr("Debian 13"), HasSubstr("Mesa")));
}

TEST(ComparedSweeps, SayThatTheContactsChanged) {
  MeasuredSweep a = sweep("", {point("p", 1), point("q", 1), point("r", 1)});
  MeasuredSweep b = a;
  b.points[0].texture_hash = "01";
  b.points[1].contacts = 7;
  const SweepComparison comparison = compare(a, b);
  EXPECT_THAT(comparison_warnings(comparison), ElementsAre(HasSubstr("at 2 of 3 points the contacts differ")));
  EXPECT_THAT(comparison_table(comparison, kThreshold), HasSubstr("same, other contacts\n"));
  EXPECT_EQ(to_json(comparison)["points"][0]["same_answers"], false);
  EXPECT_EQ(to_json(comparison)["points"][2]["same_answers"], true);
}

TEST(ComparedSweeps, SayThatOtherProgramsRan) {
  MeasuredSweep a = sweep("", {point("p", 1), point("q", 1)});
  MeasuredSweep b = a;
  b.points[0].time.scatter = 0.5;
  const SweepComparison comparison = compare(a, b);
  EXPECT_EQ(comparison.count(SpeedVerdict::kUnclear), 1U);
  EXPECT_THAT(comparison_warnings(comparison), ElementsAre(HasSubstr("at 1 of 2 points the repetitions of a frame")));
}

TEST(ComparedSweeps, OfOtherMachinesAreRefusedUnlessAskedFor) {
  const MeasuredSweep a = sweep("", {point("p", 1)});
  MeasuredSweep b = a;
  b.cores = 4;
  EXPECT_THAT(test::message_of([&] { compare(a, b); }),
              AllOf(HasSubstr("another machine"), HasSubstr("Abacus, 4 cores"), HasSubstr("--across-machines")));
  EXPECT_THAT(compare(a, b, Machines::kAny).changes, ElementsAre("machine: Abacus, 2 cores -> Abacus, 4 cores"));
  b = a;
  b.points[0].renderer = "llvmpipe";
  EXPECT_THAT(test::message_of([&] { compare(a, b); }),
              AllOf(HasSubstr("'p'"), HasSubstr("llvmpipe"), HasSubstr("--across-machines")));
  EXPECT_EQ(compare(a, b, Machines::kAny).points.size(), 1U);
}

/// Not even --across-machines compares the answers to two questions.
TEST(ComparedSweeps, OfOtherQuestionsAreRefused) {
  const MeasuredSweep a = sweep("", {point("p", 1)});
  const auto message = [&](const MeasuredSweep& b) { return test::message_of([&] { compare(a, b, Machines::kAny); }); };
  MeasuredSweep b = a;
  b.question[1].second = "10";
  EXPECT_THAT(message(b), AllOf(HasSubstr("run_frames 10"), HasSubstr("with 40")));
  b = a;
  b.question.emplace_back("seed", "4");
  EXPECT_THAT(message(b), AllOf(HasSubstr("seed 4"), HasSubstr("with none")));
  b = a;
  b.schema_version = 2;
  EXPECT_THAT(message(b), AllOf(HasSubstr("schema_version 2"), HasSubstr("has 1")));
  b = a;
  b.points[0].pass_frames = 2;
  EXPECT_THAT(message(b), HasSubstr("2 frames in a pass, but 3"));
  b = a;
  b.points[0].name = "q";
  EXPECT_THAT(message(b), AllOf(HasSubstr("no point in common"), HasSubstr("'p'"), HasSubstr("'q'")));
}

}  // namespace
}  // namespace vestige
