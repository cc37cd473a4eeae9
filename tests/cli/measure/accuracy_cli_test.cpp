// Run time against error, as a user asks for it: real scenes, small ones.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "tests/support/command_line.hpp"
#include "tests/support/gl/gl_context.hpp"
#include "traces/files/input_file.hpp"

namespace vestige {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

constexpr const char* kSmall =
    "vestige accuracy --detector cpu --rate 60,250 --truth-rate 4000 --duration 0.1 --events 1 --check-frames 20 "
    "--passes 1 --no-figure ";

class AccuracyCommandLine : public test::CommandLineTest {
 protected:
  static const nlohmann::json& point(const nlohmann::json& scene, const std::string& method, std::size_t rate) {
    for (const auto& series : scene["series"])
      if (series["method"] == method) return series["points"][rate];
    throw std::out_of_range(method);
  }

  void expect_refused(const std::string& flags, const std::string& word) const {
    const test::Outcome refused = run("vestige accuracy -o refused " + flags);
    EXPECT_EQ(refused.exit_code, 2) << flags << "\n" << refused.standard_error;
    EXPECT_THAT(refused.standard_error, HasSubstr(word)) << flags;
    EXPECT_FALSE(std::filesystem::exists(folder_ / "refused")) << flags;
  }
};

TEST_F(AccuracyCommandLine, AMethodThatSeesOnlyTheCollidersOwnWaysMissesWhatTheBodyRunsInto) {
  const auto result = json_of(std::string(kSmall) + "--colliders still -o still --json -");
  const auto& still = result["scenes"][0];
  EXPECT_EQ(still["colliders"], "still");
  EXPECT_EQ(still["truth"]["method"], "ccd");
  EXPECT_GT(still["truth"]["events"], 5);
  EXPECT_EQ(still["truth"]["frames_checked_by_exact"], 20);
  EXPECT_EQ(still["seeds"], nlohmann::json({1}));
  for (const std::size_t rate : {std::size_t{0}, std::size_t{1}}) {
    EXPECT_GT(point(still, "static", rate)["true_events"], 5);
    EXPECT_EQ(point(still, "static", rate)["missed"], point(still, "static", rate)["true_events"]);
    EXPECT_EQ(point(still, "static", rate)["impact_error_ms"], nullptr);
    EXPECT_EQ(point(still, "static", rate)["wrong_share"]["value"], 1);
    EXPECT_EQ(point(still, "ccd", rate)["missed"], 0);
    EXPECT_EQ(point(still, "ccd", rate)["wrong_share"]["value"], 0);
    EXPECT_GT(point(still, "ccd", rate)["wrong_share"]["high"], 0.03);  // few colliders prove little
    EXPECT_LT(point(still, "ccd", rate)["impact_error_ms"]["median"], 0.5);
  }
  EXPECT_EQ(result["animation"], "walk");
  EXPECT_EQ(result["run"]["scenes"][0]["series"][0]["points"][1]["frames"], 25);
}

TEST_F(AccuracyCommandLine, HandsThatAreLaidOnTheSkinAreFeltForAsLongAsTheyTouch) {
  const std::string flags =
      "vestige accuracy --detector cpu --rate 90 --truth-rate 4000 --duration 1.2 --events 1 --check-frames 5 "
      "--passes 1 --no-figure --colliders rest --count 12 --method ccd -o rest ";
  const auto rest = json_of(flags + "--json -")["scenes"][0];
  const auto& found = point(rest, "ccd", 0);
  EXPECT_GT(found["touches"]["frames_within"], 300);
  EXPECT_EQ(found["touches"]["reported"], found["touches"]["frames_within"]);
  EXPECT_GT(found["touches"]["frames_outside"], 200);
  EXPECT_EQ(found["touches"]["false"], 0);
  EXPECT_EQ(found["missed"], 0);
  EXPECT_EQ(found["wrong_actuator"], 0) << "actuators are judged apart";
  EXPECT_TRUE(rest["truth"].contains("inside_s"));
  const test::Outcome table = run(flags + "--force");
  EXPECT_THAT(table.standard_output, HasSubstr("while a sphere touches"));
  EXPECT_THAT(json_of(std::string(kSmall) + "--colliders still -o still --json -").dump(), Not(HasSubstr("touches")));
}

TEST_F(AccuracyCommandLine, MarksApproximateDetectorsInBothTables) {
  const test::Outcome outcome =
      run("vestige accuracy --detector boxes --rate 90 --truth-rate 4000 --duration 1.2 --events 1 --check-frames 5 "
          "--passes 1 --no-figure --colliders rest --count 12 --method static -o rest");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.standard_error;
  const std::size_t touches = outcome.standard_output.find("while a sphere touches");
  ASSERT_NE(touches, std::string::npos) << outcome.standard_output;
  EXPECT_THAT(outcome.standard_output.substr(0, touches), HasSubstr("\nboxes, static (approx.) "));
  EXPECT_THAT(outcome.standard_output.substr(touches), HasSubstr("\nboxes, static (approx.) "));
}

TEST_F(AccuracyCommandLine, AddsSeedsUntilThereAreEnoughEventsAndComparesApproximateDetectors) {
  const test::Outcome outcome = run(
      "vestige accuracy --detector cpu,boxes,capsules,decimated --method static,ccd --rate 60,250 --truth-rate 4000 "
      "--duration 0.2 --colliders swarm --count 40 --events 150 --check-frames 10 --passes 2 --no-figure -o many");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.standard_error;
  EXPECT_THAT(outcome.standard_output, HasSubstr("boxes, static (approx.)"));
  EXPECT_THAT(outcome.standard_output, HasSubstr("decimated, ccd (approx.)"));
  const nlohmann::json scene = json_in("many/accuracy.json")["scenes"][0];
  EXPECT_GE(scene["truth"]["events"], 150);
  EXPECT_GT(scene["seeds"].size(), 1U);
  EXPECT_EQ(scene["truth"]["frames_checked_by_exact"], 10 * scene["seeds"].size());
  double wrong_by_boxes = 0;
  for (const auto& series : scene["series"]) {
    EXPECT_EQ(series["approximate"], series["detector"] != "cpu");
    for (const auto& point : series["points"]) {
      const auto& wrong = point["within_tolerance"]["wrong_share"];
      EXPECT_LE(wrong["low"], wrong["value"]);
      EXPECT_GE(wrong["high"], wrong["value"]);
      if (series["detector"] == "boxes") wrong_by_boxes = wrong["value"];
    }
  }
  EXPECT_GT(wrong_by_boxes, 0.2);  // a box is not a body
  EXPECT_EQ(point(scene, "ccd", 1)["missed"], 0);
  const nlohmann::json run_json = json_in("many/run.json");
  for (const auto& series : run_json["scenes"][0]["series"])
    for (const auto& point : series["points"]) {
      EXPECT_EQ(point["passes"], 2);
      EXPECT_LE(point["processor_ms_per_s"]["low"], point["processor_ms_per_s"]["value"]);
    }
  const auto& pareto = run_json["scenes"][0]["pareto"];
  ASSERT_FALSE(pareto.empty());
  EXPECT_EQ(pareto.back()["detector"], "cpu");  // nothing is more right
  EXPECT_THAT(outcome.standard_output, HasSubstr("* "));
}

TEST_F(AccuracyCommandLine, MeasuresWithFurtherSeedsOnlyWhatIsNotPreciseYet) {
  const auto result = json_of(
      "vestige accuracy --detector cpu,boxes --method static --rate 60 --truth-rate 4000 --duration 0.2 --colliders "
      "swarm --count 40 --events 1 --precision 8 --check-frames 1 --passes 1 --no-figure -o precise --json -");
  const auto& scene = result["scenes"][0];
  const auto true_events = [&](std::size_t series) { return scene["series"][series]["points"][0]["true_events"]; };
  EXPECT_LT(true_events(0), true_events(1));
  EXPECT_EQ(true_events(1), scene["truth"]["events"]);
  for (const auto& series : scene["series"])
    for (const auto& point : series["points"])
      for (const auto& share : {point["wrong_share"], point["within_tolerance"]["wrong_share"]})
        EXPECT_LE(share["high"].get<double>() - share["low"].get<double>(), 2 * 0.08) << series["detector"];
  EXPECT_EQ(result["precision_pp"], 8);
}

TEST_F(AccuracyCommandLine, SaysThatNothingTouches) {
  std::ofstream(folder_ / "far.csv") << "time_s,id,x,y,z\n0,7,50,1.2,-1\n1,7,50,1.2,1\n";
  const test::Outcome outcome = run(std::string(kSmall) + "--colliders far.csv -o far");
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_THAT(outcome.standard_error, HasSubstr("no collider touches the avatar in any scene"));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "far/accuracy.json"));
}

