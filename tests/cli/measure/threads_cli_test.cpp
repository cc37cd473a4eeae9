#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/support/command_line.hpp"

namespace vestige {
namespace {

using ::testing::HasSubstr;

class ThreadsFlag : public test::CommandLineTest {};

TEST_F(ThreadsFlag, ThreadsChangeNoBitOfAnyResult) {
  ASSERT_EQ(run("vestige record -q --count 30 --rate 120 --duration 2 -o trace.mcap").exit_code, 0);
  for (const std::string detector : {"cpu", "exact", "geometry"}) {
    for (const std::string threads : {"1", "3"})
      ASSERT_EQ(run("vestige replay -q trace.mcap --force --detector " + detector + " --threads " + threads +
                    " --contacts contacts" + threads + ".csv --timeline timeline" + threads + ".csv --json run" +
                    threads + ".json")
                    .exit_code,
                0);
    EXPECT_EQ(run("cmp contacts1.csv contacts3.csv && cmp timeline1.csv timeline3.csv").exit_code, 0) << detector;
    const nlohmann::json one = json_of("cat run1.json");
    const nlohmann::json three = json_of("cat run3.json");
    for (const char* field :
         {"texture_hash", "frames", "frames_skipped", "contacts", "unsure", "pairs_tested", "actuators"})
      EXPECT_EQ(one[field], three[field]) << detector << " " << field;
    EXPECT_EQ(three["threads"], 3);
    EXPECT_GT(three["contacts"], 0);
  }
}

TEST_F(ThreadsFlag, AComparisonRunsOnThemToo) {
  ASSERT_EQ(run("vestige record -q --count 30 --rate 120 --duration 1 -o trace.mcap").exit_code, 0);
  const test::Outcome same = run("vestige replay trace.mcap --threads 2 --verify exact");
  EXPECT_EQ(same.exit_code, 0) << same.standard_error;
  EXPECT_THAT(same.standard_output, HasSubstr("verify against exact: 0 contacts differ"));
}

TEST_F(ThreadsFlag, ATraceThatContradictsItselfMidwayEndsWithItsErrorAndNotWithAHang) {
  ASSERT_EQ(run("vestige record -q --compression none --count 5 --rate 100 --duration 2 -o trace.mcap").exit_code, 0);
  // The second half of the file once more behind the first: its frames run back in time.
  ASSERT_EQ(
      run("python3 -c \"d=open('trace.mcap','rb').read(); h=len(d)//2; open('twice.mcap','wb').write(d[:h]+d[h//2:])\"")
          .exit_code,
      0);
  const test::Outcome one = run("timeout 60 vestige replay twice.mcap");
  const test::Outcome four = run("timeout 60 vestige replay twice.mcap --threads 4");
  EXPECT_EQ(four.exit_code, one.exit_code);
  EXPECT_NE(four.exit_code, 0);
  EXPECT_NE(four.exit_code, 124);
  EXPECT_EQ(four.standard_error, one.standard_error);
}

TEST_F(ThreadsFlag, AsManyAsAMachineCouldHaveAreTakenAndNoOthers) {
  ASSERT_EQ(run("vestige record -q --count 2 --rate 60 --duration 0.2 -o trace.mcap").exit_code, 0);
  EXPECT_EQ(run("vestige replay trace.mcap --threads 256").exit_code, 0);
  EXPECT_EQ(run("vestige replay trace.mcap --threads 0").exit_code, 2);
  EXPECT_EQ(run("vestige replay trace.mcap --threads 257").exit_code, 2);
}

}  // namespace
}  // namespace vestige
