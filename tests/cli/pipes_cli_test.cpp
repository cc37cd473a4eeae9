// What becomes of files and standard streams: pipes, interrupts, full disks, names that are taken.

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "tests/support/command_line.hpp"
#include "traces/files/input_file.hpp"

namespace vestige {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

class PipesAndInterrupts : public test::CommandLineTest {
 protected:
  /// Waits for so many bytes in the temporary file behind an output, which begins with its name.
  static std::string until_written(const std::string& name, int bytes = 1) {
    return "until [ -n \"$(find . -name '*" + name + "*' -size +" + std::to_string(bytes - 1) +
           "c)\" ] || ! kill -0 $P; do sleep 0.01; done; ";
  }
};

TEST_F(PipesAndInterrupts, PipesATraceFromOneVerbToTheNext) {
  record_small();
  const auto piped = json_of("vestige record --count 20 --rate 60 --duration 1 -o - -q | vestige replay - --json -");
  EXPECT_EQ(piped["texture_hash"], json_of("vestige replay small.mcap --json -")["texture_hash"]);
}

TEST_F(PipesAndInterrupts, InterruptedRecordingLeavesAValidTrace) {
  const test::Outcome outcome = run("vestige record --duration 100000 --rate 1000 --count 5 -o long.mcap & P=$!; " +
                                    until_written("long.mcap", 1000000) + "kill -INT $P; wait $P");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.standard_error;
  EXPECT_THAT(outcome.standard_error, HasSubstr("stopped after"));
  const auto inspect = json_of("vestige inspect long.mcap --json -");
  EXPECT_EQ(inspect["complete"], true);
  EXPECT_GT(inspect["messages"], 100);
}

TEST_F(PipesAndInterrupts, AnInterruptedPageOrCopyIsAFailureThatLeavesNothing) {
  ASSERT_EQ(run("vestige record -q --count 3 --rate 1000 --duration 10 -o long.mcap").exit_code, 0);
  for (const std::string verb : {"view", "viz"})
    expect_failure("vestige " + verb + " long.mcap --detector exact -o out & P=$!; " + test::interrupt(), 1,
                   {": stopped by Ctrl-C; nothing was written\n  start it again"}, "out");
}

TEST_F(PipesAndInterrupts, AClosedPipeEndsItWithoutACrash) {
  EXPECT_NE(run("{ vestige avatar; echo $? >code; } 2>&1 | true; sleep 0.2; exit $(cat code)").exit_code, 134);
  EXPECT_EQ(run("vestige avatar nowhere.glb 2>&-").exit_code, 1);
}

TEST_F(PipesAndInterrupts, WhatItSaysStaysOutOfItsFilesWhereStandardStreamsAreClosed) {
  run("vestige record --duration 0.1 -o a.mcap >&-");
  run("vestige record --duration 0.1 -o b.mcap >&- 2>&-");
  run("{ echo '{}'; echo '{\"unknown\": 1}'; echo '{}'; } | vestige record --live - -o c.mcap 2>&-");
  run("vestige record --duration 0.1 -o d.mcap <&- >&- 2>&-");
  for (const char* file : {"a.mcap", "b.mcap", "c.mcap", "d.mcap"})
    EXPECT_THAT(run(fmt::format("vestige doctor {}", file)).standard_output, HasSubstr("no problem")) << file;
  EXPECT_NE(run("vestige record --duration 0.1 -o - >&-").exit_code, 0);
}

TEST_F(PipesAndInterrupts, AnInterruptedReplayIsNotDone) {
  ASSERT_EQ(run("vestige record --count 100 --rate 1000 --duration 30 -o long.mcap").exit_code, 0);
  const test::Outcome outcome =
      run("vestige replay long.mcap --contacts c.csv & P=$!; " + until_written("c.csv") + "kill -HUP $P; wait $P");
  EXPECT_EQ(outcome.exit_code, 3) << outcome.standard_error;
  EXPECT_THAT(read_text_file(folder_ / "c.csv"), StartsWith("frame,"));
}

TEST_F(PipesAndInterrupts, ReportsAFullDiskOnStandardOutput) {
  record_small();
  expect_failure("vestige replay small.mcap >/dev/full", 1, {"standard output", "full"});
  expect_failure("vestige --help >/dev/full", 1, {"standard output"});
}

TEST_F(PipesAndInterrupts, ReportsAFullDiskAndLeavesNothingUnderTheFinalName) {
  record_small();
  // A limit on the size of files stands for the full disk: with both, write() fails midway.
  const std::string full = "trap '' XFSZ; ulimit -f 2; ";
  expect_failure(full + "vestige replay small.mcap --contacts c.csv --timeline a.csv", 1, {"c.csv"}, "c.csv");
  expect_failure(full + "vestige replay small.mcap --textures t.exr --planes actuator,t,position", 1, {"t.exr"},
                 "t.exr");
  expect_failure("trap '' XFSZ; ulimit -f 200; vestige record -o x.mcap", 1, {"x.mcap"}, "x.mcap");
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder_.path()), {}), 1) << run("ls -la").standard_output;
}

TEST_F(PipesAndInterrupts, StopsWaitingForAPipeWhenItIsTold) {
  record_small();
  ASSERT_EQ(run("mkfifo pipe && vestige export small.mcap -o poses.csv --what poses").exit_code, 0);
  const std::string interrupted = "timeout --preserve-status -s INT -k 10 1 vestige ";
  for (const char* command : {"replay small.mcap --contacts pipe", "record -o pipe"})
    expect_failure(interrupted + command, 1, {"pipe: waiting for it was stopped"});
  // A writer that stays, and says nothing more.
  expect_failure("(head -n 3 poses.csv; sleep 5) > pipe & " + interrupted + "import --poses pipe -o x.mcap", 1,
                 {"pipe: waiting for it was stopped"}, "x.mcap");
  // Nobody kept the pipe from being used: both ends open at their own time.
  const test::Outcome piped = run("(sleep 0.3; cat pipe | wc -l) & vestige replay small.mcap --contacts pipe; wait");
  EXPECT_EQ(piped.exit_code, 0) << piped.standard_error;
  EXPECT_EQ(run("(sleep 0.3; cat small.mcap > pipe) & vestige inspect pipe").exit_code, 0);
}

TEST_F(PipesAndInterrupts, NeverOverwritesWithoutForce) {
  record_small();
  expect_failure("vestige record -o small.mcap", 1, {"small.mcap", "already exists", "--force"});
  ASSERT_EQ(run("echo precious > c.csv").exit_code, 0);
  expect_failure("vestige replay small.mcap --contacts c.csv --timeline a.csv", 1, {"c.csv", "--force"}, "a.csv");
  EXPECT_EQ(read_text_file(folder_ / "c.csv"), "precious\n");
  EXPECT_EQ(run("vestige replay small.mcap --contacts c.csv --force").exit_code, 0);
}

TEST_F(PipesAndInterrupts, NeverReplacesAFileThatItReads) {
  record_small();
  const std::string trace = read_text_file(folder_ / "small.mcap");
  ASSERT_EQ(run("ln -s small.mcap link.mcap").exit_code, 0);
  expect_failure("vestige replay small.mcap --contacts small.mcap --force", 2, {"small.mcap"});
  expect_failure("vestige replay link.mcap --json small.mcap --force", 2, {"small.mcap"});
  expect_failure("vestige inspect small.mcap --json small.mcap --force", 2, {"small.mcap"});
  EXPECT_EQ(read_text_file(folder_ / "small.mcap"), trace);
}

}  // namespace
}  // namespace vestige
