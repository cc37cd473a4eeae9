// The scenarios as a user asks for them.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/support/command_line.hpp"
#include "traces/scenarios/scenarios.hpp"
#include "traces/scene/colliders.hpp"

namespace vestige {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

class ScenarioCommandLine : public test::CommandLineTest {
 protected:
  nlohmann::json replayed(const std::string& record_flags) const {
    return json_of("vestige record --rate 60 -q -o - " + record_flags + " | vestige replay - --json -");
  }
};

TEST_F(ScenarioCommandLine, HelpSaysWhatEachScenarioIsInOneLine) {
  const std::string help = run("vestige record --help").standard_output;
  for (const Scenario& scenario : scenarios())
    EXPECT_THAT(help, ::testing::ContainsRegex("\n +" + std::string(scenario.name) + " +" +
                                               std::string(scenario.summary) + "\n"));
}

TEST_F(ScenarioCommandLine, RecordsEachScenarioAndReplaysItsContacts) {
  for (const Scenario& scenario : scenarios()) {
    const auto replay = replayed("--duration 1 --colliders " + std::string(scenario.name));
    EXPECT_EQ(replay["colliders"], scenario.default_count) << scenario.name;
    // To a method that sees only the colliders' own ways, those at rest have none.
    EXPECT_EQ(replay["contacts"] > 0, scenario.name != "still") << scenario.name;
  }
}

TEST_F(ScenarioCommandLine, CountGoesBeforeTheScenariosOwn) {
  EXPECT_EQ(replayed("--duration 0.1 --colliders slide --count 7")["colliders"], 7);
}

TEST_F(ScenarioCommandLine, NoSegmentLeadsFromADropToTheNext) {
  // At 1 Hz every drop is a new one at each frame.
  const test::Outcome outcome =
      run("vestige record --rate 1 --duration 20 -q -o - --colliders rain | vestige replay - --json -");
  EXPECT_EQ(nlohmann::json::parse(outcome.standard_output, nullptr, false)["contacts"], 0);
}

TEST_F(ScenarioCommandLine, GuessesTheScenarioBehindATypingError) {
  const test::Outcome typo = run("vestige record --colliders swarn -o x.mcap");
  EXPECT_EQ(typo.exit_code, 2);
  EXPECT_THAT(typo.standard_error, HasSubstr("there is no scenario 'swarn'"));
  EXPECT_THAT(typo.standard_error, HasSubstr("did you mean 'swarm'?"));
  const test::Outcome unknown = run("vestige record --colliders tornado -o x.mcap");
  EXPECT_EQ(unknown.exit_code, 2);
  EXPECT_THAT(unknown.standard_error, Not(HasSubstr("did you mean")));
  for (const Scenario& scenario : scenarios())
    EXPECT_THAT(unknown.standard_error, HasSubstr(std::string(scenario.name)));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "x.mcap"));
}

TEST_F(ScenarioCommandLine, WarnsThatAnAvatarAtRestRunsIntoNothing) {
  const std::string still = "vestige record --rate 60 --duration 0.1 --force -o x.mcap --colliders still";
  EXPECT_THAT(run(still + " --animation none").standard_error, HasSubstr("does not move"));
  EXPECT_THAT(run(still).standard_error, Not(HasSubstr("does not move")));
}

}  // namespace
}  // namespace vestige
