// The parts of a batch that need no trace: names, scripts, the contacts' file.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "analysis/batch/batch_plan.hpp"
#include "analysis/batch/slurm_script.hpp"
#include "analysis/scoring/contact_recording_file.hpp"
#include "tests/support/process.hpp"
#include "tests/support/test_data.hpp"
#include "traces/base/error.hpp"

namespace vestige {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

TEST(BatchNames, AreTheFilesAndNeverTwiceTheSame) {
  EXPECT_THAT(unique_names(std::vector<std::string>{"a/man.mcap", "b/man.mcap", "man-2.mcap", "swarm"}),
              ElementsAre("man", "man-2", "man-2-2", "swarm"));
}

TEST(BatchNames, CanStandInACsvAndAreNoHiddenFilesOrFlags) {
  EXPECT_THAT(unique_names(std::vector<std::string>{"a,b\"c\nd.png", ".hidden.png", "-x.png", "Küche.png", ".."}),
              ElementsAre("a_b_c_d", "_.hidden", "_-x", "Küche", "_.."));
  EXPECT_LE(unique_names(std::vector<std::string>{std::string(300, 'x')}).front().size(), 100U);
}

TEST(BatchNames, AreUtf8WhateverTheFilesAreCalled) {
  EXPECT_THAT(unique_names(std::vector<std::string>{"K\xFC"
                                                    "che.png",
                                                    "cut\xC3.png", "half\xED\xA0\x80.png", "long\xC0\xAF.png",
                                                    "\xF0\x9F\x98\x80.png"}),
              ElementsAre("K_che", "cut_", "half___", "long__", "\xF0\x9F\x98\x80"));
  // A letter of two bytes begins at byte 99, counted from 0: it is left out whole.
  std::string umlauts(99, 'x');
  for (int i = 0; i < 20; ++i) umlauts += "ü";
  EXPECT_EQ(unique_names(std::vector<std::string>{umlauts}).front(), std::string(99, 'x'));
  EXPECT_EQ(unique_names(std::vector<std::string>{"x" + umlauts}).front(), std::string(100, 'x'));
}

TEST(BatchPlans, OfAnyNamesCanBeSaidInJsonAndAreReadBackTheSame) {
  BatchPlan plan;
  plan.avatar_given =
      "k\xFC"
      "che.glb";
  plan.maps.push_back({.name = "map", .given = "\xFF.png", .sha256 = "ab", .files = {}, .layout = {}, .warnings = {}});
  plan.traces.push_back({"trace", "\xC3", nullptr});
  const nlohmann::ordered_json json = to_json(plan);
  EXPECT_EQ(nlohmann::ordered_json::parse(json.dump()), json);
  EXPECT_EQ(item_key(json).size(), 64U);
}

TEST(BatchPlans, OfEarlierVersionsAreThoseWithoutLaterOptions) {
  const nlohmann::ordered_json now = to_json(BatchPlan());
  nlohmann::ordered_json earlier = now;
  for (const char* option : {"full_speed_m_per_s", "sigma_mm", "actuator"}) earlier["options"].erase(option);
  EXPECT_EQ(command_of(earlier), command_of(now));
  earlier["options"]["sigma_mm"] = 5.0;
  EXPECT_NE(command_of(earlier), command_of(now));
}

TEST(BatchShards, TakeEveryTraceOnce) {
  for (std::size_t position = 0; position < 20; ++position) {
    int owners = 0;
    for (std::size_t number = 1; number <= 7; ++number) owners += Shard{number, 7}.has(position) ? 1 : 0;
    EXPECT_EQ(owners, 1);
  }
}

/// What a shell makes of the words is what they were.
TEST(SlurmScript, QuotesEveryWordForTheShell) {
  const test::TemporaryFolder folder;
  for (const std::string word : {"plain-1.png", "two words", "it's", "$HOME `id` \"x\" \\n", "*", "", "a\nb", "~"}) {
    const test::Outcome outcome = test::run("printf %s " + shell_quoted(word), folder.path());
    EXPECT_EQ(outcome.standard_output, word);
  }
}

TEST(SlurmScript, IsWellFormedForAShell) {
  const test::TemporaryFolder folder;
  SlurmBatch batch;
  batch.program = "/opt/my tools/vestige";
  batch.working_folder = "/data/o'hara";
  batch.arguments = {"--maps", "a b.png", "--traces", "x.mcap"};
  batch.output = "/data/out put";
  batch.shards = 3;
  batch.sbatch = {"--time=60"};
  std::ofstream(folder / "submit.sh") << slurm_script(batch);
  const test::Outcome outcome = test::run("bash -n submit.sh", folder.path());
  EXPECT_EQ(outcome.exit_code, 0) << outcome.standard_error;
  EXPECT_EQ(outcome.standard_error, "");
}

RecordedTrace small_recording() {
  RecordedTrace trace;
  trace.collider_ids = {3, 7};
  ContactRow row(2);
  trace.contacts.add(0, row);  // nothing
  row[1].triangle = 12;
  row[1].t = 0.1F;
  row[1].barycentric = {1.0 / 3, 0.25};
  row[1].texture_coordinate = {0.7, 1e-17};
  row[1].side = -1;
  row[1].speed_m_per_s = 1.5;
  trace.contacts.add(0.1, row);
  row[0] = row[1];
  row[0].side = 1;
  trace.contacts.add(0.2, row);
  trace.contacts.add(0.3, ContactRow(2));
  return trace;
}

TEST(ContactRecordingFile, ReadsBackTheSameBits) {
  const test::TemporaryFolder folder;
  const std::string path = (folder / "c.csv").string();
  const RecordedTrace written = small_recording();
  write_contact_recording(path, written);
  EXPECT_THAT(read_text_file(path), HasSubstr("\n0,0,,,,,,,,,\n1,0.1,7,12,0.1,"));
  const RecordedTrace read = read_contact_recording(path);
  EXPECT_EQ(read.collider_ids, written.collider_ids);
  EXPECT_EQ(read.contacts.time_s, written.contacts.time_s);
  EXPECT_EQ(read.contacts.first, written.contacts.first);
  EXPECT_EQ(read.contacts.column, written.contacts.column);
  ASSERT_EQ(read.contacts.contacts.size(), written.contacts.contacts.size());
  for (std::size_t i = 0; i < read.contacts.contacts.size(); ++i) {
    const Contact& a = read.contacts.contacts[i];
    const Contact& b = written.contacts.contacts[i];
    EXPECT_EQ(a.triangle, b.triangle);
    EXPECT_EQ(a.t, b.t);
    EXPECT_EQ(a.barycentric, b.barycentric);
    EXPECT_EQ(a.texture_coordinate, b.texture_coordinate);
    EXPECT_EQ(a.side, b.side);
    EXPECT_EQ(a.speed_m_per_s, b.speed_m_per_s);
  }
}

TEST(ContactRecordingFile, NamesTheLineThatIsWrong) {
  const test::TemporaryFolder folder;
  const std::string path = (folder / "c.csv").string();
  const std::string header = "frame,time_s,collider,triangle,t,u,v,texture_u,texture_v,side,speed_m_per_s\n";
  const std::string none = ",,,,,,,,,\n";
  const auto refused = [&](const std::string& rows, const std::string& line) {
    std::ofstream(path) << header << rows;
    try {
      read_contact_recording(path);
      ADD_FAILURE() << rows;
    } catch (const Error& error) {
      EXPECT_THAT(error.what(), HasSubstr("c.csv, line " + line)) << rows;
    }
  };
  refused("0,0" + none + "2,1" + none, "3");
  refused("0,0" + none + "0,0" + none, "3");
  refused("0,5" + none + "1,4" + none, "3");
  refused("0,0,1,2,0.5,0,0,0,0,2,1\n", "2");
  refused("0,0,1,4294967295,0.5,0,0,0,0,1,1\n", "2");
  refused("0,0,1,2,0.5,0,0,0,0,1\n", "2");
  refused("0,0,1,2,0.5,0,0,0,0,1,1,1\n", "2");
  refused("0,0,,2,,,,,,,\n", "2");
  refused("0,0,2,2,0.5,0,0,0,0,1,1\n0,0,1,2,0.5,0,0,0,0,1,1\n", "3");
  refused("0,0,x,2,0.5,0,0,0,0,1,1\n", "2");
}

}  // namespace
}  // namespace vestige
