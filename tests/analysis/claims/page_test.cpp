#include "analysis/claims/page.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "analysis/claims/commands.hpp"
#include "tests/analysis/claims/results.hpp"

namespace vestige {
namespace {

using test::gl;
using test::origin;
using test::point;
using test::result;
using test::series;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;

int count(const std::string& text, const std::string& part) {
  int found = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++found;
  return found;
}

Result made_by(const std::string& file, const std::vector<std::string>& argv) {
  nlohmann::json record = test::record(1);
  record["argv"] = argv;
  return result(file, record);
}

TEST(ClaimsPage, SaysMachineRendererCommitAndCommandOnce) {
  const auto sweep =
      test::sweep({series("paper", gl("softpipe (old)"), {point(1, 100)}), series("cpu", nullptr, {point(1, 200)})});
  const auto runs = runs_of({result("gpu/sweep/sweep.json", sweep)});
  const std::string page = claims_page(runs);
  EXPECT_THAT(page, HasSubstr("| [gpu](gpu) | Abacus, 2 cores | softpipe (old), **software** | 0123456789+ | "));
  for (const char* once : {"Abacus", "softpipe (old)", "0123456789+", "`vestige sweep -o out`"})
    EXPECT_EQ(count(page, once), 1) << once;
  EXPECT_THAT(page, HasSubstr("## How fast?\n"));
  EXPECT_THAT(page, HasSubstr(" ([sweep/sweep](gpu/sweep/sweep.json)):\n  - `paper` on"));
  EXPECT_THAT(page, Not(HasSubstr("How right?"))) << "a question without an answer";
}

TEST(ClaimsPage, KeepsRunsOfTwoMachinesApart) {
  const std::string page =
      claims_page(runs_of({result("gpu/record.json", test::record(1)), result("pc/record.json", test::record(2))}));
  EXPECT_THAT(page, HasSubstr("### gpu\n\n- `record` samples and writes 10 frames/s ([record](gpu/record.json))\n"));
  EXPECT_THAT(page, HasSubstr("### pc\n\n- `record` samples and writes 5 frames/s ([record](pc/record.json))\n"));
}

TEST(ClaimsPage, TakesAFolderWithResultsInItAsOneRun) {
  const auto runs = runs_of({result("record.json", test::record(1)), result("more/record.json", test::record(2)),
                             result("other.json", origin())});
  ASSERT_EQ(runs.size(), 1U);
  EXPECT_EQ(runs[0].results.size(), 2U);
  EXPECT_THAT(claims_page(runs), HasSubstr("([more/record](more/record.json), [record](record.json))"));
}

TEST(ClaimsPage, NamesTheCommitOfAFileThatHasAnotherOne) {
  nlohmann::json other = test::record(1);
  other["commit"] = "fedcba9876543210";
  const std::string page = claims_page(
      runs_of({result("a.json", test::record(1)), result("b.json", test::record(1)), result("c.json", other)}));
  EXPECT_THAT(page, HasSubstr("0123456789+, unless a command names another"));
  EXPECT_THAT(page, HasSubstr("- [c](c.json), 2026-01-02T03:04:05Z, commit fedcba9876+: `"));
}

TEST(Commands, ThatDifferInOneNameStandTogether) {
  const auto commands =
      commands_of({made_by("a.json", {"vestige", "record", "--colliders", "hug", "-o", "x/hug.mcap"}),
                   made_by("b.json", {"vestige", "replay", "x/hug.mcap"}),
                   made_by("c.json", {"vestige", "record", "--colliders", "rain", "-o", "x/rain.mcap"}),
                   made_by("d.json", {"vestige", "record", "--colliders", "still", "-o", "x/up.mcap"})});
  ASSERT_EQ(commands.size(), 3U);
  EXPECT_EQ(commands[0].text, "vestige record --colliders <hug|rain> -o x/<hug|rain>.mcap");
  EXPECT_THAT(commands[0].files, ElementsAre("a.json", "c.json"));
  EXPECT_EQ(commands[2].text, "vestige record --colliders still -o x/up.mcap") << "differs in two names";
}

TEST(Commands, ShortenAListOfFilesAsAShellDoes) {
  const auto commands =
      commands_of({made_by("a.json", {"/bin/vestige", "query", "data/x/1.csv", "data/2.csv", "data/3.csv", "-q"})});
  ASSERT_EQ(commands.size(), 1U);
  EXPECT_EQ(commands[0].text, "vestige query data/{x/1,2,3}.csv -q");
}

}  // namespace
}  // namespace vestige