TEST_F(AccuracyCommandLine, EqualWorkGivesEqualBytesWhateverItsTime) {
  ASSERT_EQ(run(std::string(kSmall) + "--colliders swarm,hug --count 20 -o one").exit_code, 0);
  ASSERT_EQ(run(std::string(kSmall) + "--colliders swarm,hug --count 20 -o two").exit_code, 0);
  const std::string one = read_text_file(folder_ / "one/accuracy.json");
  EXPECT_EQ(one, read_text_file(folder_ / "two/accuracy.json"));
  EXPECT_THAT(one, Not(HasSubstr("_us\"")));
  EXPECT_THAT(read_text_file(folder_ / "one/run.json"), HasSubstr("\"us_p99\""));
  ASSERT_EQ(run(std::string(kSmall) + "--colliders swarm,hug --count 20 --seed 2 -o three").exit_code, 0);
  EXPECT_NE(one, read_text_file(folder_ / "three/accuracy.json"));
}

TEST_F(AccuracyCommandLine, BothTruthsAreTheSame) {
  const std::string tiny =
      "vestige accuracy --detector cpu --method ccd --rate 60 --truth-rate 120 --duration 0.05 --count 3 --colliders "
      "hug --events 1 --no-figure --json - ";
  auto cpu = json_of(tiny + "-o a")["scenes"][0]["truth"];
  auto exact = json_of(tiny + "--truth exact -o b")["scenes"][0]["truth"];
  EXPECT_EQ(exact["detector"], "exact");
  cpu.erase("detector");
  exact.erase("detector");
  EXPECT_EQ(cpu, exact);
}

