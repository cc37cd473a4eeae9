// Runs vestige as a user does: real files, real contexts, real exit codes.

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputFile.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "tests/support/command_line.hpp"
#include "tests/support/gl/gl_context.hpp"
#include "traces/scene/builtin_avatar.hpp"

namespace vestige {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

using CommandLine = test::CommandLineTest;

TEST_F(CommandLine, HelpOfEveryVerbOpensWithTwoExamples) {
  for (const char* verb : {"", "record", "replay", "sweep", "inspect", "devices"}) {
    const test::Outcome help = run(std::string("vestige ") + verb + " --help");
    EXPECT_EQ(help.exit_code, 0) << verb;
    EXPECT_THAT(help.standard_output, StartsWith("Examples:\n  vestige ")) << verb;
  }
  EXPECT_THAT(run("vestige --version").standard_output, StartsWith("vestige 0"));
}

TEST_F(CommandLine, RecordsReplaysAndSaysTheSameEveryTime) {
  record_small();
  record_small("again.mcap");
  const auto first = json_of("vestige replay small.mcap --json -");
  EXPECT_EQ(first["frames"], 60);
  EXPECT_EQ(first["colliders"], 20);
  EXPECT_GT(first["contacts"], 20);
  EXPECT_EQ(first["avatar"]["triangles"], 4998);
  EXPECT_EQ(first["unsure"], 0);
  EXPECT_TRUE(first["argv"].is_array());
  EXPECT_TRUE(first["gl"].is_null());
  EXPECT_EQ(json_of("vestige replay again.mcap --json -")["texture_hash"], first["texture_hash"]);
  ASSERT_EQ(run("vestige record --seed 2 --count 20 --rate 60 --duration 1 -o other.mcap").exit_code, 0);
  EXPECT_NE(json_of("vestige replay other.mcap --json -")["texture_hash"], first["texture_hash"]);
}

TEST_F(CommandLine, GivesTheSameBitsTenThousandKilometresAway) {
  record_small();
  ASSERT_EQ(run("vestige record --count 20 --rate 60 --duration 1 --origin 10000000,0,-3 -o far.mcap").exit_code, 0);
  for (const char* detector : {"cpu", "paper", "geometry", "compute"}) {
    const std::string flags = std::string(" --json - --detector ") + detector + test::gl_flags();
    EXPECT_EQ(json_of("vestige replay far.mcap" + flags)["texture_hash"],
              json_of("vestige replay small.mcap" + flags)["texture_hash"]);
  }
}

TEST_F(CommandLine, ShadersGiveTheCpusTextureHashWithEveryMethodAndSayWhatTheyCaptured) {
  record_small();
  for (const char* method : {"static", "carried", "ccd"}) {
    const std::string flags = std::string("vestige replay small.mcap --json - --method ") + method;
    const auto cpu = json_of(flags + " --detector cpu");
    // own context: OSMesa, beside the one of all tests
    for (const std::string& context : {test::gl_flags("egl"), std::string(" --context osmesa")}) {
      for (const char* detector : {" --detector geometry", " --detector compute"}) {
        const auto drawn = json_of(flags + detector + context);
        EXPECT_EQ(drawn["texture_hash"], cpu["texture_hash"]) << method << detector << context;
        EXPECT_GT(drawn["contacts"], 0);
        EXPECT_GE(drawn["pairs_meeting"], drawn["contacts"]);
        EXPECT_GE(drawn["pairs_captured"], drawn["pairs_meeting"]);
      }
    }
  }
  const test::Outcome verified = run("vestige replay small.mcap --detector cpu --verify geometry" + test::gl_flags());
  EXPECT_EQ(verified.exit_code, 0);
  EXPECT_THAT(verified.standard_output, HasSubstr(" 0 contacts differ"));
  EXPECT_THAT(run("vestige replay small.mcap --detector geometry" + test::gl_flags()).standard_output,
              HasSubstr("captured "));
}

TEST_F(CommandLine, PaperGivesOneTextureHashOnEglAndOsMesa) {
  record_small();
  // own context: EGL, OSMesa and a device are what this is about
  const auto egl = json_of("vestige replay small.mcap --detector paper --context egl --json -");
  const auto osmesa = json_of("vestige replay small.mcap --detector paper --context osmesa --json -");
  const auto device = json_of("vestige replay small.mcap --detector paper --device 0 --json -");
  EXPECT_EQ(egl["texture_hash"], osmesa["texture_hash"]);
  EXPECT_EQ(egl["texture_hash"], device["texture_hash"]);
  EXPECT_EQ(osmesa["gl"]["context"], "osmesa");
  EXPECT_EQ(device["gl"]["context"], "egl-device-0");
  EXPECT_FALSE(egl["gl"]["renderer"].get<std::string>().empty());
}

TEST_F(CommandLine, WritesContactsTexturesAndTimelineThatAgree) {
  record_small();
  const auto replay = json_of(
      "vestige replay small.mcap --detector paper --contacts c.csv --textures t.exr "
      "--planes actuator,t,triangle,position,speed --timeline a.csv --hold 0 --json -" +
      test::gl_flags());
  std::ifstream contacts(folder_ / "c.csv");
  std::string line;
  std::getline(contacts, line);
  EXPECT_EQ(line, "frame,time_s,collider,triangle,t,u,v,texture_u,texture_v,actuator,side,x,y,z");
  std::size_t rows = 0;
  std::set<std::pair<std::string, std::string>> fired;  // time, actuator
  while (std::getline(contacts, line)) {
    ++rows;
    std::vector<std::string> fields;
    std::istringstream stream(line);
    for (std::string field; std::getline(stream, field, ',');) fields.push_back(field);
    ASSERT_EQ(fields.size(), 14U);
    if (fields[9] != "0") fired.emplace(fields[1], fields[9]);
  }
  EXPECT_EQ(rows, replay["contacts"]);

  std::ifstream timeline(folder_ / "a.csv");
  std::getline(timeline, line);
  EXPECT_EQ(line, "time_s,actuator_1,actuator_2,actuator_3,actuator_4,actuator_5,actuator_6");
  std::set<std::pair<std::string, std::string>> on;
  std::size_t frames = 0;
  while (std::getline(timeline, line)) {
    ++frames;
    std::istringstream stream(line);
    std::string time;
    std::getline(stream, time, ',');
    int actuator = 0;
    for (std::string duty; std::getline(stream, duty, ',');) {
      ++actuator;
      if (duty != "0") on.emplace(time, std::to_string(actuator));
    }
  }
  EXPECT_EQ(frames, 60U);
  EXPECT_EQ(on, fired);

  const Imf::InputFile image((folder_ / "t.exr").c_str());
  EXPECT_EQ(image.header().dataWindow().max.x, 19);
  EXPECT_EQ(image.header().dataWindow().max.y, 59);
  std::vector<std::string> names;
  for (auto channel = image.header().channels().begin(); channel != image.header().channels().end(); ++channel)
    names.emplace_back(channel.name());
  EXPECT_THAT(names, ::testing::UnorderedElementsAre("actuator", "t", "triangle", "speed", "x", "y", "z"));
  std::vector<float> actuator(20 * 60);
  std::vector<std::uint32_t> triangle(20 * 60);
  Imf::FrameBuffer buffer;
  buffer.insert("actuator", Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(actuator.data()), 4, 80));
  buffer.insert("triangle", Imf::Slice(Imf::UINT, reinterpret_cast<char*>(triangle.data()), 4, 80));
  Imf::InputFile reader((folder_ / "t.exr").c_str());
  reader.setFrameBuffer(buffer);
  reader.readPixels(0, 59);
  EXPECT_EQ(std::ranges::count_if(actuator, [](float a) { return std::isfinite(a); }), static_cast<long>(rows));
  EXPECT_EQ(std::ranges::count_if(triangle, [](std::uint32_t t) { return t != 0xFFFFFFFF; }), static_cast<long>(rows));
}

