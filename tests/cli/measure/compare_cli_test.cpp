// Two result folders compared, as a user asks for it. What a timing is, no test expects.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "tests/support/command_line.hpp"

namespace vestige {
namespace {

using ::testing::AllOf;
using ::testing::AnyOf;
using ::testing::HasSubstr;
using ::testing::Not;

class CompareCommandLine : public test::CommandLineTest {
 protected:
  /// A sweep of 20 passes over 10 frames, of 100 us each times `factor`.
  void write_sweep(const std::string& folder, double factor = 1) const {
    nlohmann::json json = {{"schema_version", 1},
                           {"commit", "c0ffeec0ffee"},
                           {"dirty", false},
                           {"time", "2026-11-25T12:00:00Z"},
                           {"machine", {{"processor", "Abacus"}, {"cores", 2}, {"system", "Debian"}}},
                           {"avatar", {{"vertices", 3030}, {"triangles", 4998}, {"joints", 21}}},
                           {"surface", "all"},
                           {"runs", 2},
                           {"run_frames", 5},
                           {"complete", true}};
    std::string times = "detector,context,skip,renderer,colliders,repetition,frame,us\n";
    nlohmann::json points = nlohmann::json::array();
    for (const int colliders : {1, 10}) {
      points.push_back({{"colliders", colliders},
                        {"frames", 200},
                        {"pass_frames", 10},
                        {"hz", 10000 / factor},
                        {"contacts", 3},
                        {"texture_hash", "ab"}});
      for (int frame = 0; frame < 200; ++frame)
        times += "cpu,,on,off," + std::to_string(colliders) + ",0,0," + std::to_string(100 * factor) + "\n";
    }
    json["series"] = {{{"detector", "cpu"},
                       {"context", ""},
                       {"skip", "on"},
                       {"method", "static"},
                       {"renderer", "off"},
                       {"gl", nullptr},
                       {"points", points}}};
    std::filesystem::create_directories(folder_ / folder);
    write(folder + "/sweep.json", json.dump());
    write(folder + "/frame_times.csv", times);
    ASSERT_EQ(run("zstd -qf --rm " + folder + "/frame_times.csv").exit_code, 0);
  }

