// What stands in the folder of a batch that is stopped, goes on, is split, or replaces another.

#include <gmock/gmock.h>

#include "tests/cli/maps/batch_command_line.hpp"

namespace vestige {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

using BatchCommandLine = test::BatchCommandLine;

TEST_F(BatchCommandLine, ShardsMergeIntoTheBytesOfAWholeBatch) {
  record({"a.mcap", "b.mcap", "c.mcap", "d.mcap", "e.mcap"});
  const std::string command =
      "vestige batch --maps builtin --traces a.mcap b.mcap c.mcap nowhere.mcap d.mcap e.mcap --laws binary,speed ";
  ASSERT_EQ(run(command + "-o whole").exit_code, 3);
  for (const char* shard : {"1", "2", "3"})
    ASSERT_EQ(run(command + "--shard " + shard + "/3 -o part" + shard).exit_code, shard[0] == '1' ? 3 : 0);
  const test::Outcome merge = run("vestige batch merge part3 part1 part2 -o merged");
  EXPECT_EQ(merge.exit_code, 3) << merge.standard_error;
  EXPECT_THAT(merge.standard_error, HasSubstr("nowhere"));
  expect_same_results("whole", "merged");
  EXPECT_EQ(json_in("merged/run.json")["failures"].size(), 1U);
  // Once more is no harm: the same shard twice, into the same folder.
  EXPECT_EQ(run("vestige batch merge part1 part2 part3 part1 -o merged").exit_code, 3);
  expect_same_results("whole", "merged");

  expect_failure("vestige batch merge part1 part3 -o m", 1, {"shard 2/3 is missing"}, "m");
  expect_failure("vestige batch merge part1 part2 part3 -o -", 2, {"-o -", "folder"}, "-");
  expect_failure("vestige batch merge part1 part2 part3 -o part2", 2, {"part2"});
  ASSERT_EQ(run("vestige batch --maps builtin --traces a.mcap b.mcap --laws binary --shard 2/2 -o other").exit_code, 0);
  expect_failure("vestige batch merge part1 other part3 -o m", 1, {"other", "laws", "traces"}, "m");
  expect_failure("vestige batch merge part1 nowhere -o m", 1, {"nowhere: there is no such folder"}, "m");
  expect_failure("vestige batch merge part1 a.mcap -o m", 1, {"a.mcap: is not a folder"}, "m");
  expect_failure("vestige batch merge part1 part1/items -o m", 1, {"part1/items: contains no batch"}, "m");
  ASSERT_EQ(run("cp -r part2 changed && sed -i 's/\"frames\": 100/\"frames\": 101/' changed/items/b.json").exit_code,
            0);
  expect_failure("vestige batch merge part1 part2 part3 changed -o m", 1, {"b.json", "differs"}, "m");
  ASSERT_EQ(run("cp -r part2 emptied && head -1 part2/contacts/b.csv > emptied/contacts/b.csv").exit_code, 0);
  expect_failure("vestige batch merge part1 emptied part3 -o m", 1, {"contacts/b.csv", "SHA-256"}, "m");
  ASSERT_EQ(run("cp -r part2 bare && rm bare/contacts/b.csv").exit_code, 0);
  expect_failure("vestige batch merge part1 bare part3 -o m", 1, {"contacts/b.csv", "missing"}, "m");
  ASSERT_EQ(run("cp -r part1 repainted && echo >>repainted/maps/builtin.json").exit_code, 0);
  expect_failure("vestige batch merge repainted part2 part3 -o m", 1,
                 {"repainted/maps/builtin.png or its sidecar", "SHA-256", "run the shard's command again"}, "m");
  ASSERT_EQ(run("cp -r part1 bodiless && rm bodiless/avatar.glb").exit_code, 0);
  expect_failure("vestige batch merge bodiless part2 part3 -o m", 1, {"bodiless/avatar.glb", "missing"}, "m");
  ASSERT_EQ(run("rm changed/items/b.json").exit_code, 0);
  expect_failure("vestige batch merge part1 changed part3 -o m", 1, {"b.json", "missing"}, "m");
  ASSERT_EQ(run("sed -i 's/\"complete\": true/\"complete\": false/' changed/run.json").exit_code, 0);
  expect_failure("vestige batch merge part1 changed part3 -o m", 1, {"changed", "not finished"}, "m");
}

TEST_F(BatchCommandLine, GoesOnAfterItWasKilled) {
  record({"a.mcap", "b.mcap", "c.mcap"});
  const std::vector<std::string> words = {"batch",  "--maps", "builtin", "--traces", "a.mcap",     "b.mcap", "c.mcap",
                                          "--laws", "binary", "--jobs",  "1",        "--detector", "exact"};
  std::string command = "vestige";
  for (const std::string& word : words) command += " " + word;
  ASSERT_EQ(run(command + " -o whole").exit_code, 0);
  for (const char* signal : {"KILL", "INT"}) {
    const std::string folder = std::string("killed-") + signal;
    const test::Outcome killed = run(command + " -o " + folder + " & P=$!; for i in $(seq 3000); do [ -e " + folder +
                                     "/items/a.json ] && break; sleep 0.01; done; kill -" + signal + " $P; wait $P");
    EXPECT_EQ(killed.exit_code, std::string(signal) == "KILL" ? 137 : 3) << killed.standard_error;
    EXPECT_EQ(json_in(folder + "/run.json")["complete"], false);
    ASSERT_FALSE(std::filesystem::exists(folder_ / folder / "items/c.json")) << "it was to be killed in the middle";
    EXPECT_FALSE(std::filesystem::exists(folder_ / folder / "scores.csv"));
    const auto written = std::filesystem::last_write_time(folder_ / folder / "items/a.json");
    const test::Outcome again = run(command + " -o " + folder);
    EXPECT_EQ(again.exit_code, 0) << again.standard_error;
    EXPECT_THAT(again.standard_output, HasSubstr("finished by an earlier run"));
    EXPECT_EQ(std::filesystem::last_write_time(folder_ / folder / "items/a.json"), written);
    expect_same_results("whole", folder);
    EXPECT_EQ(run("find " + folder + " -name '.*' ! -name .lock ! -path " + folder).standard_output, "") << "leftovers";
  }
}

TEST_F(BatchCommandLine, RunsAgainWhatHasChangedAndNothingElse) {
  record({"a.mcap", "b.mcap"});
  const std::string command = "vestige batch --maps builtin --traces a.mcap b.mcap --laws binary -o out";
  ASSERT_EQ(run(command).exit_code, 0);
  EXPECT_THAT(run(command).standard_output, HasSubstr("detected 0 traces once"));
  ASSERT_EQ(run("vestige record --count 5 --rate 100 --duration 1 -o b.mcap --force").exit_code, 0);
  EXPECT_THAT(run(command).standard_output, HasSubstr("detected 1 trace once"));
  EXPECT_EQ(json_in("out/run.json")["traces"][1]["colliders"], 5);

  expect_failure("vestige batch --maps builtin --traces a.mcap --laws binary -o out", 1, {"another batch", "--force"});
  EXPECT_THAT(run("vestige batch --maps builtin --traces a.mcap --laws binary -o out --force").standard_output,
              HasSubstr("detected 0 traces once, 1 score (1 trace finished by an earlier run)"));
  ASSERT_EQ(run("mkdir mine && echo precious >mine/scores.csv").exit_code, 0);
  expect_failure("vestige batch --maps builtin --traces a.mcap -o mine", 1, {"mine", "scores.csv", "--force"});
  EXPECT_EQ(read_text_file(folder_ / "mine/scores.csv"), "precious\n");
}

TEST_F(BatchCommandLine, ResultsOfAnotherVerbAreNotReplaced) {
  record({"a.mcap"});
  const std::string batch = "vestige batch --maps builtin --traces a.mcap --laws binary -o ";
  for (const std::string other : {"accuracy", "stress"}) {
    std::filesystem::create_directory(folder_ / other);
    write(other + "/" + other + ".json", "{}");
    write(other + "/run.json", "{}");
    for (const char* force : {"", " --force"})
      expect_failure(batch + other + force, 1, {other + ": holds results of 'vestige " + other, "name another folder"},
                     other + "/.lock");
    EXPECT_EQ(read_text_file(folder_ / other / "run.json"), "{}");
    EXPECT_FALSE(std::filesystem::exists(folder_ / other / "items"));
  }
  ASSERT_EQ(run(batch + "out").exit_code, 0);
  for (const std::string other : {"accuracy", "stress"})
    expect_failure("vestige " + other + " --force -o out", 1, {"out: holds results of 'vestige batch'"},
                   "out/" + other + ".json");
  EXPECT_TRUE(json_in("out/run.json").contains("batch"));
}

TEST_F(BatchCommandLine, TwoInOneFolderAreNotLetIn) {
  ASSERT_EQ(run("vestige record --count 3 --rate 100 --duration 10 -o slow.mcap").exit_code, 0);
  const std::string command = "vestige batch --maps builtin --traces slow.mcap --laws binary --detector exact -o out";
  const test::Outcome both =
      run(command + " & P=$!; for i in $(seq 1000); do [ -e out/run.json ] && break; sleep 0.01; done; " + command +
          "; echo second $?; kill -INT $P; wait $P");
  EXPECT_THAT(both.standard_output, HasSubstr("second 1"));
  EXPECT_THAT(both.standard_error, AllOf(HasSubstr("another batch is writing"), HasSubstr("process ")));
}

/// A disk of its own that is too small.
TEST_F(BatchCommandLine, AFullDiskKeepsWhatIsFinishedAndTheBatchGoesOnLater) {
  for (const char* name : {"a", "b", "c"})  // whose contacts are far larger than all else
    ASSERT_EQ(run(std::string("vestige record --count 5 --rate 1000 --duration 10 -o ") + name + ".mcap").exit_code, 0);
  const std::string command = "vestige batch --maps builtin --traces a.mcap b.mcap c.mcap --laws binary --jobs 1 -o ";
  if (run("unshare -m sh -c 'mkdir disk && mount -t tmpfs -o size=64k none disk'; rmdir disk").exit_code != 0)
    GTEST_SKIP() << "THIS SYSTEM LETS NOBODY MOUNT A DISK: A FULL ONE WAS NOT TESTED";
  ASSERT_EQ(run(command + "whole").exit_code, 0);
  // As large as all but the last contacts; then larger.
  const test::Outcome full =
      run("size=$(du -sk --apparent-size whole/avatar.glb whole/maps whole/contacts/a.csv | awk '{n += $1} END {print "
          "n + 40}')\n"
          "mkdir disk && unshare -m bash -c \"mount -t tmpfs -o size=${size}k none disk && { " +
          command + "disk/out; echo first \\$?; ls disk/out/items; mount -o remount,size=100m disk; " + command +
          "disk/out; echo again \\$?; cp -r disk/out after; }\"");
  EXPECT_THAT(full.standard_error, HasSubstr("disk is full")) << full.standard_output;
  EXPECT_THAT(full.standard_output, AllOf(HasSubstr("first 1"), HasSubstr("a.json"), HasSubstr("again 0")));
  expect_same_results("whole", "after");
}

TEST_F(BatchCommandLine, AShardWithoutAUsableTraceIsNoFailureOfTheOthers) {
  record({"a.mcap"});
  write("noise.mcap", "no trace");
  const std::string command = "vestige batch --maps builtin --traces a.mcap noise.mcap --laws binary ";
  ASSERT_EQ(run(command + "-o whole").exit_code, 3);
  ASSERT_EQ(run(command + "--shard 1/2 -o part1").exit_code, 0);
  const test::Outcome empty = run(command + "--shard 2/2 -o part2");
  EXPECT_EQ(empty.exit_code, 3) << empty.standard_error;
  EXPECT_THAT(empty.standard_error, AllOf(HasSubstr("shard 2/2"), HasSubstr("noise.mcap")));
  EXPECT_EQ(run("vestige batch merge part1 part2 -o merged").exit_code, 3);
  expect_same_results("whole", "merged");
  EXPECT_EQ(json_in("merged/run.json")["failures"], json_in("whole/run.json")["failures"]);
}

TEST_F(BatchCommandLine, RemovesItsOwnLeftoversAndNothingElse) {
  record({"a.mcap"});
  const std::string command = "vestige batch --maps builtin --traces a.mcap --laws binary -o home";
  const std::vector<std::string> others = {
      ".bashrc", ".gitignore", ".run.json.abc123", "items/.gitkeep", "items/.other.json.abc123", "traces/.b.mcap"};
  const std::vector<std::string> leftovers = {
      "items/.a.json.abc123",   "times/.a.json.ABC123",     "contacts/.a.csv.abc123", "traces/.a.mcap",
      "traces/..a.mcap.abc123", "maps/.builtin.png.abc123", "traces/.a.mcap.partial"};
  for (const char* name : {"home/items", "home/times", "home/contacts", "home/traces", "home/maps"})
    std::filesystem::create_directories(folder_ / name);
  for (const std::string& name : others) write("home/" + name, "mine");
  for (const std::string& name : leftovers) write("home/" + name, "half");
  ASSERT_EQ(run(command + " --force").exit_code, 0);
  for (const std::string& name : others) EXPECT_TRUE(std::filesystem::exists(folder_ / "home" / name)) << name;
  for (const std::string& name : leftovers) EXPECT_FALSE(std::filesystem::exists(folder_ / "home" / name)) << name;
  // Now that it is a batch's, .run.json.abc123 is its own.
  write("home/.scores.csv.abc123", "half");
  ASSERT_EQ(run(command).exit_code, 0);
  for (const char* name : {".run.json.abc123", ".scores.csv.abc123"})
    EXPECT_FALSE(std::filesystem::exists(folder_ / "home" / name)) << name;
  EXPECT_EQ(read_text_file(folder_ / "home/.gitignore"), "mine");
  EXPECT_EQ(read_text_file(folder_ / "home/.bashrc"), "mine");
}

TEST_F(BatchCommandLine, ResultsOfAnotherBatchDoNotLieBesideOneThatWasStopped) {
  record({"a.mcap"});
  ASSERT_EQ(run("vestige record --count 3 --rate 100 --duration 10 -o slow.mcap").exit_code, 0);
  const std::string command = "vestige batch --maps builtin --traces a.mcap --laws binary -o out";
  ASSERT_EQ(run(command).exit_code, 0);
  write("out/report.html", "page");
  ASSERT_EQ(run("cp -r out before").exit_code, 0);
  ASSERT_EQ(run(command).exit_code, 0);
  expect_same_results("before", "out");  // with its page
  const test::Outcome stopped =
      run("vestige batch --maps builtin --traces slow.mcap --laws binary --detector exact -o out --force & P=$!; for i "
          "in $(seq 3000); do grep -q slow out/run.json && break; sleep 0.01; done; kill -INT $P; wait $P");
  ASSERT_EQ(stopped.exit_code, 3) << stopped.standard_error;
  ASSERT_EQ(json_in("out/run.json")["complete"], false) << "it was to be stopped in the middle";
  for (const char* name : {"ranking.csv", "ranking.json", "scores.csv", "scores.json", "report.html"})
    EXPECT_FALSE(std::filesystem::exists(folder_ / "out" / name)) << name;

  // A page goes with results that have changed.
  ASSERT_EQ(run("vestige record --count 5 --rate 100 --duration 1 -o a.mcap --force").exit_code, 0);
  ASSERT_EQ(run("vestige batch --maps builtin --traces a.mcap --laws binary -o before").exit_code, 0);
  EXPECT_FALSE(std::filesystem::exists(folder_ / "before/report.html"));
}

TEST_F(BatchCommandLine, WhatItReplacesIsGone) {
  record({"a.mcap", "b.mcap"});
  write_map("mine.png");
  ASSERT_EQ(run("vestige batch --maps builtin mine.png --traces a.mcap b.mcap --laws binary -o out").exit_code, 0);
  ASSERT_EQ(run("mkdir out/figures && touch out/report.html out/figures/ranking.svg out/figures/notes.txt "
                "out/items/mine.json")
                .exit_code,
            0);
  ASSERT_EQ(run("vestige batch --maps builtin --traces a.mcap --laws binary -o out --force").exit_code, 0);
  for (const char* name :
       {"items/b.json", "times/b.json", "contacts/b.csv", "maps/mine.png", "report.html", "figures/ranking.svg"})
    EXPECT_FALSE(std::filesystem::exists(folder_ / "out" / name)) << name;
  for (const char* name :
       {"items/a.json", "times/a.json", "contacts/a.csv", "maps/builtin.png", "figures/notes.txt", "items/mine.json"})
    EXPECT_TRUE(std::filesystem::exists(folder_ / "out" / name)) << name;
}

TEST_F(BatchCommandLine, TheSidecarAndMotorsOfAnEarlierBatchAreGone) {
  record({"a.mcap"});
  write_map("mine.png");
  write("mine.json", builtin_actuator_map_json());
  write("slow.json", R"({"rise_ms": 400})");
  const std::string command = "vestige batch --maps mine.png --traces a.mcap --laws binary -o out";
  const std::vector<std::string> files = {"out/maps/mine.json", "out/actuator.json", "whole/maps/mine.json",
                                          "whole/actuator.json"};
  ASSERT_EQ(run(command + " --actuator slow.json && vestige batch merge out -o whole").exit_code, 0);
  for (const std::string& file : files) EXPECT_TRUE(std::filesystem::exists(folder_ / file)) << file;
  std::filesystem::remove(folder_ / "mine.json");
  ASSERT_EQ(run(command + " --force && vestige batch merge out -o whole --force").exit_code, 0);
  for (const std::string& file : files) EXPECT_FALSE(std::filesystem::exists(folder_ / file)) << file;
  // What cannot be removed is said: a folder that is not empty.
  std::filesystem::create_directories(folder_ / "out/actuator.json/mine");
  expect_failure(command, 1, {"out/actuator.json", "cannot be removed", "remove it"});
}

TEST_F(BatchCommandLine, ATraceWhoseContactsAreGoneIsRunAgain) {
  record({"a.mcap", "b.mcap"});
  const std::string command = "vestige batch --maps builtin --traces a.mcap b.mcap --laws binary -o out";
  ASSERT_EQ(run(command + " && cp -r out before && rm out/contacts/a.csv").exit_code, 0);
  EXPECT_THAT(run(command).standard_output, HasSubstr("detected 1 trace once"));
  expect_same_results("before", "out");
}

TEST_F(BatchCommandLine, TakesNamesThatAreNoTextAndGoesOnWithThem) {
  record({"a.mcap"});
  const std::string command =
      "cp a.mcap $(printf 'k\\374che').mcap; vestige batch --maps builtin --traces $(printf 'k\\374che').mcap --laws "
      "binary -o out";
  const test::Outcome batch = run(command);
  ASSERT_EQ(batch.exit_code, 0) << batch.standard_error;
  EXPECT_EQ(json_in("out/run.json")["traces"][0]["name"], "k_che");
  EXPECT_THAT(run(command).standard_output, HasSubstr("detected 0 traces once"));
}

TEST_F(BatchCommandLine, GoesOnWithAFolderFromBeforeLaterOptions) {
  record({"a.mcap"});
  const std::string command = "vestige batch --maps builtin --traces a.mcap --laws speed -o out";
  ASSERT_EQ(run(command).exit_code, 0);
  auto earlier = json_in("out/run.json");
  for (const char* option : {"full_speed_m_per_s", "sigma_mm", "actuator"})
    ASSERT_EQ(earlier["batch"]["options"].erase(option), 1U);
  write("out/run.json", earlier.dump());
  EXPECT_EQ(run(command).exit_code, 0);
  write("out/run.json", earlier.dump());
  expect_failure(command + " --full-speed 3", 1, {"another batch"});
}

}  // namespace
}  // namespace vestige
