// Where the time of a frame goes, as a user sees it.

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/analysis/plot/plot_fixture.hpp"

namespace vestige {
namespace {

using test::Outcome;
using test::Picture;
using test::Pixel;
using test::PlotTest;
using test::words_of;
using test::write_text;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

constexpr Pixel kDraw = {0, 114, 178};
constexpr Pixel kTest = {230, 159, 0};

class PlotStages : public PlotTest {
 protected:
  /// Two detectors, at each of these counts: paper draws for `counts` x 10 us, three quarters of its frame.
  void write_sweep(const std::vector<int>& counts, const std::string& draw_by = "clock") const {
    std::string paper;
    std::string cpu;
    for (const int count : counts) {
      const char* separator = paper.empty() ? "" : ", ";
      paper += fmt::format(
          R"({}{{"colliders": {}, "hz": 100, "draw_by": "{}", "stages": {{"pose": {}, "draw": {}, "read_back": {}}}}})",
          separator, count, draw_by, 2 * count, 9 * count, count);
      cpu += fmt::format(
          R"({}{{"colliders": {}, "hz": 9000, "stages": {{"pose": 4, "candidates": 3, "skinning": 2.5, "test": {}}}}})",
          separator, count, 0.5 + count);
    }
    write_text(folder_ / "sweep.json",
               fmt::format(R"({{"commit": "0123456789abcdef", "machine": {{"processor": "Fast & Cool 9000"}},
      "gl": {{"renderer": "softpipe", "version": "4.5"}}, "avatar": {{"triangles": 5000}}, "series": [
        {{"detector": "paper", "context": "egl", "skip": "off", "points": [{}]}},
        {{"detector": "cpu", "context": "", "skip": "on", "points": [{}]}},
        {{"detector": "embree", "context": "", "skip": "off", "points": [{{"colliders": 1, "hz": 5}}]}}]}})",
                           paper, cpu));
  }
};

TEST_F(PlotStages, NamesSeriesStagesMicrosecondsAndWhereTheyComeFrom) {
  write_sweep({1, 100});
  const Outcome outcome = run("stages .");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.standard_error;
  const std::string words = words_of(folder_ / "stages.svg");
  for (const char* expected :
       {"paper", "egl", "cpu", "skipping", "pose", "candidates", "skinning", "draw", "read-back", "test", "colliders",
        "900", "1200", "110", "Share of the frame (%)", "CPU's clock", "softpipe", "Fast & Cool 9000", "0123456789"})
    EXPECT_THAT(words, HasSubstr(expected));
  EXPECT_THAT(words, Not(HasSubstr("embree"))) << "it has no stages";
  for (const char* absent : {"upload", "decision", "wait"})
    EXPECT_THAT(words, Not(HasSubstr(std::string(absent) + " ")));

  // A share of three quarters, twice, and of about a twentieth and nine tenths.
  const Picture picture = test::read_png(folder_ / "stages.png");
  EXPECT_EQ(picture.width, 1950U);
  constexpr std::size_t kLegendDots = 600;
  const double draw = static_cast<double>(picture.count(kDraw, kLegendDots, picture.width));
  const double test = static_cast<double>(picture.count(kTest, kLegendDots, 1750));
  EXPECT_NEAR(draw / test, (0.75 + 0.75) / (1.5 / 11 + 100.5 / 110), 0.15);
}

TEST_F(PlotStages, TellDrawingFromWaitingWhereTheDriverTimesIt) {
  write_sweep({10}, "timer");
  EXPECT_EQ(run("stages sweep.json").exit_code, 0);
  EXPECT_THAT(words_of(folder_ / "stages.svg"), AllOf(HasSubstr("by the driver's timer"),
                                                      HasSubstr("the shaders at work"), Not(HasSubstr("CPU's clock"))));
}

TEST_F(PlotStages, ShowThreeOfManyCountsOrThoseThatAreNamed) {
  write_sweep({1, 11, 22, 33, 44, 55, 66});
  for (const char* folder : {"three", "two", "none"}) std::filesystem::create_directory(folder_ / folder);
  ASSERT_EQ(run("stages . -o three").exit_code, 0);
  EXPECT_THAT(words_of(folder_ / "three/stages.svg"),
              AllOf(HasSubstr("12.0"), HasSubstr("396"), HasSubstr("792"), Not(HasSubstr("264"))));
  ASSERT_EQ(run("stages . --counts 22,44 -o two").exit_code, 0);
  EXPECT_THAT(words_of(folder_ / "two/stages.svg"), AllOf(HasSubstr("264"), HasSubstr("528"), Not(HasSubstr("792"))));
  const Outcome unknown = run("stages . --counts 22,23 -o none");
  EXPECT_EQ(unknown.exit_code, 1);
  EXPECT_THAT(unknown.standard_error, AllOf(HasSubstr("no stages with 23 colliders"), HasSubstr("1, 11, 22")));
  EXPECT_TRUE(std::filesystem::is_empty(folder_ / "none"));
}

TEST_F(PlotStages, OfASweepWithoutThemSayHowToMeasureThem) {
  write_text(folder_ / "sweep.json",
             R"({"commit": "x", "series": [{"detector": "cpu", "points": [{"colliders": 1, "hz": 2}]}]})");
  const Outcome outcome = run("stages .");
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_THAT(outcome.standard_error, AllOf(HasSubstr("no times of stages"), HasSubstr("vestige sweep --stages")));
  EXPECT_EQ(file_count(), 1U);
}

TEST_F(PlotStages, ThatAreWrongAreRefused) {
  for (const auto& [stages, cause] :
       {std::pair{R"({"pose": -1})", "stages.pose is -1"}, std::pair{R"({"pose": 1, "dreaming": 2})", "'dreaming'"},
        std::pair{R"({"pose": 0})", "no stage that took time"}}) {
    write_text(folder_ / "sweep.json", fmt::format(R"({{"commit": "x", "series": [{{"detector": "cpu", "points": [
                   {{"colliders": 1, "hz": 2, "stages": {}}}]}}]}})",
                                                   stages));
    const Outcome outcome = run("stages .");
    EXPECT_EQ(outcome.exit_code, 1) << stages;
    EXPECT_THAT(outcome.standard_error, AllOf(HasSubstr("sweep.json: series[0].points[0]."), HasSubstr(cause)));
    EXPECT_EQ(file_count(), 1U);
  }
}

}  // namespace
}  // namespace vestige