TEST_F(CommandLine, PressureIsTheShareOfAMetrePerSecondAndComesAlone) {
  record_small();
  for (const char* detector : {"cpu", "paper"}) {
    const auto plane = [&](const std::string& name) {
      EXPECT_EQ(run("vestige replay small.mcap --force --detector " + std::string(detector) + " --textures t.exr " +
                    "--planes " + name)
                    .exit_code,
                0);
      Imf::InputFile reader((folder_ / "t.exr").c_str());
      std::vector<std::string> names;
      for (auto channel = reader.header().channels().begin(); channel != reader.header().channels().end(); ++channel)
        names.emplace_back(channel.name());
      EXPECT_THAT(names, ::testing::UnorderedElementsAre("actuator", name));
      std::vector<float> values(20 * 60);
      Imf::FrameBuffer buffer;
      buffer.insert(name, Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(values.data()), 4, 80));
      reader.setFrameBuffer(buffer);
      reader.readPixels(0, 59);
      return values;
    };
    const std::vector<float> speed_m_per_s = plane("speed");
    const std::vector<float> pressure = plane("pressure");
    std::size_t gentle = 0;
    for (std::size_t i = 0; i < pressure.size(); ++i) {
      const bool hit = std::isfinite(speed_m_per_s[i]);
      EXPECT_EQ(pressure[i], hit ? std::min(speed_m_per_s[i], 1.0F) : speed_m_per_s[i]);
      gentle += hit && speed_m_per_s[i] < 1 ? 1U : 0U;
    }
    EXPECT_GT(gentle, 0U) << "the trace has no contact that tells";
  }
}

