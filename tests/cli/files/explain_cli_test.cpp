// Every file that the verbs write explains itself.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "tests/support/command_line.hpp"

namespace vestige {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

class Explain : public test::CommandLineTest {
 protected:
  void must_run(const std::string& command) const {
    const test::Outcome outcome = run(command);
    EXPECT_EQ(outcome.exit_code, 0) << command << "\n" << outcome.standard_error;
  }

  /// Files whose names mean something, in the folder and below.
  std::vector<std::string> explainable() const {
    constexpr std::string_view kEnds[] = {".csv", ".zst", ".json", ".ndjson", ".h5", ".exr", ".hjif", ".tact"};
    std::vector<std::string> found;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder_.path()))
      if (std::ranges::find(kEnds, entry.path().extension().string()) != std::end(kEnds))
        found.push_back(std::filesystem::relative(entry.path(), folder_.path()).string());
    std::ranges::sort(found);
    return found;
  }

  void expect_all_explained(std::size_t least) const {
    const std::vector<std::string> files = explainable();
    EXPECT_GE(files.size(), least);
    for (const std::string& file : files) {
      const test::Outcome outcome = run("vestige explain " + file);
      EXPECT_EQ(outcome.exit_code, 0) << file << "\n" << outcome.standard_error;
      EXPECT_THAT(outcome.standard_output, StartsWith(file + ": "));
    }
  }
};

TEST_F(Explain, SaysWhatTheColumnsOfContactsMean) {
  record_small();
  must_run("vestige replay small.mcap --contacts contacts.csv -q");
  const std::string text = run("vestige explain contacts.csv").standard_output;
  EXPECT_THAT(
      text,
      AllOf(HasSubstr("contacts.csv: Contacts, a row for each (vestige replay --contacts OUT.csv)\n"),
            HasSubstr("  time_s     time of the frame, from the trace's start [s]\n"),
            HasSubstr(
                "actuator of the skin there, numbered from 1 on as in the map's JSON; 0: no actuator covers it\n")));
  EXPECT_EQ(run("vestige explain - < contacts.csv").standard_output, "-" + text.substr(text.find(':')));
}

TEST_F(Explain, KnowsEveryNameThatReplaysAndExportsWrite) {
  record_small();
  must_run(
      "vestige replay small.mcap --textures a.exr --timeline a.hjif --json a.json --law gaussian -q "
      "--planes actuator,t,triangle,barycentric,texture,position,speed,side,pressure");
  must_run("vestige replay small.mcap --contacts b.h5 --timeline b.csv --verify exact --json b.json -q");
  must_run(
      "vestige replay small.mcap --contacts c.csv --timeline c.tact --surface mapped --detector decimated -q "
      "--json c.json");
  must_run("vestige stream small.mcap --port osc://127.0.0.1:9 --rate 20 --log log.csv --json stream.json -q");
  must_run("vestige stream small.mcap --port vmc://127.0.0.1:9 --rate 20 --json people.json -q");
  must_run("vestige stream small.mcap --port - --rate 20 --json pipe.json -q");
  must_run("vestige export small.mcap -o folder --json export.json -q");
  must_run("vestige export small.mcap -o small.h5 --contacts b.h5 -q");
  must_run("vestige export small.mcap -o small.ndjson -q");
  must_run("vestige import folder -o back.mcap --json import.json -q");
  must_run(
      "vestige live --from - --port osc://127.0.0.1:9 --record felt.mcap --realtime --json live.json -q <small.ndjson");
  must_run("vestige view small.mcap --json view.json -q");
  expect_all_explained(21);
}

