#include "analysis/frequency/growth.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "analysis/frequency/sweep_report.hpp"

namespace vestige {
namespace {

TEST(Crossovers, LieWhereStraightLinesOnLogarithmicAxesMeet) {
  const std::vector<double> sizes = {1, 100, 10000};
  // One costs the size itself, the other always ten.
  const std::vector<CostLine> lines = {{"slope", {1, 100, 10000}}, {"flat", {10, 10, 10}}};
  const std::vector<Crossover> found = crossovers(sizes, lines);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_NEAR(found[0].at, 10, 1e-9);
  EXPECT_EQ(found[0].cheaper_below, "slope");
  EXPECT_EQ(found[0].cheaper_above, "flat");
}

TEST(Crossovers, AreNoneBetweenLinesThatKeepTheirOrderOrWereNotMeasured) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const std::vector<double> sizes = {1, 2, 3};
  EXPECT_TRUE(crossovers(sizes, std::vector<CostLine>{{"a", {1, 2, 3}}, {"b", {2, 3, 4}}}).empty());
  EXPECT_TRUE(crossovers(sizes, std::vector<CostLine>{{"a", {1, nan, 5}}, {"b", {2, 3, 4}}}).empty());
}

TEST(LeftOut, NamesTheLastSizeOfALineThatWasTooSlowForLargerOnes) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const std::vector<double> sizes = {10, 100, 1000};
  const std::vector<CostLine> lines = {
      {"slow", {1e3, 3e6, nan}}, {"fast", {1, 2, 3}}, {"slow at the end", {1, 2, 3e6}}, {"stopped", {1, 2, nan}}};
  const std::vector<LeftOut> found = left_out(sizes, lines, 0.5);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].name, "slow");
  EXPECT_EQ(found[0].size, 100);
  EXPECT_NEAR(found[0].frame_s, 3, 1e-9);
}

SweepPoint point(double us, std::uint64_t frames, std::uint64_t pairs) {
  SweepPoint point;
  point.colliders = 7;
  point.places = 1;
  point.repetitions = {{frames, static_cast<double>(frames) * us / 1e6}};
  point.frame_us.assign(frames, us);
  point.pass_frames = frames;
  point.work.pairs_tested = pairs;
  return point;
}

TEST(Ablations, TellWhatWholeFramesSavedFromWhatMeshletsDid) {
  SweepSeries off;
  off.detector = "cpu";
  off.points = {point(100, 10, 1000)};
  SweepSeries on = off;
  on.skip = Skip::kOn;
  // Four frames skipped in 2 us each, six others in 20 us.
  on.points[0].repetitions = {{10, (4 * 2 + 6 * 20) / 1e6}};
  on.points[0].skipped_timed = 4;
  on.points[0].skipped_us = 8;
  on.points[0].work.frames_skipped = 4;
  on.points[0].work.pairs_tested = 30;
  const std::vector<SweepSeries> series = {off, on};
  const std::vector<Ablation> found = ablations(series);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].name, "cpu, skip on");
  EXPECT_EQ(found[0].pairs, 1000U);
  EXPECT_EQ(found[0].pairs_tested, 30U);
  EXPECT_NEAR(found[0].off_us, 100, 1e-9);
  EXPECT_NEAR(found[0].on_us, 12.8, 1e-9);
  EXPECT_NEAR(found[0].saved_by_frames_us, 0.4 * (100 - 2), 1e-9);
  EXPECT_NEAR(found[0].saved_by_meshlets_us, 0.6 * (100 - 20), 1e-9);
  EXPECT_TRUE(ablations(std::vector<SweepSeries>{off}).empty());
}

TEST(Disagreements, AreSaidOfDetectorsThatPromiseTheSameBitsAndOfNoOthers) {
  const std::string one(64, '1');
  const std::string other(64, '2');
  SweepSeries cpu;
  cpu.detector = "cpu";
  cpu.points = {point(1, 1, 1)};
  cpu.points[0].texture_hash = one;
  SweepSeries geometry = cpu;
  geometry.detector = "geometry";
  SweepSeries paper = cpu;
  paper.detector = "paper";
  paper.points[0].texture_hash = other;
  EXPECT_TRUE(disagreements(std::vector<SweepSeries>{paper, cpu, geometry}).empty());
  geometry.points[0].texture_hash = other;
  EXPECT_EQ(disagreements(std::vector<SweepSeries>{paper, cpu, geometry}).size(), 1U);
  SweepSeries left_out = cpu;
  left_out.points[0].texture_hash.clear();  // or stopped before it was known
  EXPECT_EQ(disagreements(std::vector<SweepSeries>{left_out, cpu, geometry}).size(), 1U);
  EXPECT_TRUE(disagreements(std::vector<SweepSeries>{paper, left_out, geometry}).empty());
}

}  // namespace
}  // namespace vestige