TEST_F(CommandLine, HoldKeepsAnActuatorOnForThatLong) {
  record_small();
  const auto on_cells = [&](const std::string& hold) {
    EXPECT_EQ(run("vestige replay small.mcap --force --timeline a.csv --hold " + hold).exit_code, 0);
    const std::string csv = read_text_file(folder_ / "a.csv");
    std::size_t count = 0;
    for (std::size_t at = csv.find(",255"); at != std::string::npos; at = csv.find(",255", at + 1)) ++count;
    return count;
  };
  EXPECT_GT(on_cells("60"), 2 * on_cells("0"));
}

TEST_F(CommandLine, VerifyTellsEqualFromDifferentRuns) {
  record_small();
  ASSERT_EQ(run("vestige replay small.mcap --contacts c.csv --json r.json").exit_code, 0);
  EXPECT_EQ(run("vestige replay small.mcap --verify r.json").exit_code, 0);
  EXPECT_EQ(run("vestige replay small.mcap --verify c.csv").exit_code, 0);
  ASSERT_EQ(run("{ head -1 c.csv; tail -n +2 c.csv | tac; } > reversed.csv").exit_code, 0);
  EXPECT_EQ(run("vestige replay small.mcap --verify reversed.csv").exit_code, 0) << "whatever the order of rows";
  for (const char* field : {"nan", "inf", "5"}) {
    ASSERT_EQ(run(std::string("awk -F, -v OFS=, 'NR==2{$5=\"") + field + "\"}1' c.csv > odd.csv").exit_code, 0);
    expect_failure("vestige replay small.mcap --verify odd.csv", 1, {"odd.csv, line 2", "t must be from 0 to 1"});
  }
  ASSERT_EQ(run("{ cat c.csv; tail -1 c.csv; } > twice.csv").exit_code, 0);
  expect_failure("vestige replay small.mcap --verify twice.csv", 1, {"twice.csv", "two contacts in frame"});
  const test::Outcome paper = run("vestige replay small.mcap --detector paper --verify cpu" + test::gl_flags());
  EXPECT_EQ(paper.exit_code, 0);
  EXPECT_THAT(paper.standard_output, HasSubstr(" 0 contacts differ"));
  ASSERT_EQ(run("vestige record --seed 3 --count 20 --rate 60 --duration 1 -o other.mcap").exit_code, 0);
  EXPECT_EQ(run("vestige replay other.mcap --verify r.json").exit_code, 4);
  EXPECT_EQ(run("vestige replay other.mcap --verify c.csv").exit_code, 4);
  ASSERT_EQ(run("sed -i '$d' c.csv").exit_code, 0);
  const test::Outcome less = run("vestige replay small.mcap --verify c.csv");
  EXPECT_EQ(less.exit_code, 4);
  EXPECT_THAT(less.standard_output, HasSubstr("1 extra"));
}