TEST_F(Explain, KnowsEveryNameThatVerbsOnTracesWrite) {
  must_run("vestige record --count 5 --rate 60 --duration 1 -o small.mcap --json record.json -q");
  must_run("vestige inspect small.mcap --json inspect.json -q");
  must_run("vestige cat small.mcap --json cat.json -q");
  must_run("vestige trim small.mcap --from 0 --to 0.5 -o first.mcap --json trim.json -q");
  must_run("vestige trim small.mcap --from 0.5 --to 2 -o rest.mcap -q");
  must_run("vestige merge first.mcap rest.mcap -o whole.mcap --json merge.json -q");
  must_run("vestige viz small.mcap -o seen.mcap --layout layout.json --json viz.json -q");
  must_run("vestige recompress small.mcap --compression lz4 -o other.mcap --json recompress.json -q");
  must_run("head -c -200 small.mcap > cut.mcap");
  EXPECT_NE(run("vestige doctor small.mcap cut.mcap --json doctor.json -q").exit_code, 0);
  must_run("vestige recover cut.mcap --map builtin -o saved.mcap --json recover.json -q");
  must_run("vestige avatar --json avatar.json -q");
  must_run("vestige map make --layout body -o map.png --save-regions regions.json --json made.json -q");
  must_run("vestige map check map.png --json checked.json -q");
  must_run("vestige map parts --json parts.json -q");
  must_run("vestige devices --json devices.json -q");
  must_run("vestige explain --json explained.json -q");
  expect_all_explained(15);
  // Of the same names: the verb tells.
  EXPECT_THAT(run("vestige explain trim.json").standard_output, HasSubstr("(vestige trim --json"));
  EXPECT_THAT(run("vestige explain recompress.json").standard_output, HasSubstr("(vestige recompress --json"));
}

TEST_F(Explain, KnowsEveryNameThatMeasurementsWrite) {
  record_small();
  const std::string quick = " --min-time 0.01 --no-figure -q";
  must_run(
      "vestige sweep small.mcap --counts 1,3 --detector cpu,paper,embree,decimated --skip on,off --stages --in-flight "
      "2 -o a" +
      quick);
  must_run("vestige sweep small.mcap --counts 1,3 --detector cpu,paper,embree,decimated --skip on,off -o b" + quick);
  must_run("vestige sweep small.mcap --counts 1 --detector cpu --renderer on -o c" + quick);
  EXPECT_NE(run("vestige compare a b --json compare.json -q").exit_code, 1);
  must_run("vestige growth small.mcap --counts 1,3 --count 3 --subdivisions 1 --detector cpu --skip on,off -o growth" +
           quick);
  must_run(
      "vestige growth small.mcap --counts 1,3 --count 3 --subdivisions 1 --detector cpu --frame-limit 1e-9 -o slow" +
      quick);
  must_run(
      "vestige accuracy --detector cpu,paper,decimated --method static --colliders swarm --count 20 --duration 0.2 "
      "--rate 90 --events 1 --check-frames 10 --no-figure -o accuracy --json accuracy.json -q");
  must_run("vestige stress --families vertex --detector cpu,paper --n 10 --no-figure -o stress --json stress.json -q");
  write("queries.txt",
        "0,1,0,1,0,1,0\n-1,1,-1,1,1,1,0\n1,1,-1,1,1,1,0\n0,1,1,1,1,1,0\n"
        "0,1,0,1,2,1,0\n-1,1,-1,1,1,1,0\n1,1,-1,1,1,1,0\n0,1,1,1,1,1,0\n");
  EXPECT_NE(run("vestige query queries.txt --method ccd --json query.json -q").exit_code, 1);
  must_run("vestige claims . -o claims.md --json claims.json -q");
  expect_all_explained(15);
}

TEST_F(Explain, KnowsEveryNameThatBatchesWrite) {
  must_run(
      "vestige batch --maps torso16,body --traces slide,hug --seeds 1:8 --laws binary,gaussian --duration 0.5 "
      "--unfelt-mm 100 -o seeds --json seeds.json -q");
  must_run("vestige batch --maps torso16 --traces slide,hug --laws binary --duration 0.5 --shard 1/2 -o a -q");
  must_run("vestige batch --maps torso16 --traces slide,hug --laws binary --duration 0.5 --shard 2/2 -o b -q");
  must_run("vestige batch merge a b -o both --json both.json -q");
  expect_all_explained(60);
}

TEST_F(Explain, ReadsNoMoreOfATableThanItsHeader) {
  const test::Outcome endless =
      run("{ echo frame,time_s,collider,triangle; yes 1,2,3,4; } | timeout 20 vestige explain -");
  EXPECT_EQ(endless.exit_code, 0);
  EXPECT_THAT(endless.standard_output, HasSubstr("  triangle  triangle of the avatar"));
}