TEST_F(AccuracyCommandLine, ReadsCollidersFromAFileAndSaysWhatThePublishedMethodLacks) {
  std::ofstream(folder_ / "hand.csv") << "time_s,id,x,y,z\n0,7,0,1.2,-1\n1,7,0,1.2,1\n";
  const test::Outcome outcome =
      run("vestige accuracy --detector paper,cpu --method static,ccd --rate 60 --truth-rate 2000 --colliders hand.csv "
          "--check-frames 10 --passes 1 "
          "--no-figure -o hand" +
          test::gl_flags());
  EXPECT_EQ(outcome.exit_code, 0) << outcome.standard_error;
  EXPECT_THAT(outcome.standard_error, HasSubstr("'paper' with ccd is left out"));
  EXPECT_THAT(outcome.standard_error, HasSubstr("hand.csv: 2 true events, but --events asks for 300"));
  EXPECT_THAT(outcome.standard_output, HasSubstr("paper, static"));
  const auto scene = json_in("hand/accuracy.json")["scenes"][0];
  EXPECT_EQ(scene["count"], 1);
  EXPECT_EQ(scene["truth"]["events"], 2);  // in through the back, out through the chest
  EXPECT_EQ(point(scene, "ccd", 0)["found"], 2);
}

TEST_F(AccuracyCommandLine, RefusesWhatItCannotMeasureBeforeAnyWork) {
  expect_refused("--detector cpu,magic", "magic");
  expect_refused("--detector cpu,cpu", "twice");
  expect_refused("--method ccd,later", "later");
  expect_refused("--colliders swarm,swarn", "did you mean 'swarm'");
  expect_refused("--rate 60,fast", "fast");
  expect_refused("--rate 0", "'0'");
  expect_refused("--rate 20000", "--truth-rate");
  expect_refused("--rate 60 --duration 0.001", "two frames");
  expect_refused("--duration nan", "--duration");
  expect_refused("--truth paper", "--truth");
  expect_refused("--tolerance 0", "--tolerance");
  expect_refused("--tolerance 0.01", "0.0326 ms");
  expect_refused("--keep 0", "--keep");
  expect_refused("--keep 1.5", "--keep");
  expect_refused("--events 0", "--events");
}

TEST_F(AccuracyCommandLine, APageOfWhatAnEarlierRunMissedDoesNotStay) {
  std::string with_figure = kSmall;
  with_figure.erase(with_figure.find("--no-figure"));
  ASSERT_EQ(run(with_figure + " --method static --colliders still -o a").exit_code, 0);
  EXPECT_TRUE(std::filesystem::exists(folder_ / "a/missed.html"));
  EXPECT_EQ(run(with_figure + " --method ccd --colliders still -o a").exit_code, 1) << "it is there already";
  const test::Outcome exact = run(with_figure + " --method ccd --colliders still -o a --force");
  EXPECT_EQ(exact.exit_code, 0) << exact.standard_error;
  EXPECT_THAT(exact.standard_output,
              AllOf(HasSubstr("apart from ccd, nothing is missed within"), Not(HasSubstr("missed.html"))));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "a/missed.html"));
}

TEST_F(AccuracyCommandLine, DoesNotOverwriteWithoutForce) {
  ASSERT_EQ(run("mkdir mine && echo mine > mine/run.json").exit_code, 0);
  EXPECT_EQ(run(std::string(kSmall) + "-o mine").exit_code, 1);
  EXPECT_EQ(read_text_file(folder_ / "mine/run.json"), "mine\n");
  EXPECT_FALSE(std::filesystem::exists(folder_ / "mine/accuracy.json"));
}

}  // namespace
}  // namespace vestige