TEST_F(CommandLine, InspectNamesChannelsAndAttachments) {
  record_small();
  const auto inspect = json_of("vestige inspect small.mcap --json -");
  EXPECT_EQ(inspect["messages"], 120);
  EXPECT_EQ(inspect["complete"], true);
  EXPECT_EQ(inspect["dropped"], 0);
  EXPECT_EQ(inspect["compression"], "zstd");
  EXPECT_EQ(inspect["channels"].size(), 2U);
  EXPECT_EQ(inspect["channels"][0]["topic"], "/pose");
  EXPECT_EQ(inspect["attachments"][0]["name"], "avatar.glb");
  EXPECT_NEAR(inspect["duration_s"].get<double>(), 59.0 / 60, 1e-6);
}

TEST_F(CommandLine, ReadsATraceThatWasCutOffAndSaysSo) {
  record_small();
  const auto bytes = std::filesystem::file_size(folder_ / "small.mcap");
  ASSERT_EQ(run("head -c " + std::to_string(bytes - 300) + " small.mcap > cut.mcap").exit_code, 0);
  const test::Outcome replay = run("vestige replay cut.mcap");
  EXPECT_EQ(replay.exit_code, 3);
  EXPECT_THAT(replay.standard_error, HasSubstr("cut.mcap"));
  EXPECT_EQ(run("vestige inspect cut.mcap").exit_code, 3);
}

TEST_F(CommandLine, InspectSeesDamageInsideAChunk) {
  record_small();
  const auto middle = std::filesystem::file_size(folder_ / "small.mcap") - 2000;
  ASSERT_EQ(run("printf X | dd of=small.mcap bs=1 seek=" + std::to_string(middle) + " conv=notrunc").exit_code, 0);
  EXPECT_EQ(run("vestige inspect small.mcap").exit_code, 3);
}

TEST_F(CommandLine, CountsOneContactInTheSingular) {
  ASSERT_EQ(run("vestige record --colliders hug --rate 100 --duration 0.1 -o hug.mcap").exit_code, 0);
  const std::string text = run("vestige replay hug.mcap").standard_output;
  EXPECT_THAT(text, ::testing::ContainsRegex("torso, right +1 contact\n"));
  EXPECT_THAT(text, ::testing::ContainsRegex("torso, left +[0-9]+ contacts\n"));
}