TEST_F(Explain, ReadsFurtherLinesOfFrames) {
  write("a.ndjson", R"({"frame": 0, "time_s": 0})"
                    "\n"
                    R"({"frame": 1, "time_s": 1, "teleported": [3]})"
                    "\n");
  EXPECT_THAT(run("vestige explain a.ndjson").standard_output, HasSubstr("\n  teleported"));
  write("one.ndjson", R"({"frame": 0, "time_s": 0, "teleported": []})"
                      "\n");
  EXPECT_EQ(run("vestige explain one.ndjson").exit_code, 0);
  write("one.json", run("vestige explain --json - -q").standard_output + "\n\n");
  EXPECT_EQ(run("vestige explain one.json").exit_code, 0);
  write("b.ndjson", R"({"frame": 0, "time_s": 0})"
                    "\n"
                    "nothing\n");
  expect_failure("vestige explain b.ndjson", 1, {"b.ndjson, line 2", "no JSON object"});
}

TEST_F(Explain, MayBeCutShortByItsReader) {
  write("short.csv", "frame,time_s,collider,triangle\n");
  for (const char* command : {"explain", "explain short.csv"})
    EXPECT_EQ(run(std::string("{ vestige ") + command + "; echo $? > code; } | true; cat code").standard_output, "0\n")
        << command;
  const test::Outcome page = run("vestige explain | head -1");
  EXPECT_EQ(page.exit_code, 0);
  EXPECT_EQ(page.standard_output, "# Files\n");
  EXPECT_EQ(page.standard_error, "");
}

TEST_F(Explain, QuestionsNamesThatItDoesNotKnow) {
  write("more.csv", "frame,time_s,collider,triangle,t,u,v,mood\n");
  const test::Outcome more = run("vestige explain more.csv");
  EXPECT_EQ(more.exit_code, 3);
  EXPECT_THAT(more.standard_error, HasSubstr("more.csv: no file of this kind has mood\n"));
  EXPECT_THAT(more.standard_output, Not(HasSubstr("mood")));
}

TEST_F(Explain, RefusesFilesOfOthers) {
  write("own.csv", "participant,age\n1,30\n");
  expect_failure("vestige explain own.csv", 1, {"own.csv", "no file that Vestige writes", "participant, age"});
  write("short.csv", "x,y\n1,2\n");
  expect_failure("vestige explain short.csv", 1, {"short.csv", "no file that Vestige writes"});
  write("short.json", R"({"file": "a", "messages": 3})");
  expect_failure("vestige explain short.json", 1, {"short.json", "no file that Vestige writes"});
  write("own.json", "{\"participant\": {\"age\": 30}}");
  expect_failure("vestige explain own.json", 1, {"own.json", "no file that Vestige writes", "participant/age"});
  write("odd.json", R"({"argv": {"a": 1, "b": 2}})");
  expect_failure("vestige explain odd.json", 1, {"odd.json", "no file that Vestige writes"});
  write("cut.json", "{\"argv\": [");
  expect_failure("vestige explain cut.json", 1, {"cut.json", "is not JSON"});
  write("empty.csv", "");
  expect_failure("vestige explain empty.csv", 1, {"empty.csv", "is empty"});
  expect_failure("vestige explain none.csv", 1, {"none.csv"});
  write("bytes.bin", std::string(100, '\x01'));
  expect_failure("vestige explain bytes.bin", 1, {"bytes.bin", "neither CSV nor JSON"});
  write("cut.exr", "\x76\x2f\x31\x01 and no more");
  expect_failure("vestige explain cut.exr", 1, {"cut.exr", "OpenEXR"});
  write("cut.h5", "\x89HDF\r\n\x1a\n and no more");
  expect_failure("vestige explain cut.h5", 1, {"cut.h5", "HDF5"});
  expect_failure("cat cut.h5 | vestige explain -", 1, {"standard input", "name the file"});
  record_small();
  expect_failure("vestige explain small.mcap", 1, {"small.mcap", "vestige inspect"});
}

}  // namespace
}  // namespace vestige