  /// Changes a field of a sweep by sed's replacement.
  void change(const std::string& folder, const std::string& replacement) const {
    ASSERT_EQ(run("sed -i '" + replacement + "' " + folder + "/sweep.json").exit_code, 0);
  }
};

TEST_F(CompareCommandLine, LeavesItsInputsAsTheyAre) {
  write_sweep("a");
  write_sweep("b");
  for (const char* file : {"a/sweep.json", "b/sweep.json", "b/frame_times.csv.zst"}) {
    const test::Outcome compare = run(std::string("vestige compare a b --force --json ") + file);
    EXPECT_EQ(compare.exit_code, 2) << file;
    EXPECT_THAT(compare.standard_error, HasSubstr("would change an input file"));
  }
  EXPECT_EQ(run("vestige compare a b").exit_code, 0);
}

TEST_F(CompareCommandLine, TakesAnotherTraceForAnotherQuestionAndAnotherDecimationForAnotherPoint) {
  write_sweep("a");
  write_sweep("b");
  change("a", "s/\"runs\":2/\"runs\":2,\"sample\":{\"sha256\":\"aa\"}/");
  change("b", "s/\"runs\":2/\"runs\":2,\"sample\":{\"sha256\":\"bb\"}/");
  EXPECT_THAT(run("vestige compare a b").standard_error,
              AllOf(HasSubstr("poses and colliders of SHA-256 bb"), HasSubstr("aa")));
  write_sweep("c");
  write_sweep("d");
  change("c", "s/\"context\":/\"triangles_kept\":500,\"context\":/");
  EXPECT_THAT(run("vestige compare c d").standard_error, HasSubstr("cpu (500 triangles), skip on"));
}

TEST_F(CompareCommandLine, SaysWhatBecameSlowerAndEndsWith4) {
  write_sweep("a");
  write_sweep("b", 1.25);
  const test::Outcome compare = run("vestige compare a b --json c.json");
  EXPECT_EQ(compare.exit_code, 4) << compare.standard_error;
  EXPECT_EQ(compare.standard_error, "");
  EXPECT_THAT(compare.standard_output, AllOf(HasSubstr("A: a, commit c0ffeec0ff, 2026-11-25T12:00:00Z\n"),
                                             HasSubstr("cpu, skip on, 10 colliders"),
                                             HasSubstr("2 points: 2 slower, 0 faster, 0 same, 0 unclear")));
  const auto json = json_in("c.json");
  EXPECT_EQ(json["threshold_percent"], 6);
  EXPECT_EQ(json["a"]["folder"], "a");
  EXPECT_EQ(json["counts"]["slower"], 2);
  const auto& point = json["points"][0];
  EXPECT_EQ(point["name"], "cpu, skip on, 1 collider");
  EXPECT_EQ(point["verdict"], "slower");
  EXPECT_NEAR(point["ratio"].get<double>(), 0.8, 1e-9);
  EXPECT_NEAR(point["hz_b"].get<double>(), 8000, 1e-6);
  EXPECT_LT(point["low"], 0.8);
  EXPECT_GT(point["high"], 0.8);
}

TEST_F(CompareCommandLine, EndsWith0IfNothingBecameSlower) {
  write_sweep("a");
  write_sweep("b", 0.8);
  write_sweep("c", 1.25);
  EXPECT_THAT(run("vestige compare a b").standard_output, HasSubstr("2 points: 0 slower, 2 faster"));
  EXPECT_EQ(run("vestige compare a b").exit_code, 0);
  const test::Outcome coarse = run("vestige compare a c --threshold 30");
  EXPECT_EQ(coarse.exit_code, 0);
  EXPECT_THAT(coarse.standard_output, HasSubstr("0 slower, 0 faster, 2 same, 0 unclear (by more than 30 %)"));
  EXPECT_EQ(run("vestige compare a c -q").standard_output, "");
  EXPECT_EQ(run("vestige compare a c -q").exit_code, 4);
}

TEST_F(CompareCommandLine, ComparesEverySweepBelowTwoFolders) {
  for (const char* folder : {"a/sweep", "a/hug", "b/hug", "b/skip/rain"}) write_sweep(folder);
  const test::Outcome compare = run("vestige compare a b -v --json c.json");
  EXPECT_EQ(compare.exit_code, 0) << compare.standard_error;
  EXPECT_THAT(compare.standard_output, AllOf(HasSubstr("hug: cpu, skip on, 1 collider "),
                                             HasSubstr("not compared: 2 points only in A, 2 points only in B\n"),
                                             HasSubstr("only in B: skip/rain: cpu, skip on, 10 colliders\n")));
  EXPECT_EQ(json_in("c.json")["only_a"][0], "sweep: cpu, skip on, 1 collider");
}

TEST_F(CompareCommandLine, RefusesOtherMachinesUnlessAskedTo) {
  write_sweep("a");
  write_sweep("b");
  change("b", "s/Abacus/Slide rule/");
  expect_failure("vestige compare a b --json c.json", 1,
                 {"b/sweep.json", "another machine", "Slide rule", "Abacus", "--across-machines"}, "c.json");
  const test::Outcome across = run("vestige compare a b --across-machines");
  EXPECT_EQ(across.exit_code, 0) << across.standard_error;
  EXPECT_THAT(across.standard_output, HasSubstr("machine: Abacus, 2 cores -> Slide rule, 2 cores\n"));
}

TEST_F(CompareCommandLine, RefusesWhatIsNoPairOfRuns) {
  write_sweep("a");
  write_sweep("b");
  const auto refuses = [&](const std::string& arguments, const std::vector<std::string>& words) {
    expect_failure("vestige compare " + arguments + " --json c.json", 1, words, "c.json");
  };
  const auto refuses_changed = [&](const std::string& replacement, const std::vector<std::string>& words) {
    write_sweep("b");
    change("b", replacement);
    refuses("a b", words);
  };
  ASSERT_EQ(run("mkdir -p empty/below").exit_code, 0);
  refuses("a empty", {"empty: holds no sweep.json", "vestige sweep -o"});
  refuses("a nowhere", {"nowhere: does not exist"});
  refuses("a a/sweep.json", {"a/sweep.json: is not a folder"});
  refuses("a ./a/", {"is the folder that it is to be compared with"});
  refuses_changed("s/\"schema_version\":1/\"schema_version\":2/", {"b/sweep.json: has schema_version 2", "has 1"});
  refuses_changed("s/\"run_frames\":5/\"run_frames\":6/", {"run_frames 6", "with 5"});
  refuses_changed("s/4998/5000/", {"avatar.triangles 5000", "with 4998"});
  refuses_changed("s/\"surface\":\"all\"/\"surface\":\"mapped\"/", {"surface \"mapped\""});
  refuses_changed("s/\"complete\":true/\"complete\":false/", {"b/sweep.json: is of a sweep that was stopped early"});
  refuses_changed("s/\"detector\":\"cpu\"/\"detector\":\"gpu\"/", {"no point in common"});
  refuses_changed("s/\"pass_frames\":10/\"pass_frames\":20/", {"20 frames in a pass, but 10"});
  refuses_changed("s/\"pass_frames\":10/\"pass_frames\":201/", {"series[0].points[0].pass_frames is more than frames"});
  refuses_changed("s/\"frames\":200/\"frames\":-1/", {"series[0].points[0].frames is -1"});
  refuses_changed("s/\"frames\":200/\"frames\":2.5/", {"is not a whole number"});
  refuses_changed("s/\"frames\":200/\"frames\":201/", {"frame_times.csv.zst: ends before the last frame"});
  refuses_changed("s/\"frames\":200/\"frames\":199/", {"frame_times.csv.zst, line ", "is of no point"});
  refuses_changed("s/\"colliders\":10/\"colliders\":1/", {"'cpu, skip on, 1 collider' a second time"});
  refuses_changed("s/\"series\"/\"cereals\"/", {"the field series is missing"});
  refuses_changed("s/$/]/", {"b/sweep.json, byte ", "is not JSON"});
  refuses_changed("s/.*/[]/", {"is not a JSON object"});
}

TEST_F(CompareCommandLine, RefusesFrameTimesThatAreMissingOrDamaged) {
  write_sweep("a");
  write_sweep("b");
  const auto refuses = [&](const std::vector<std::string>& words) { expect_failure("vestige compare a b", 1, words); };
  ASSERT_EQ(
      run("zstd -qdc b/frame_times.csv.zst | sed '7s/100/-1/' >x && zstd -qf x -o b/frame_times.csv.zst").exit_code, 0);
  refuses({"b/frame_times.csv.zst, line 7: '-1.000000' is no duration"});
  ASSERT_EQ(run("truncate -s 20 b/frame_times.csv.zst").exit_code, 0);
  refuses({"b/frame_times.csv.zst: holds nothing that zstd can expand"});
  ASSERT_EQ(run("head -100 x >y && zstd -qf y -o b/frame_times.csv.zst").exit_code, 0);
  refuses({"b/frame_times.csv.zst", "line 7"});
  ASSERT_EQ(run("sed 's/-1/1/' y >x && zstd -qf x -o b/frame_times.csv.zst").exit_code, 0);
  refuses({"b/frame_times.csv.zst: ends before the last frame of 'cpu, skip on, 1 collider'"});
  ASSERT_EQ(run("sed 's/,us$/,ns/' x >y && zstd -qf y -o b/frame_times.csv.zst").exit_code, 0);
  refuses({"b/frame_times.csv.zst, line 1: the last column is not 'us'"});
  ASSERT_EQ(run("rm b/frame_times.csv.zst").exit_code, 0);
  refuses({"b/frame_times.csv.zst: is missing"});
}

TEST_F(CompareCommandLine, WarnsOfContactsThatChangedAndOfTooFewPasses) {
  write_sweep("a");
  write_sweep("b");
  change("b", "s/\"texture_hash\":\"ab\"/\"texture_hash\":\"cd\"/2");
  EXPECT_THAT(run("vestige compare a b").standard_error, HasSubstr("warning: at 1 of 2 points the contacts differ"));
  for (const char* folder : {"a", "b"}) change(folder, "s/\"pass_frames\":10/\"pass_frames\":50/g");
  const test::Outcome few = run("vestige compare a b --json -");
  EXPECT_EQ(few.exit_code, 0);
  EXPECT_THAT(few.standard_error, HasSubstr("at 2 of 2 points a frame was repeated fewer than 8 times"));
  const auto json = nlohmann::json::parse(few.standard_output);
  EXPECT_EQ(json["points"][0]["verdict"], "unclear");
  EXPECT_TRUE(json["points"][0]["low"].is_null());
}

TEST_F(CompareCommandLine, ReadsWhatSweepWrites) {
  record_small();
  for (const char* folder : {"a", "b"})
    ASSERT_EQ(run(std::string("vestige sweep small.mcap --detector cpu --skip off,on --counts 1,20 --min-time 0.02 "
                              "--runs 2 --run-frames 5 --no-figure -q -o ") +
                  folder)
                  .exit_code,
              0);
  const test::Outcome compare = run("vestige compare a b --json -");
  EXPECT_THAT(compare.exit_code, AnyOf(0, 4)) << compare.standard_error;
  EXPECT_THAT(compare.standard_error, Not(HasSubstr("contacts differ")));
  const auto json = nlohmann::json::parse(compare.standard_output);
  ASSERT_EQ(json["points"].size(), 4U);
  for (const auto& point : json["points"]) {
    EXPECT_TRUE(point["same_answers"]) << point["name"];
    EXPECT_GT(point["ratio"], 0);
  }
}

}  // namespace
}  // namespace vestige