TEST_F(CommandLine, RefusesWrongUsageWithExitCodeTwo) {
  record_small();
  expect_failure("vestige", 2, {});
  expect_failure("vestige frobnicate", 2, {"frobnicate"});
  expect_failure("vestige recrod", 2, {"did you mean 'record'?"});
  expect_failure("vestige replay small.mcap --verify ''", 2, {"is empty"});
  expect_failure("vestige record --facing= -o x.mcap", 2,
                 {"--facing=: has no value behind the equals sign\n  a variable may be unset"}, "x.mcap");
  expect_failure("vestige record -o=", 2, {"-o=: has no value"}, "=");
  expect_failure("vestige record --count 1 --count 2 -o x.mcap", 2, {"--count: is given 2 times\n  name it once"},
                 "x.mcap");
  expect_failure("vestige record --rate", 2, {"--rate: its value is missing\n  write --rate HZ"});
  expect_failure(
      "vestige replay small.mcap --verify auto", 2,
      {"name paper, geometry, compute, cpu, exact, embree, embree_default, boxes, capsules, decimated, or a file"});
  expect_failure("vestige replay small.mcap --planes t", 2, {"--textures"});
  expect_failure("vestige record -o x.mcap --seed -1", 2, {"--seed"}, "x.mcap");
  expect_failure("vestige record -o x.mcap --origin 1e300,0,0", 2, {"--origin"}, "x.mcap");
  expect_failure("vestige record", 2, {"--output"});
  for (const char* verb : {"record", "import --poses a.csv"})
    expect_failure(std::string("vestige ") + verb + " -o x.csv", 2,
                   {"'x.csv' ends in .csv, and a trace is an MCAP file", "vestige export"}, "x.csv");
  expect_failure("vestige import --colliders a.csv -o x.mcap", 2,
                 {"no motion and no poses", "'vestige record --animation none' with the same flags"}, "x.mcap");
  expect_failure("vestige record --ouput x.mcap", 2, {"no flag '--ouput'", "did you mean '--output'?"}, "x.mcap");
  expect_failure("vestige record -o x.mcap --cuont=5", 2, {"no flag '--cuont'", "did you mean '--count'?"}, "x.mcap");
  expect_failure("vestige map make --layuot paper6 -o a.png", 2, {"did you mean '--layout'?"}, "a.png");
  expect_failure("vestige replay x.mcap --detector geometri", 2, {"geometri not in", "did you mean 'geometry'?"});
  expect_failure("vestige sweep --detector cpu,embre -o s", 2, {"there is no 'embre'", "did you mean 'embree'?"}, "s");
  expect_failure("vestige replay x.mcap --detector GEOMETRY", 2, {"did you mean 'geometry'?"});
  expect_failure("vestige record -o x.mcap --compression l4z", 2, {"did you mean 'lz4'?"}, "x.mcap");
  expect_failure("vestige record -o x.mcap --animation Spni", 2, {"no animation 'Spni'", "did you mean 'spin'?"},
                 "x.mcap");
  expect_failure("vestige import --motion a.bvh --unit mn -o x.mcap", 2, {"did you mean 'mm'?"}, "x.mcap");
  expect_failure("vestige inspect small.mcap one two", 2, {"not expected: 'one', 'two'"});
  expect_failure("vestige replay small.mcap --planes t --texture t.exr", 2,
                 {"there is no flag '--texture'", "did you mean '--textures'?"}, "t.exr");
  expect_failure("vestige replay small.mcap --texture t.exr", 2, {"there is no flag '--texture'"}, "t.exr");
  expect_failure("ln -s both one && ln -s both two && vestige replay small.mcap --contacts one --timeline two", 2,
                 {"two results cannot share one file"}, "both");
  expect_failure("vestige map check --bogus", 2, {"--bogus", "'vestige map check --help' explains the verb"});
  expect_failure("vestige --bogus", 2, {"--bogus", "'vestige --help' lists the verbs"});
  expect_failure("vestige record -o x.mcap --count 0", 2, {"--count"}, "x.mcap");
  expect_failure("vestige record -o x.mcap --rate 0", 2, {"--rate"}, "x.mcap");
  expect_failure("vestige record -o x.mcap --rate nan", 2, {"--rate"}, "x.mcap");
  expect_failure("vestige record -o x.mcap --duration inf", 2, {"--duration"}, "x.mcap");
  expect_failure("vestige record -o x.mcap --origin 1,nan,0", 2, {"--origin"}, "x.mcap");
  expect_failure("vestige record -o x.mcap --colliders tornado", 2, {"tornado", "swarm"}, "x.mcap");
  expect_failure("vestige record -o x.mcap --animation dance", 2, {"dance", "idle", "spin"}, "x.mcap");
  expect_failure("vestige replay small.mcap --detector magic", 2, {"--detector"});
  expect_failure("vestige replay small.mcap --planes colour --textures t.exr", 2, {"colour", "triangle"}, "t.exr");
  expect_failure("vestige replay small.mcap --hold -1", 2, {"--hold"});
  expect_failure("vestige replay small.mcap --contacts - --json -", 2, {"standard output"});
  expect_failure("vestige sweep small.mcap -o s --counts 0:5", 2, {"--counts"}, "s/sweep.json");
  expect_failure("vestige sweep small.mcap -o s --counts 5,x", 2, {"--counts"}, "s/sweep.json");
  expect_failure("vestige sweep small.mcap -o s --detector cpu,magic", 2, {"magic"}, "s/sweep.json");
}

