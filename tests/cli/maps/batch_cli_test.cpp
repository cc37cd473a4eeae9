// What batches make of maps and traces, and what they say of them.

#include <gmock/gmock.h>

#include <map>

#include "tests/cli/maps/batch_command_line.hpp"

namespace vestige {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

using BatchCommandLine = test::BatchCommandLine;

TEST_F(BatchCommandLine, ScoresEveryMapAndLawOnContactsThatAreDetectedOnce) {
  record({"a.mcap", "b.mcap"});
  write_map("mine.png");
  const test::Outcome batch =
      run("vestige batch --maps builtin mine.png --traces a.mcap b.mcap --laws binary,phantom -o out");
  ASSERT_EQ(batch.exit_code, 0) << batch.standard_error;
  EXPECT_THAT(batch.standard_output, AllOf(HasSubstr("detected 2 traces once, 8 scores"), HasSubstr("rank"),
                                           HasSubstr("phantom"), HasSubstr("only 2 files")));
  const auto scores = json_in("out/scores.json");
  EXPECT_EQ(scores["schema_version"], 1);
  ASSERT_EQ(scores["scores"].size(), 8U);
  EXPECT_GT(scores["metrics"].size(), 3U);
  for (const auto& metric : scores["metrics"]) {
    EXPECT_TRUE(metric["model_based"].is_boolean());
    EXPECT_NE(metric["formula"], "");
    EXPECT_TRUE(scores["scores"][0]["values"].contains(metric["name"]));
  }
  EXPECT_EQ(run("head -1 out/scores.csv | cut -d, -f1-3").standard_output, "map,trace,law\n");
  EXPECT_EQ(run("wc -l <out/scores.csv").standard_output, "9\n");
  EXPECT_EQ(run("wc -l <out/ranking.csv").standard_output, "5\n");
  const auto ranking = json_in("out/ranking.json");
  ASSERT_EQ(ranking["ranking"].size(), 4U);
  EXPECT_EQ(ranking["ranking"][0]["rank"], 1);
  EXPECT_TRUE(ranking["ranking"][0]["headline"]["mean"].is_number());

  const auto run_json = json_in("out/run.json");
  EXPECT_EQ(run_json["complete"], true);
  EXPECT_EQ(run_json["batch"]["maps"][1]["given"], "mine.png");
  EXPECT_EQ(run_json["traces"][1]["sha256"], run("sha256sum b.mcap | cut -c1-64").standard_output.substr(0, 64));
  EXPECT_GT(run_json["totals"]["detection_s"], 0);
  EXPECT_EQ(run_json["failures"].size(), 0U);

  // The contacts are those that replay finds.
  EXPECT_EQ(run("vestige replay a.mcap -q --contacts replay.csv && cut -d, -f1-9 replay.csv >expected && "
                "grep -v ',,' out/contacts/a.csv | cut -d, -f1-9 >found && cmp expected found")
                .exit_code,
            0);
  EXPECT_EQ(run("cmp mine.png out/maps/mine.png && vestige avatar out/avatar.glb").exit_code, 0);
}

TEST_F(BatchCommandLine, JudgesLawsUnderWhichSpheresAreFeltAndReportsThem) {
  const test::Outcome batch =
      run("vestige batch --maps torso40 paper6 --traces rest --count 12 --laws depth,patch --rate 100 --duration 2 -o "
          "out -q");
  ASSERT_EQ(batch.exit_code, 0) << batch.standard_error;
  EXPECT_EQ(run("head -1 out/contacts/rest.csv").standard_output,
            "frame,time_s,collider,triangle,t,u,v,texture_u,texture_v,side,speed_m_per_s,depth_m,covered\n");
  const auto scores = json_in("out/scores.json")["scores"];
  ASSERT_EQ(scores.size(), 4U);
  for (const auto& one : scores)
    if (one["map"] == "torso40") {
      EXPECT_GT(one["values"]["coverage"], 0) << one["law"];
    }

  // Whom a sphere covers by half a step of the duty, a replay makes vibrate.
  ASSERT_EQ(run("vestige record --colliders rest --count 12 --map torso40 --rate 100 --duration 2 -o rest.mcap -q && "
                "vestige replay rest.mcap --law patch --timeline t.csv --hold 0 -q")
                .exit_code,
            0);
  const std::string vibrate = run("tail -n +2 t.csv | cut -d, -f2- | tr , '\n' | grep -vcx 0").standard_output;
  EXPECT_GT(std::stoi(vibrate), 20);
  EXPECT_EQ(run("awk -F, '{split($13, covered, \" \"); for (i in covered) print $1 \":\" covered[i]}' "
                "out/contacts/rest.csv | awk -F: '$2 == \"torso40\" && $4 >= 0.01 / 510 {print $1, $3}' | "
                "sort -u | wc -l")
                .standard_output,
            vibrate);

  const test::Outcome report = run("vestige plot report out -o page");
  ASSERT_EQ(report.exit_code, 0) << report.standard_error;
  EXPECT_TRUE(std::filesystem::exists(folder_ / "page/figures/torso40-timeline-patch.svg"));
  ASSERT_EQ(run("sed -i 's/torso40:[0-9]*:/torso40:99:/' out/contacts/rest.csv").exit_code, 0);
  const test::Outcome refused = run("vestige plot report out -o again");
  EXPECT_EQ(refused.exit_code, 1);
  EXPECT_THAT(refused.standard_error, HasSubstr("names actuator 99 of torso40, which has only 40"));
}

// The report has a page for each of the best three maps, on the trace in which it does worst, if that is still there.
TEST_F(BatchCommandLine, ItsReportShowsTheBestMapsInMotion) {
  record({"mine.mcap"});
  const test::Outcome batch =
      run("vestige batch --maps paper6 torso16 torso40 body --traces slide swarm mine.mcap --count 30 --laws "
          "gaussian,speed "
          "--sigma 40 --rate 200 --duration 0.5 -o out -q");
  ASSERT_EQ(batch.exit_code, 0) << batch.standard_error;
  const auto best = json_in("out/ranking.json")["ranking"][0];
  const std::string map = best["map"];
  const std::string metric = json_in("out/ranking.json")["rank_by"];
  std::map<double, std::string> traces;  // by how well they do
  const auto scores = json_in("out/scores.json")["scores"];
  for (const auto& one : scores)
    if (one["map"] == map && one["law"] == best["law"] && one["values"][metric].is_number())
      traces[one["values"][metric].get<double>()] = one["trace"];
  ASSERT_EQ(traces.size(), 3U) << "lower is better";
  const auto report = [&](const std::string& top) {
    const test::Outcome drawn = run("vestige plot report out -q --force --top " + top);
    EXPECT_EQ(drawn.exit_code, 0) << drawn.standard_error;
    EXPECT_EQ(drawn.standard_error, "");
    return read_text_file(folder_ / "out/report.html");
  };
  const auto link_to = [&](const std::string& trace) {
    return "<a href=\"figures/" + map + "+" + trace + ".html\">Watch it move</a>: the trace <strong>" + trace;
  };
  const std::string worst = traces.rbegin()->second;
  const std::string text = report("4");
  EXPECT_THAT(text, HasSubstr(link_to(worst)));
  EXPECT_EQ(run("grep -o 'Watch it move' out/report.html | wc -l").standard_output, "3\n");
  const std::string page = read_text_file(folder_ / ("out/figures/" + map + "+" + worst + ".html"));
  EXPECT_THAT(page, AllOf(HasSubstr("<title>" + worst), HasSubstr("\"map " + map), HasSubstr("hold 60 ms")));

  ASSERT_EQ(run("rm -f out/traces/" + worst + ".mcap; [ -e " + worst + ".mcap ] && cp out/traces/slide.mcap " + worst +
                ".mcap; true")
                .exit_code,
            0);
  EXPECT_THAT(report("1"), AllOf(Not(HasSubstr(link_to(worst))), HasSubstr(link_to(std::next(traces.rbegin())->second)),
                                 HasSubstr("if " + worst + " is left out")));
  EXPECT_FALSE(std::filesystem::exists(folder_ / ("out/figures/" + map + "+" + worst + ".html")))
      << "of the page before";
}

TEST_F(BatchCommandLine, GivesAllThatIsNeededToRecomputeTheRankingElsewhere) {
  ASSERT_EQ(run("vestige batch --maps builtin torso40 --traces hug slide --seeds 1:6 --laws binary,phantom "
                "--rate 100 --duration 0.5 --unfelt-mm 150 -o out -q")
                .exit_code,
            0);
  EXPECT_EQ(run("head -1 out/scores.csv | cut -d, -f1-6").standard_output, "map,trace,law,scenario,seed,contacts\n");
  const test::Outcome same =
      run("python3 " VESTIGE_SOURCE_DIR "/tests/cli/maps/recompute_ranking.py out error_with_unfelt_mm lower");
  EXPECT_EQ(same.exit_code, 0) << same.standard_output << same.standard_error;
  EXPECT_EQ(same.standard_output, "4 candidates agree\n");
}

TEST_F(BatchCommandLine, RecordsScenariosItself) {
  const std::string command =
      "vestige batch --maps builtin --traces slide hug --laws binary --rate 100 --duration 0.5 ";
  ASSERT_EQ(run(command + "-o one").exit_code, 0);
  const auto items = json_in("one/run.json")["traces"];
  EXPECT_EQ(items[0]["frames"], 50);
  EXPECT_EQ(items[1]["colliders"], 100);
  EXPECT_EQ(run("vestige replay one/traces/hug.mcap -q").exit_code, 0);
  ASSERT_EQ(run(command + "-o two --jobs 1").exit_code, 0);
  expect_same_results("one", "two");
}

TEST_F(BatchCommandLine, OneBadInputDoesNotStopTheRest) {
  record({"a.mcap", "b.mcap"});
  ASSERT_EQ(run("head -c 2000 /dev/urandom >noise.mcap && echo text >text.png && cp b.mcap cut.mcap && "
                "truncate -s -3000 cut.mcap && vestige avatar builtin -o man.glb --map-output grey.png && "
                "echo '{\"actuators\": [{\"grey\": 1, \"name\": \"one\"}]}' >grey.json")
                .exit_code,
            0);
  ASSERT_EQ(
      run("vestige record --avatar '" + test::data("avatars/avatars/CesiumMan.glb").string() +
          "' --rate 50 --duration 0.2 -o stranger.mcap || vestige record --rate 50 --duration 0.2 -o stranger.mcap")
          .exit_code,
      0);
  const test::Outcome batch =
      run("vestige batch --maps text.png builtin grey.png nowhere.png --traces noise.mcap a.mcap stranger.mcap "
          "nowhere.mcap "
          "cut.mcap b.mcap --laws binary -o out");
  EXPECT_EQ(batch.exit_code, 3) << batch.standard_error;
  const auto json = json_in("out/run.json");
  EXPECT_EQ(json["complete"], true);
  std::map<std::string, std::string> cause;
  for (const auto& failure : json["failures"]) {
    cause[failure["given"]] = failure["cause"];
    EXPECT_NE(failure["remedy"], "") << failure;
    EXPECT_THAT(batch.standard_output, HasSubstr(failure["given"].get<std::string>()));
  }
  EXPECT_THAT(cause["text.png"], HasSubstr("PNG"));
  EXPECT_THAT(cause["grey.png"], HasSubstr("sidecar does not list"));
  EXPECT_THAT(cause["nowhere.png"], HasSubstr("nowhere.png"));
  EXPECT_THAT(cause["noise.mcap"], HasSubstr("noise.mcap"));
  EXPECT_THAT(cause["nowhere.mcap"], HasSubstr("nowhere.mcap"));
  EXPECT_FALSE(cause.contains("a.mcap"));
  if (std::filesystem::exists(test::data("avatars/avatars/CesiumMan.glb"))) {
    EXPECT_THAT(cause["stranger.mcap"], HasSubstr("another avatar"));
  }
  // A trace that was cut off is scored as far as it goes, and said.
  EXPECT_FALSE(cause.contains("cut.mcap"));
  EXPECT_THAT(batch.standard_error, HasSubstr("cut.mcap"));
  EXPECT_THAT(run("cut -d, -f1-3 out/scores.csv").standard_output,
              AllOf(HasSubstr("builtin,a,binary\n"), HasSubstr("builtin,b,binary\n"), HasSubstr("builtin,cut,binary\n"),
                    Not(HasSubstr("noise")), Not(HasSubstr("grey"))));
  expect_failure("vestige batch --maps text.png --traces a.mcap -o none", 1, {"none of the maps", "PNG"}, "none");
  expect_failure("vestige batch --maps builtin --traces noise.mcap -o none", 1, {"noise.mcap"}, "none");
}

TEST_F(BatchCommandLine, JudgesWithMotorsAndWithoutAndWithTheLawsParameters) {
  record({"a.mcap", "b.mcap"});
  const std::string command = "vestige batch --maps builtin --traces a.mcap b.mcap --laws speed,gaussian ";
  write("slow.json", R"({"rise_ms": 400, "fall_ms": 400})");
  ASSERT_EQ(run(command + "-o ideal").exit_code, 0);
  ASSERT_EQ(run(command + "--actuator slow.json -o slow").exit_code, 0);
  ASSERT_EQ(run(command + "--full-speed 3 -o faster").exit_code, 0);
  ASSERT_EQ(run(command + "--sigma 5 -o sharper").exit_code, 0);
  const auto score = [&](const std::string& folder, std::size_t law, const char* metric) {
    return json_in(folder + "/scores.json")["scores"][law]["values"][metric];
  };
  EXPECT_GT(score("slow", 0, "onset_error_ms"), score("ideal", 0, "onset_error_ms"));
  EXPECT_NE(score("faster", 0, "mean_duty"), score("ideal", 0, "mean_duty"));
  EXPECT_EQ(score("faster", 1, "mean_duty"), score("ideal", 1, "mean_duty"));
  EXPECT_NE(score("sharper", 1, "mean_duty"), score("ideal", 1, "mean_duty"));
  EXPECT_EQ(json_in("slow/run.json")["batch"]["options"]["actuator"]["given"], "slow.json");
  // The page needs nothing but the folder.
  std::filesystem::remove(folder_ / "slow.json");
  if (std::filesystem::exists(VESTIGE_BIN_DIR "/vestige-plot")) {
    ASSERT_EQ(run("vestige plot report slow").exit_code, 0);
    EXPECT_EQ(run("grep -c 'of the motors in slow.json' slow/report.html").standard_output, "1\n");
  }

  // In shards too, and another model is another batch.
  write("slow.json", R"({"rise_ms": 400, "fall_ms": 400})");
  for (const char* shard : {"1", "2"})
    ASSERT_EQ(run(command + "--actuator slow.json --shard " + shard + "/2 -o part" + shard).exit_code, 0);
  ASSERT_EQ(run("vestige batch merge part1 part2 -o merged").exit_code, 0);
  EXPECT_EQ(run("diff -r --exclude=run.json --exclude=times --exclude=.lock --exclude=report.html "
                "--exclude=figures slow merged")
                .standard_output,
            "");
  write("slow.json", R"({"rise_ms": 300})");
  const test::Outcome again = run(command + "--actuator slow.json -o slow");
  EXPECT_EQ(again.exit_code, 0) << again.standard_error;
  EXPECT_NE(score("slow", 0, "onset_error_ms"), score("merged", 0, "onset_error_ms"));

  write("named.json", R"({"actuators": [{"name": "nobody", "rise_ms": 80}]})");
  expect_failure(command + "--actuator named.json -o none", 1, {"nobody"}, "none");
  expect_failure(command + "--actuator missing.json -o none", 1, {"missing.json"}, "none");
  expect_failure("vestige batch --maps builtin --traces a.mcap --laws binary --sigma 5 -o none", 2,
                 {"--sigma", "gaussian"}, "none");
}

TEST_F(BatchCommandLine, WithOneFileSaysNothingOfHowMapsCompare) {
  record({"a.mcap"});
  const test::Outcome batch = run("vestige batch --maps builtin --traces a.mcap --laws binary,phantom -o out");
  ASSERT_EQ(batch.exit_code, 0) << batch.standard_error;
  EXPECT_THAT(batch.standard_output, AllOf(HasSubstr("no intervals, and no '=': there is only 1 file"),
                                           Not(HasSubstr("\n=")), Not(HasSubstr("95 %"))));
  EXPECT_EQ(run("grep -c ',,there is only 1 file' out/ranking.csv").standard_output, "2\n");
  EXPECT_TRUE(json_in("out/ranking.json")["interval"].is_null());
  EXPECT_THAT(json_in("out/ranking.json")["why_no_intervals"].get<std::string>(), HasSubstr("only 1 file"));
}

TEST_F(BatchCommandLine, RecordsEachScenarioWithEachSeedAndTellsMapsApart) {
  const std::string command =
      "vestige batch --maps paper6 torso40 --traces slide punch --laws binary,phantom --rate 100 --duration 0.5 ";
  const test::Outcome batch = run(command + "--seeds 1:8 -o out");
  ASSERT_EQ(batch.exit_code, 0) << batch.standard_error;
  EXPECT_THAT(batch.standard_output,
              AllOf(HasSubstr("mean over the traces of 2 scenarios x 8 seeds and its 95 % interval"),
                    HasSubstr("p_holm"), Not(HasSubstr("no intervals"))));
  // Each is what record makes of that seed.
  ASSERT_EQ(run("vestige record --colliders punch --seed 3 --rate 100 --duration 0.5 -q -o punch.mcap && "
                "vestige replay punch.mcap -q --contacts replay.csv && cut -d, -f1-9 replay.csv >expected")
                .exit_code,
            0);
  EXPECT_EQ(run("grep -v ',,' out/contacts/punch-3.csv | cut -d, -f1-9 | cmp - expected").exit_code, 0);
  const auto ranking = json_in("out/ranking.json");
  EXPECT_EQ(ranking["traces"], 16);
  EXPECT_EQ(ranking["over"], "2 scenarios x 8 seeds");
  for (const auto& one : ranking["ranking"]) {
    EXPECT_LE(one["headline"]["low"], one["headline"]["mean"]);
    EXPECT_LE(one["headline"]["mean"], one["headline"]["high"]);
    EXPECT_LE(one["difference_from_best"]["p"], one["difference_from_best"]["p_holm"]);
  }
  EXPECT_EQ(ranking["ranking"].back()["map"], "paper6");
  EXPECT_EQ(ranking["ranking"].back()["distinguishable_from_best"], true);
  ASSERT_EQ(ranking["by_scenario"].size(), 2U);
  EXPECT_EQ(ranking["by_scenario"][1]["scenario"], "punch");
  EXPECT_EQ(run("wc -l <out/ranking_by_scenario.csv").standard_output, "9\n");

  // In shards too: what a scenario's traces are is known to all of them.
  for (const char* shard : {"1", "2"})
    ASSERT_EQ(run(command + "--seeds 1:8 --shard " + shard + "/2 -o part" + shard).exit_code, 0);
  ASSERT_EQ(run("vestige batch merge part1 part2 -o merged").exit_code, 0);
  expect_same_results("out", "merged");

  EXPECT_THAT(run(command + "-o one").standard_output, HasSubstr("each scenario was recorded with one seed"));
}

TEST_F(BatchCommandLine, WarnsOfWhatIsOddAboutAMap) {
  record({"a.mcap", "b.mcap"});
  write("fine.json", R"({"regions": [{"name": "v", "part": "vest", "grid": {"rows": 9, "columns": 8}}]})");
  // Without its sidecar, so many greys look like an editor's soft edges.
  ASSERT_EQ(run("vestige map make --regions fine.json -o many.png && rm many.json").exit_code, 0);
  const std::string command = "vestige batch --maps builtin many.png --traces a.mcap b.mcap --laws binary ";
  for (const char* part : {"-o whole", "--shard 1/2 -o part1", "--shard 2/2 -o part2"}) {
    const test::Outcome batch = run(command + part);
    EXPECT_EQ(batch.exit_code, 0) << batch.standard_error;
    EXPECT_THAT(batch.standard_error, AllOf(HasSubstr("map 'many'"), HasSubstr("grey levels"))) << part;
  }
  EXPECT_THAT(run("vestige batch merge part1 part2 -o merged").standard_error, HasSubstr("map 'many'"));
  for (const char* run_json : {"whole/run.json", "merged/run.json"}) {
    const auto maps = json_in(run_json)["maps"];
    EXPECT_EQ(maps[0]["warnings"].size(), 0U);
    EXPECT_EQ(maps[1]["name"], "many");
    EXPECT_THAT(maps[1]["warnings"][0].get<std::string>(), HasSubstr("grey levels"));
    EXPECT_FALSE(json_in(run_json)["batch"]["maps"][1].contains("warnings")) << "they are no part of what is run";
  }
}

TEST_F(BatchCommandLine, WarnsOfMapsThatMapCheckRejects) {
  record({"a.mcap", "b.mcap"});
  ASSERT_EQ(run("vestige map make --layout torso16 -o far.png && "
                "sed -i -E 's/\"position_m\":\\[-?/\"position_m\":[9/' far.json")
                .exit_code,
            0);
  const test::Outcome batch = run("vestige batch --maps far.png torso16 --traces a.mcap b.mcap --laws phantom -o out");
  EXPECT_EQ(batch.exit_code, 0);
  EXPECT_THAT(batch.standard_error, AllOf(HasSubstr("map 'far': actuator"), HasSubstr("its position_m is"),
                                          HasSubstr("and 13 more problems; 'vestige map check' lists them")));
  EXPECT_THAT(batch.standard_error, Not(HasSubstr("map 'torso16'")));
}

TEST_F(BatchCommandLine, TracesOfLikeNamesKeepTheirFilesApart) {
  record({"a.mcap", "a.run.mcap"});
  const std::string command = "vestige batch --maps builtin --traces a.mcap a.run.mcap --laws binary -o out";
  ASSERT_EQ(run(command).exit_code, 0);
  EXPECT_THAT(run(command).standard_output, HasSubstr("2 traces finished by an earlier run"));
  EXPECT_EQ(run("vestige batch merge out -o merged").exit_code, 0);
}

TEST_F(BatchCommandLine, WarnsOfARateThatMustBeAMistake) {
  EXPECT_THAT(run("timeout --preserve-status -s INT 1 vestige batch --maps builtin --traces hug --rate 1e8 -o out")
                  .standard_error,
              HasSubstr("200000000 frames will take long"));
}

TEST_F(BatchCommandLine, RefusesWhatWouldDoNothing) {
  record({"a.mcap"});
  const std::string command = "vestige batch --maps builtin --traces a.mcap -o none ";
  expect_failure(command + "--rate 100", 2, {"--rate", "scenario"}, "none");
  expect_failure(command + "--seeds 1:3", 2, {"--seeds", "scenario"}, "none");
  expect_failure(command + "--surface mapped", 2, {"--surface"}, "none");
  expect_failure(command + "--laws binary,magic", 2, {"magic", "phantom"}, "none");
  expect_failure(command + "--rank-by beauty", 2, {"beauty", "coverage"}, "none");
  expect_failure(command + "--shard 2/2", 2, {"--shard"}, "none");
  expect_failure(command + "--shard 0/1", 2, {"--shard", "0/1"}, "none");
  expect_failure("vestige batch --maps builtin builtin --traces a.mcap -o none", 2, {"--maps", "twice"}, "none");
  expect_failure("vestige batch --maps builtin -o none", 2, {"--traces"}, "none");
  // Commas separate, as in other lists; a file may have one in its name.
  expect_failure("vestige batch --maps paper6,papr6 --traces swarm,hug -o none", 2,
                 {"papr6: there is no such file", "did you mean 'paper6'?"}, "none");
  expect_failure("vestige batch --maps paper6 --traces swarm,hug,swarm -o none", 2,
                 {"--traces", "'swarm' is given twice"}, "none");
  expect_failure("vestige batch --maps paper6, --traces swarm -o none", 2, {"--maps", "'paper6,'"}, "none");
  expect_failure("touch a,b && vestige batch --maps paper6 --traces a,b a,b -o none", 2, {"'a,b' is given twice"},
                 "none");
  expect_failure("vestige batch --maps builtin --traces a.mcap -o -", 2, {"-o -", "folder"}, "-");
  expect_failure("vestige batch --maps builtin --traces swarn -o none", 2,
                 {"swarn: there is no such file", "did you mean 'swarm'?"}, "none");
  expect_failure("vestige batch --maps papr6 --traces a.mcap -o none", 2,
                 {"papr6: there is no such file", "did you mean 'paper6'?"}, "none");
  expect_failure("vestige batch --maps builtin --traces nowhere.mcap -o none", 1, {"nowhere.mcap"}, "none");
  const std::string scenario = "vestige batch --maps builtin --traces slide -o none ";
  expect_failure(scenario + "--seeds 5:1", 2, {"--seeds", "ends below its start"}, "none");
  expect_failure(scenario + "--seeds x", 2, {"--seeds", "whole numbers"}, "none");
  expect_failure(scenario + "--seeds 1:2000", 2, {"2000 seeds", "at most 1000"}, "none");
  expect_failure(scenario + "--duration 1e300", 2, {"at most 4294967295"}, "none");
  expect_failure(scenario + "--rate 1e9 --duration 100", 2, {"at most 4294967295"}, "none");
  expect_failure(scenario + "--rate 1e300", 2, {"--rate", "0.001 to 1000000000"}, "none");
  expect_failure("vestige batch --maps builtin merge a b -o none", 2, {"--maps", "merge"}, "none");
  expect_failure("vestige batch slurm --shards 2 --maps builtin --traces a.mcap -o none", 2,
                 {"--shards: 2 shards for 1 trace: ", "at most 1 shard"}, "none");
}

}  // namespace
}  // namespace vestige
