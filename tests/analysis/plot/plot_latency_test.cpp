// How long a live session took, as a user sees it.

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
using ::testing::HasSubstr;
using ::testing::Not;

class PlotLatency : public PlotTest {
 protected:
  void write_session(const std::string& detected_counts, const std::string& stages = "") const {
    const std::string none = R"({"p50_ms": null, "p99_ms": null, "count": 0, "up_to_ms": [], "counts": []})";
    write_text(folder_ / "live.json",
               R"({"commit": "0123456789abcdef", "machine": {"processor": "Fast & Cool 9000"}, "floor_us": 5000,
      "link": {"port": "/dev/vest", "line_time_us": 2430}, "latency": {
        "arrival_to_decoded": {"p50_ms": 0.04, "p99_ms": 0.9, "count": 4, "up_to_ms": [0.04, 0.9], "counts": [3, 1]},
        "arrival_to_detected": {"p50_ms": 0.2, "p99_ms": 1.5, "count": 4, "up_to_ms": [0.2, 1.5], "counts": )" +
                   detected_counts + R"(}, "arrival_to_written": )" + none + R"(, "arrival_to_acknowledged": )" + none +
                   R"(, "pose_delay": {"p50_ms": 11.1})" + stages + "}}");
  }
};

TEST_F(PlotLatency, TellsHowLongEachStageTookAndOfWhat) {
  write_session("[2, 2]");
  const Outcome outcome = run("latency live.json");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.standard_error;
  const std::string words = words_of(folder_ / "live.svg");
  for (const char* expected : {"decoded: half within 0.04 ms, 99 % within 0.9 ms", "contacts found: half within 0.2 ms",
                               "Time since the arrival (ms)", "/dev/vest", "2.43 ms", "11.1 ms", "Fast & Cool 9000",
                               "0123456789", "not noticed"})
    EXPECT_THAT(words, HasSubstr(expected));
  EXPECT_THAT(words, Not(HasSubstr("acknowledged: half"))) << "there were no answers";
  EXPECT_TRUE(std::filesystem::exists(folder_ / "live.png"));
}

TEST_F(PlotLatency, SaysWhatAFileLacks) {
  write_session("[2]");
  EXPECT_THAT(run("latency live.json").standard_error, HasSubstr("has not as many numbers as up_to_ms"));
  write_session("[2, 5]");
  EXPECT_THAT(run("latency live.json").standard_error, HasSubstr("latency.arrival_to_detected.counts[1] is 5"));
  write_text(folder_ / "live.json", R"({"commit": "01"})");
  const Outcome other = run("latency live.json");
  EXPECT_EQ(other.exit_code, 1);
  EXPECT_THAT(other.standard_error, HasSubstr("draw what 'vestige live --json FILE' wrote"));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "live.svg"));
}

}  // namespace
}  // namespace vestige
