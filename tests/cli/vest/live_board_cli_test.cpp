// From a source to the pins of the simulated board, by way of a live session.

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "tests/cli/vest/board_command_line.hpp"
#include "tests/support/duty_rows.hpp"
#include "tests/support/udp.hpp"

namespace vestige {
namespace {

using ::testing::Each;

class LiveToBoard : public test::BoardCommandLine {
 protected:
  /// Streams a walk to a session, which ends by `signal`.
  test::Outcome feel(const std::string& signal) const {
    record("--animation walk --colliders hug --count 30 --rate 100 --duration 2");
    return run_with_board(
        fmt::format("vestige live --from {0} --port vest --json live.json 2>error & live=$!\n"
                    "for i in $(seq 200); do grep -q listening error && break; sleep 0.05; done\n"
                    "vestige stream -q trace.mcap --loop --port {0} & source=$!\n"
                    "sleep 3; kill -{1} $live; wait $live; code=$?; kill $source; sleep 1\n"
                    "(exit $code)",
                    source_, signal));
  }

  std::vector<test::Row> pins() const { return test::read_timeline(folder_ / "pins.csv"); }

  const std::string source_ = fmt::format("vmc://127.0.0.1:{}", test::free_udp_port());
};

TEST_F(LiveToBoard, TheMotorsTurnAndAreOffAtTheEnd) {
  EXPECT_EQ(feel("INT").exit_code, 0) << read_text_file(folder_ / "error");
  const auto rows = pins();
  ASSERT_GT(rows.size(), 5U);
  EXPECT_TRUE(std::ranges::any_of(rows, [](const test::Row& row) { return std::ranges::max(row.level) > 200; }));
  EXPECT_THAT(rows.back().level, Each(0));
  const auto json = json_in("live.json");
  EXPECT_EQ(json["off_acknowledged"], true);
  EXPECT_GT(json["latency"]["arrival_to_acknowledged"]["count"], 0);
  EXPECT_GT(json["link"]["line_time_us"], 0);
}

TEST_F(LiveToBoard, ASessionThatIsKilledLeavesNoMotorOn) {
  EXPECT_EQ(feel("KILL").exit_code, 137);
  const auto rows = pins();
  ASSERT_GT(rows.size(), 5U);
  EXPECT_THAT(rows.back().level, Each(0));
}

}  // namespace
}  // namespace vestige