TEST_F(CommandLine, NamesWhatIsWrongWithForeignFiles) {
  record_small();
  std::ofstream(folder_ / "text.txt") << "hello";
  std::ofstream(folder_ / "empty") << "";
  const auto glb = builtin_avatar_glb();
  std::ofstream(folder_ / "cut.glb", std::ios::binary)
      .write(reinterpret_cast<const char*>(glb.data()), static_cast<std::streamsize>(glb.size() / 2));
  expect_failure("vestige record --avatar nowhere.glb -o x.mcap", 1, {"nowhere.glb", "no such file"}, "x.mcap");
  expect_failure("vestige record --avatar text.txt -o x.mcap", 1, {"text.txt"}, "x.mcap");
  expect_failure("vestige record --avatar cut.glb -o x.mcap", 1, {"cut.glb"}, "x.mcap");
  expect_failure("vestige record --avatar . -o x.mcap", 1, {"folder"}, "x.mcap");
  expect_failure("vestige record --map nowhere.png -o x.mcap", 1, {"nowhere.png"}, "x.mcap");
  expect_failure("vestige record --map text.txt -o x.mcap", 1, {"text.txt", "PNG"}, "x.mcap");
  for (const char* command : {"record -o x.mcap", "replay small.mcap", "view small.mcap -o x.mcap"})
    expect_failure(std::string("vestige ") + command + " --map torso41", 1,
                   {"torso41: there is no such file", "the layouts are: paper6, torso16, torso40, body"}, "x.mcap");
  expect_failure("vestige record --colliders nowhere.csv -o x.mcap", 1, {"nowhere.csv"}, "x.mcap");
  expect_failure("vestige record -o nowhere/x.mcap", 1, {"nowhere"});
  for (const char* file : {"text.txt", "empty", "nowhere", "."}) {
    expect_failure(std::string("vestige replay --contacts c.csv ") + file, 1, {file}, "c.csv");
    expect_failure(std::string("vestige inspect ") + file, 1, {file});
  }
  expect_failure("vestige replay small.mcap --verify text.txt", 1, {"text.txt"});
  expect_failure("vestige sweep small.mcap -o s --counts 21", 1, {"21", "20"}, "s/sweep.json");
  expect_failure("vestige replay small.mcap --detector paper --device 99", 1, {"--device 99"});
}

TEST_F(CommandLine, ReadsColliderFilesAndRefusesBrokenOnesByLine) {
  const auto with = [&](const std::string& content) {
    std::ofstream(folder_ / "c.csv") << content;
    return "vestige record --colliders c.csv --animation none --rate 100 --duration 1 --force -o x.mcap";
  };
  const std::string header = "time_s,id,x,y,z\n";
  // Straight through the body, from 0.2 s to 0.6 s.
  ASSERT_EQ(run(with(header + "0.2,7,0.03,1.2,-1\r\n\r\n0.6,7,0.03,1.2,1\n")).exit_code, 0);
  const test::Outcome contacts = run("vestige replay x.mcap --contacts - -q");
  EXPECT_EQ(std::ranges::count(contacts.standard_output, '\n'), 3);  // header, in, out
  EXPECT_THAT(contacts.standard_output, HasSubstr(",7,"));
  expect_failure(with(header + "1700000000,7,-1,1,0\n"), 1, {"c.csv", "no sample lies within"});
  EXPECT_THAT(run(with(header + "0,7,-1,1,0\n9,7,1,1,0\n")).standard_error, HasSubstr("left out"));
  expect_failure(with("hello\n"), 1, {"c.csv, line 1", "time_s,id,x,y,z"});
  expect_failure(with(header), 1, {"c.csv", "no sample"});
  expect_failure(with("frame,time_s,id,x,y,z,teleported\n"), 1, {"c.csv", "no sample"});
  expect_failure(with(header + "0,1,2,3\n"), 1, {"c.csv, line 2"});
  expect_failure(with(header + "0,1,2,3,4,5\n"), 1, {"c.csv, line 2"});
  expect_failure(with(header + "0,1,2,3,nan\n"), 1, {"c.csv, line 2", "finite"});
  expect_failure(with(header + "0,-1,2,3,4\n"), 1, {"c.csv, line 2"});
  expect_failure(with(header + "1,1,2,3,4\n0,1,2,3,4\n"), 1, {"c.csv, line 3", "backwards"});
  expect_failure(with(header + "1,1,2,3,4\n1,1,2,3,5\n"), 1, {"c.csv, line 3", "two positions"});
}

