// What happens to trace files, as a user sees it: doctor, recover, recompress, trim, merge, cat.

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/support/command_line.hpp"

namespace vestige {
namespace {

using ::testing::HasSubstr;

class Files : public test::CommandLineTest {
 protected:
  void SetUp() override { ASSERT_EQ(run("vestige record --count 20 --rate 100 --duration 1 -o a.mcap").exit_code, 0); }
  std::string hash_of(const std::string& trace) const {
    return json_of("vestige replay " + trace + " --json -")["texture_hash"];
  }
  std::size_t file_count() const {
    std::size_t count = 0;
    for ([[maybe_unused]] const auto& entry : std::filesystem::directory_iterator(folder_.path())) ++count;
    return count;
  }
};

TEST_F(Files, DoctorFindsNothingInARecordingAndReadsStandardInput) {
  const auto report = json_of("vestige doctor a.mcap --json -");
  EXPECT_EQ(report["files"][0]["problem_count"], 0);
  EXPECT_EQ(report["files"][0]["frames"], 100);
  EXPECT_EQ(run("vestige doctor - < a.mcap").exit_code, 0);
}

TEST_F(Files, DoctorNamesWhereAFileIsCutAndRecoverMakesItWhole) {
  ASSERT_EQ(run("head -c -3000 a.mcap > cut.mcap").exit_code, 0);
  const auto size = std::filesystem::file_size(folder_ / "cut.mcap");
  const test::Outcome doctor = run("vestige doctor a.mcap cut.mcap --json doctor.json");
  EXPECT_EQ(doctor.exit_code, 3);
  EXPECT_THAT(doctor.standard_output, HasSubstr("cut.mcap: at byte "));
  const auto problem = json_in("doctor.json")["files"][1]["problems"].back();
  EXPECT_EQ(problem["offset"].get<std::uint64_t>() + problem["bytes"].get<std::uint64_t>(), size);

  const test::Outcome recover = run("vestige recover cut.mcap -o mended.mcap --json recovery.json");
  EXPECT_TRUE(recover.exit_code == 0 || recover.exit_code == 3) << recover.standard_error;
  EXPECT_EQ(run("vestige doctor mended.mcap").exit_code, 0);
  EXPECT_EQ(run("vestige replay mended.mcap").exit_code, 0);
}

TEST_F(Files, DoctorSaysWhenNothingCanBeRead) {
  EXPECT_EQ(run("head -c 200 a.mcap > head.mcap; vestige doctor head.mcap").exit_code, 1);
  EXPECT_EQ(run("vestige doctor a.mcap head.mcap").exit_code, 1);
  EXPECT_EQ(run("vestige doctor missing.mcap").exit_code, 1);
  expect_failure("echo nothing > text; vestige recover text -o out.mcap", 1, {"nothing in it can be recovered"},
                 "out.mcap");
}

TEST_F(Files, RecoverCountsWhatStandsBehindTheEnd) {
  ASSERT_EQ(run("cp a.mcap longer.mcap && echo garbage >> longer.mcap").exit_code, 0);
  const test::Outcome recover = run("vestige recover longer.mcap -o mended.mcap --json recovery.json");
  EXPECT_EQ(recover.exit_code, 3) << recover.standard_error;
  EXPECT_EQ(json_in("recovery.json")["bytes_lost"], 8);
  const test::Outcome inspect = run("vestige inspect longer.mcap --json -");
  EXPECT_EQ(inspect.exit_code, 3);
  EXPECT_EQ(nlohmann::json::parse(inspect.standard_output)["warnings"].size(), 1U);
}

TEST_F(Files, NothingIsMadeOfAFileThatHoldsNothing) {
  ASSERT_EQ(run("head -c 45 a.mcap > header.mcap; head -c 8 a.mcap > magic.mcap").exit_code, 0);
  for (const char* file : {"header.mcap", "magic.mcap"}) {
    EXPECT_EQ(run(std::string("vestige doctor ") + file).exit_code, 1);
    for (const char* verb : {"recover", "recompress"})
      expect_failure(fmt::format("vestige {} {} -o b.mcap", verb, file), 1, {file, "nothing in it can be re"},
                     "b.mcap");
  }
}

TEST_F(Files, DoctorGoesOnBehindAFileThatCannotBeOpened) {
  const test::Outcome doctor = run("vestige doctor missing.mcap a.mcap none.mcap --json doctor.json");
  EXPECT_EQ(doctor.exit_code, 1);
  EXPECT_THAT(doctor.standard_error, HasSubstr("vestige: error: missing.mcap: "));
  EXPECT_THAT(doctor.standard_error, HasSubstr("vestige: error: none.mcap: "));
  EXPECT_THAT(doctor.standard_output, HasSubstr("a.mcap: no problem"));
  const auto files = json_in("doctor.json")["files"];
  ASSERT_EQ(files.size(), 3U);
  EXPECT_THAT(files[0]["error"].get<std::string>(), HasSubstr("missing.mcap"));
  EXPECT_EQ(files[1]["problem_count"], 0);
  EXPECT_FALSE(files[1].contains("error"));
  EXPECT_EQ(files[2]["readable"], false);
}

TEST_F(Files, TheTextureHashSurvivesRecompressTrimAndMerge) {
  const std::string hash = hash_of("a.mcap");
  for (const char* compression : {"lz4", "none", "zstd"}) {
    const std::string name = std::string(compression) + ".mcap";
    ASSERT_EQ(run("vestige recompress a.mcap -o " + name + " --compression " + compression).exit_code, 0);
    EXPECT_EQ(hash_of(name), hash) << compression;
  }
  EXPECT_EQ(json_of("vestige inspect none.mcap --json -")["compression"], "none");
  ASSERT_EQ(run("vestige trim a.mcap --to 0.31 -o 1.mcap").exit_code, 0);
  ASSERT_EQ(run("vestige trim a.mcap --from 0.31 --to 0.77 -o 2.mcap").exit_code, 0);
  ASSERT_EQ(run("vestige trim a.mcap --from 0.77 -o 3.mcap").exit_code, 0);
  EXPECT_EQ(json_of("vestige replay 2.mcap --json -")["frames"], 46);
  EXPECT_NE(hash_of("2.mcap"), hash);
  ASSERT_EQ(run("vestige merge 3.mcap 1.mcap 2.mcap -o whole.mcap").exit_code, 0);
  EXPECT_EQ(hash_of("whole.mcap"), hash);
}

TEST_F(Files, OneMessageIsNotSeveral) {
  ASSERT_EQ(run("vestige record -q --rate 10 --duration 0.1 -o one.mcap").exit_code, 0);
  EXPECT_THAT(run("vestige inspect one.mcap").standard_output, HasSubstr("/pose                        1 message  "));
}

TEST_F(Files, MergeRefusesAnotherRecordingWithTheReason) {
  ASSERT_EQ(run("vestige record --count 20 --rate 100 --duration 1 --seed 2 -o b.mcap").exit_code, 0);
  expect_failure("vestige merge a.mcap b.mcap -o c.mcap", 1,
                 {"b.mcap: its frame 0 (at 0 ns) differs from that of a.mcap"}, "c.mcap");
}

TEST_F(Files, NoOutputReplacesWhatIsThereOrWhatIsRead) {
  ASSERT_EQ(run("cp a.mcap b.mcap").exit_code, 0);
  for (const char* verb : {"recover a.mcap", "recompress a.mcap", "trim a.mcap --to 0.5", "merge a.mcap a.mcap"}) {
    const std::string command = std::string("vestige ") + verb;
    EXPECT_EQ(run(command + " -o b.mcap").exit_code, 1) << verb;
    EXPECT_EQ(run(command + " -o a.mcap --force").exit_code, 2) << verb;
    EXPECT_EQ(run(command + " -o b.mcap --force").exit_code, 0) << verb;
  }
  EXPECT_EQ(file_count(), 2U) << "and nothing else is left behind";
}

TEST_F(Files, TrimSaysWhatIsWrongWithItsTimes) {
  expect_failure("vestige trim a.mcap -o b.mcap", 2, {"--from, --to or both"}, "b.mcap");
  expect_failure("vestige trim a.mcap --from 2 --to 1 -o b.mcap", 2, {"--to", "not after --from"}, "b.mcap");
  expect_failure("vestige trim a.mcap --from -1 -o b.mcap", 2, {"--from", "-1"}, "b.mcap");
  expect_failure("vestige trim a.mcap --from 5 -o b.mcap", 1, {"its messages are from 0 to 0.99 s"}, "b.mcap");
}

TEST_F(Files, CatPrintsALineOfJsonForEachMessageOfATopic) {
  EXPECT_EQ(run("vestige cat a.mcap --topic /colliders | wc -l").standard_output, "100\n");
  EXPECT_EQ(run("vestige cat a.mcap | wc -l").standard_output, "200\n");
  const auto last = nlohmann::json::parse(run("vestige cat a.mcap --topic /colliders | tail -1").standard_output);
  EXPECT_EQ(last["sequence"], 99);
  EXPECT_EQ(last["data"].size(), 20U);
  const test::Outcome head = run("vestige cat a.mcap | head -1 | wc -l");
  EXPECT_EQ(head.standard_output, "1\n");
  EXPECT_EQ(head.standard_error, "");
  expect_failure("vestige cat a.mcap --topic /posse", 1, {"choose from: /colliders, /pose"});
}

TEST_F(Files, CatPrintsATimeInEitherOrder) {
  const std::string range = "vestige cat a.mcap --topic /pose --from 0.5 --to 0.53";
  const std::string lines = run(range).standard_output;
  EXPECT_EQ(std::count(lines.begin(), lines.end(), '\n'), 3);
  EXPECT_EQ(nlohmann::json::parse(lines.substr(0, lines.find('\n')))["sequence"], 50);
  EXPECT_EQ(run(range + " --order time").standard_output, lines);
  EXPECT_EQ(run("vestige cat a.mcap --order time").standard_output, run("vestige cat a.mcap").standard_output);
  expect_failure("vestige cat a.mcap --from 2 --to 1", 2, {"--to", "not after --from"});
  const test::Outcome beyond = run("vestige cat a.mcap --from 5");
  EXPECT_EQ(beyond.exit_code, 0);
  EXPECT_THAT(beyond.standard_error, HasSubstr("no message matches in the requested time"));
  const test::Outcome unknown = run("vestige cat a.mcap --topic /pose --topic /posse");
  EXPECT_EQ(unknown.exit_code, 1);
  EXPECT_EQ(unknown.standard_output, "") << "nor half of it";
  ASSERT_EQ(run("head -c -3000 a.mcap > cut.mcap").exit_code, 0);
  expect_failure("vestige cat cut.mcap --order time", 1, {"cut.mcap: cannot be read by its index"});
}

TEST_F(Files, CatDoesNotReadWhatItWrites) {
  const auto size = std::filesystem::file_size(folder_ / "a.mcap");
  expect_failure("vestige cat a.mcap >> a.mcap", 2, {"would change an input file"});
  EXPECT_EQ(std::filesystem::file_size(folder_ / "a.mcap"), size);
}

}  // namespace
}  // namespace vestige
