// What skipping leaves out, as a user sees it.

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "tests/analysis/plot/plot_fixture.hpp"

namespace vestige {
namespace {

using test::Outcome;
using test::PlotTest;
using test::words_of;
using test::write_text;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

class PlotSkipping : public PlotTest {
 protected:
  /// A sweep of 1 and 20 colliders over 10 frames, whose `cpu` says this of 20 colliders with skipping.
  void write_sweep(const std::string& file, const std::string& counts) const {
    write_text(folder_ / file, fmt::format(R"({{"commit": "0123456789abcdef", "trace": "traces/storm.mcap",
      "machine": {{"processor": "Fast & Cool 9000"}}, "avatar": {{"triangles": 5000}}, "series": [
        {{"detector": "paper", "context": "egl", "skip": "off", "points": [{{"colliders": 20, "hz": 10}}]}},
        {{"detector": "cpu", "context": "", "skip": "off", "points": [{{"colliders": 20, "hz": 4000}}]}},
        {{"detector": "cpu", "context": "", "skip": "on", "points": [
          {{"colliders": 20, "hz": 200000, "pass_frames": 10, {}}}, {{"colliders": 1, "hz": 500000}}]}}]}})",
                                           counts));
  }
};

TEST_F(PlotSkipping, TellsWhatEachKindLeavesInAFrame) {
  write_sweep("sweep.json", R"("part_pairs": 4000, "pairs_spared": 3000, "pairs_tested": 3200, "pairs_meeting": 7)");
  const Outcome outcome = run("skipping .");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.standard_error;
  const std::string words = words_of(folder_ / "skipping.svg");
  for (const char* expected :
       {"storm", "20 colliders, 5 \u00b5s a frame; without skipping 250", "every collider and every triangle",
        "that meet", "25\u202f000", "320", "0.7", "Fast & Cool 9000", "0123456789"})
    EXPECT_THAT(words, HasSubstr(expected));
}

TEST_F(PlotSkipping, DrawsSeveralSweepsAndNothingThatNeverHappens) {
  write_sweep("one.json", R"("part_pairs": 4000, "pairs_spared": 3000, "pairs_tested": 3200, "pairs_meeting": 7)");
  write_sweep("none.json", R"("part_pairs": 4000, "pairs_spared": 4000, "pairs_tested": 0, "pairs_meeting": 0)");
  const Outcome outcome = run("skipping one.json none.json");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.standard_error;
  EXPECT_TRUE(std::filesystem::exists(folder_ / "skipping.png"));
}

TEST_F(PlotSkipping, SaysWhatASweepLacks) {
  write_sweep("sweep.json", R"("pairs_tested": 3200, "pairs_meeting": 7)");
  const Outcome old = run("skipping .");
  EXPECT_EQ(old.exit_code, 1);
  EXPECT_THAT(old.standard_error, AllOf(HasSubstr("part_pairs"), HasSubstr("vestige sweep --detector cpu")));
  write_sweep("sweep.json", R"("part_pairs": 4, "pairs_spared": 5, "pairs_tested": 3200, "pairs_meeting": 7)");
  EXPECT_THAT(run("skipping .").standard_error, HasSubstr("pairs_spared"));
  write_text(folder_ / "sweep.json",
             R"({"commit": "01", "series": [{"detector": "paper", "points": [{"colliders": 1, "hz": 2}]}]})");
  EXPECT_THAT(run("skipping .").standard_error, HasSubstr("does not measure cpu with skipping"));
  write_text(folder_ / "sweep.json", R"({"commit": "01", "series": [
      {"detector": "cpu", "skip": "on", "avatars": 2, "points": [{"colliders": 1, "hz": 2}]}]})");
  EXPECT_THAT(run("skipping .").standard_error, HasSubstr("is of several people"));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "skipping.svg"));
}

}  // namespace
}  // namespace vestige