TEST_F(CommandLine, SaysWhatToInstallWithoutAnyOpenGl) {
  record_small();
  // A loader path of stubs that are no libraries hides EGL and OSMesa.
  ASSERT_EQ(run("mkdir none && echo > none/libEGL.so.1 && echo > none/libOSMesa.so.8").exit_code, 0);
  const std::string hidden = "LD_LIBRARY_PATH=\"$PWD/none\" ";
  expect_failure(hidden + "vestige replay small.mcap --detector paper --contacts c.csv", 1,
                 {"OpenGL", "libegl1", "--detector cpu"}, "c.csv");
  EXPECT_EQ(run(hidden + "vestige replay small.mcap --detector cpu").exit_code, 0);
  EXPECT_EQ(run(hidden + "vestige devices").exit_code, 0);
  const test::Outcome sweep =
      run(hidden + "vestige sweep small.mcap --counts 1 --min-time 0.01 --runs 1 --no-figure -o s");
  EXPECT_EQ(sweep.exit_code, 0);
  EXPECT_THAT(sweep.standard_error, HasSubstr("no series 'paper'"));
}

TEST_F(CommandLine, ReplaySaysWhatItPickedAndWhy) {
  record_small();
  const auto picked = json_of("vestige replay small.mcap --json -");
  EXPECT_EQ(picked["picked"], "cpu, skip on");
  EXPECT_THAT(picked["why"].get<std::string>(), HasSubstr("20 colliders x 4998 triangles"));
  EXPECT_EQ(json_of("vestige replay small.mcap --skip off --json -")["picked"], "cpu, skip off");
  EXPECT_FALSE(json_of("vestige replay small.mcap --detector cpu --json -").contains("picked"));
  EXPECT_THAT(run("vestige replay small.mcap").standard_output, HasSubstr("picked cpu, skip on (20 colliders"));
}

TEST_F(CommandLine, ReplayLeavesOutWhatNoActuatorCovers) {
  record_small();
  const auto mapped = json_of("vestige replay small.mcap --surface mapped --json -");
  EXPECT_GT(mapped["triangles_left_out"], 3000);
  EXPECT_EQ(json_of("vestige replay small.mcap --surface mapped --detector exact --json -")["texture_hash"],
            mapped["texture_hash"]);
  EXPECT_THAT(run("vestige replay small.mcap --surface mapped").standard_output, HasSubstr("of 4998 triangles, which"));
  EXPECT_FALSE(json_of("vestige replay small.mcap --json -").contains("triangles_left_out"));
}

TEST_F(CommandLine, FiresEveryActuatorOfARealAvatarsMap) {
  const auto avatar = test::data("avatars/avatars/CesiumMan.glb");
  const auto map = test::data("avatars/maps/CesiumMan.actuators6.png");
  VESTIGE_REQUIRE_DATA(avatar);
  ASSERT_EQ(run("vestige record --avatar '" + avatar.string() + "' --map '" + map.string() +
                "' --colliders swarm --count 100 --rate 60 --duration 2 -o man.mcap")
                .exit_code,
            0);
  const auto replay = json_of("vestige replay man.mcap --contacts c.csv --textures t.exr --timeline a.csv --json -");
  EXPECT_GT(replay["contacts"], 300);
  EXPECT_EQ(replay["actuators"].size(), 6U);
  for (const auto& actuator : replay["actuators"]) EXPECT_GT(actuator["contacts"], 0);
}

TEST_F(CommandLine, ClaimsGoToPeopleOrToPrograms) {
  record_small();
  ASSERT_EQ(run("mkdir r && vestige replay small.mcap --json r/replay.json").exit_code, 0);
  EXPECT_THAT(run("vestige claims r").standard_output, HasSubstr("## How fast?"));
  const auto claims = json_of("vestige claims r --json -")["claims"];
  ASSERT_FALSE(claims.empty());
  for (const auto& claim : claims) EXPECT_EQ(claim["file"], "replay.json");
  expect_failure("vestige claims r --json - -o -", 2, {"standard output"});
}

TEST_F(CommandLine, PlotWithoutVtkSaysWhatToInstall) {
  ASSERT_EQ(run("cp \"$(command -v vestige)\" here").exit_code, 0);
  expect_failure("PATH=/usr/bin:/bin ./here plot sweep s", 1, {"vestige-plot", "libvtk9-dev"});
}

}  // namespace
}  // namespace vestige
