// Sweep and growth as a user asks for them: small ones.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/support/command_line.hpp"
#include "tests/support/gl/gl_context.hpp"
#include "traces/files/input_file.hpp"

namespace vestige {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

class SweepCommandLine : public test::CommandLineTest {};
class GrowthCommandLine : public test::CommandLineTest {};

TEST_F(SweepCommandLine, MeasuresEverySeriesAndKeepsEveryFrame) {
  record_small();
  // own context: EGL and OSMesa, which sweep takes unasked
  const test::Outcome sweep =
      run("vestige sweep small.mcap --counts 1,5:20:5 --min-time 0.01 --runs 2 --run-frames 10 --skip off --no-figure "
          "-o s");
  ASSERT_EQ(sweep.exit_code, 0) << sweep.standard_error;
  EXPECT_THAT(sweep.standard_output, AllOf(HasSubstr("HAVE 2010"), HasSubstr("paper, osmesa"), HasSubstr("cpu")));
  const auto json = json_in("s/sweep.json");
  EXPECT_EQ(json["schema_version"], 1);
  EXPECT_EQ(json["avatar"]["joints"], 21);
  EXPECT_EQ(json["sample"]["places"], 2);
  EXPECT_GT(json["sample"]["trace"]["contacts_per_frame"], 0);
  EXPECT_NEAR(json["sample"]["sampled"]["empty_share"], json["sample"]["trace"]["empty_share"], 0.15);
  EXPECT_THAT(sweep.standard_output, HasSubstr("with other colliders drawn for each"));
  ASSERT_EQ(json["series"].size(), 3U);
  for (const auto& series : json["series"]) {
    EXPECT_EQ(series["points"].size(), 5U);
    for (const auto& point : series["points"]) {
      EXPECT_GE(point["frames"], 40) << "two passes at least, beside the cold one";
      EXPECT_EQ(point["frames"].get<int>() % 20, 0) << "whole passes";
      EXPECT_GT(point["hz"], 0);
      EXPECT_GT(point["cold_hz"], 0);
      EXPECT_GE(point["empty_share"], 0);
      EXPECT_LE(point["empty_share"], 1);
      EXPECT_EQ(point["contacts"] == 0, point["empty_share"] == 1);
      // passes that scatter too much, as on a busy machine, have no interval
      ASSERT_EQ(point["hz_low"].is_null(), point["hz_high"].is_null());
      if (!point["hz_low"].is_null()) {
        EXPECT_LE(point["hz_low"], point["hz"]);
        EXPECT_GE(point["hz_high"], point["hz"]);
      }
      EXPECT_LE(point["us_median"], point["us_p99"]);
      EXPECT_EQ(point["pairs_tested"], 4998 * 20 * point["colliders"].get<int>());
    }
  }
  EXPECT_EQ(json["series"][0]["points"][4]["texture_hash"], json["series"][1]["points"][4]["texture_hash"]);
  EXPECT_EQ(run("zstd -qdc s/frame_times.csv.zst | head -1").standard_output,
            "detector,context,skip,planes,renderer,avatars,colliders_around,colliders,repetition,frame,us\n");
}

TEST_F(SweepCommandLine, MeasuresWithAndWithoutSkippingAndOnceWhoeverIgnoresIt) {
  record_small();
  const test::Outcome sweep =
      run("vestige sweep small.mcap --detector paper,cpu,embree --skip off,on --method static --counts 1,20 "
          "--min-time 0.01 --runs 2 --run-frames 10 --no-figure -o s" +
          test::gl_flags("osmesa"));
  ASSERT_EQ(sweep.exit_code, 0) << sweep.standard_error;
  EXPECT_THAT(sweep.standard_output, AllOf(HasSubstr("cpu, skip on"), HasSubstr("Times as fast as the fastest paper"),
                                           HasSubstr("Times as fast as the fastest Embree")));
  const auto json = json_in("s/sweep.json");
  std::vector<std::string> names;
  for (const auto& series : json["series"])
    names.push_back(series["detector"].get<std::string>() + " " + series["skip"].get<std::string>());
  EXPECT_THAT(names, testing::ElementsAre("paper off", "cpu off", "cpu on", "embree off"));
  for (const std::size_t p : {0U, 1U}) {
    const auto point = [&](std::size_t series) { return json["series"][series]["points"][p]; };
    EXPECT_EQ(point(1)["texture_hash"], point(2)["texture_hash"]);
    EXPECT_DOUBLE_EQ(point(0)["times_paper"], 1);
    EXPECT_DOUBLE_EQ(point(2)["times_paper"].get<double>(),
                     point(2)["hz"].get<double>() / point(0)["hz"].get<double>());
    EXPECT_DOUBLE_EQ(point(1)["times_embree"].get<double>(),
                     point(1)["hz"].get<double>() / point(3)["hz"].get<double>());
    EXPECT_EQ(point(1)["pass_frames"], 20);
  }
  EXPECT_EQ(json_of("vestige sweep small.mcap --detector cpu --method ccd --counts 1 --min-time 0.01 --runs 1 "
                    "--no-figure -o ccd --json -")["series"][0]["method"],
            "ccd");
  expect_failure("vestige sweep small.mcap -o t --skip maybe", 2, {"--skip", "maybe", "off"}, "t/sweep.json");
  expect_failure("vestige sweep small.mcap -o t --keep 0.5", 2, {"--keep", "paper,cpu", "decimated"}, "t/sweep.json");
  expect_failure("vestige sweep small.mcap -o t --skip on,on", 2, {"--skip", "twice"}, "t/sweep.json");
}

TEST_F(SweepCommandLine, MeasuresCopiesOfThePeopleSideBySide) {
  record_small();
  const std::string flags = " --min-time 0.01 --runs 2 --run-frames 10 -o s ";
  const test::Outcome sweep =
      run("vestige sweep small.mcap --avatars 1,3 --detector cpu,geometry --counts 5,20 --json "
          "c.json" +
          flags + test::gl_flags("osmesa"));
  ASSERT_EQ(sweep.exit_code, 0) << sweep.standard_error;
  const nlohmann::json json = json_in("s/sweep.json");
  std::map<std::string, nlohmann::json> points;  // with 20 colliders
  for (const auto& series : json["series"])
    points[series["detector"].get<std::string>() + series["avatars"].dump() +
           series["colliders_around"].get<std::string>()] = series["points"][1];
  ASSERT_EQ(points.size(), 6U);
  for (const std::string detector : {"cpu", "geometry"}) {
    const auto contacts = points[detector + "1all"]["contacts"].get<int>();
    EXPECT_GT(contacts, 0);
    EXPECT_EQ(points[detector + "3all"]["contacts"], 3 * contacts);
    EXPECT_EQ(points[detector + "3first"]["contacts"], contacts);
  }
  for (const char* crowd : {"1all", "3all", "3first"})
    EXPECT_EQ(points[std::string("cpu") + crowd]["texture_hash"],
              points[std::string("geometry") + crowd]["texture_hash"]);
  EXPECT_THAT(sweep.standard_output, AllOf(HasSubstr("cpu, skip on, µs a frame:"), HasSubstr("20 around the first")));
  EXPECT_GT(std::filesystem::file_size(folder_ / "s/people.png"), 10000U);
  EXPECT_EQ(run("cp -r s again && vestige compare s again").exit_code, 0);

  ASSERT_EQ(
      run("vestige record --avatar builtin --avatar builtin --at 0,0,0.9,180 --rate 100 --duration 0.3 --count 10 "
          "-q -o pair.mcap")
          .exit_code,
      0);
  const nlohmann::json pair = json_of("vestige sweep pair.mcap --detector cpu --counts 10 --force --json -" + flags);
  EXPECT_EQ(pair["series"][0]["avatars"], 2);
  EXPECT_FALSE(std::filesystem::exists(folder_ / "s/people.png"));
  expect_failure("vestige sweep pair.mcap --avatars 3 -o t", 2, {"--avatars", "all 2 people of pair.mcap"},
                 "t/sweep.json");
  expect_failure("vestige sweep pair.mcap --renderer on -o t", 2, {"--renderer", "one person"}, "t/sweep.json");
  expect_failure("vestige sweep --avatars 1:65 -o t", 2, {"--avatars", "65 people", "64"}, "t");
  expect_failure("vestige sweep --avatars 2 --counts 1:4 -o t", 2, {"--counts", "3 numbers"}, "t");
}

TEST_F(SweepCommandLine, StoresAHundredPassesOfManyAndComparesThem) {
  record_small();
  ASSERT_EQ(
      run("vestige sweep small.mcap --detector cpu --skip on --counts 1,20 --min-time 0.1 --runs 2 --run-frames 3 "
          "--no-figure -o many -q")
          .exit_code,
      0);
  const nlohmann::json json = json_in("many/sweep.json");
  const auto& points = json["series"][0]["points"];
  for (const auto& point : points) {
    EXPECT_EQ(point["stored_frames"], 600);
    EXPECT_GT(point["frames"], 600);
  }
  EXPECT_EQ(run("zstdcat many/frame_times.csv.zst | wc -l").standard_output, "1201\n");
  // The first repetition and one near the end are among them.
  const test::Outcome last = run("zstdcat many/frame_times.csv.zst | awk -F, '$8 == 20 { r = $9 } END { print r }'");
  const auto repetitions = points[1]["repetitions"].get<double>();
  EXPECT_GT(std::stod(last.standard_output), 0.95 * repetitions);
  EXPECT_EQ(run("cp -r many again && vestige compare many again").exit_code, 0);
}

TEST_F(SweepCommandLine, MeasuresBesideARendererInAThreadOfItsOwn) {
  record_small();
  const test::Outcome sweep =
      run("vestige sweep small.mcap --detector paper,cpu --renderer on --counts 20 --min-time 0.01 --runs 2 "
          "--run-frames 10 --no-figure -o s" +
          test::gl_flags("osmesa"));
  ASSERT_EQ(sweep.exit_code, 0) << sweep.standard_error;
  const auto json = json_in("s/sweep.json");
  const auto context = json["gl"]["context"].get<std::string>();
  EXPECT_THAT(sweep.standard_output, AllOf(HasSubstr("paper, " + context + ", rendering"), HasSubstr("90 asked for")));
  ASSERT_EQ(json["series"].size(), 4U);
  for (std::size_t i = 0; i < 4; ++i) {
    const auto& series = json["series"][i];
    EXPECT_EQ(series["renderer"], i % 2 == 0 ? "off" : "on");
    EXPECT_EQ(series["renderer_gl"].is_null(), i % 2 == 0);
    EXPECT_EQ(series["points"][0].contains("rendered_hz"), i % 2 == 1);
    EXPECT_EQ(series["points"][0]["texture_hash"], json["series"][i / 2 * 2]["points"][0]["texture_hash"]);
  }
  EXPECT_GT(json["series"][1]["points"][0]["rendered_hz"], 0);
  EXPECT_LE(json["series"][1]["points"][0]["rendered_hz"], 120) << "paced, however short the run";
}

TEST_F(SweepCommandLine, SaysWhereTheTimeGoesIfAsked) {
  record_small();
  const test::Outcome sweep =
      run("vestige sweep small.mcap --detector paper,cpu --renderer on --counts 1,20 --min-time 0.01 --runs 2 "
          "--run-frames 10 --stages --no-figure -o s" +
          test::gl_flags("osmesa"));
  ASSERT_EQ(sweep.exit_code, 0) << sweep.standard_error;
  EXPECT_THAT(sweep.standard_output,
              AllOf(HasSubstr("Where the time goes with 1 collider, \u00b5s a frame:"),
                    HasSubstr("Where the time goes with 20 colliders"), HasSubstr("read_back"), HasSubstr("together")));
  const auto json = json_in("s/sweep.json");
  ASSERT_EQ(json["series"].size(), 4U);
  for (const auto& series : json["series"]) {
    const bool draws = series["detector"] == "paper";
    for (const auto& point : series["points"]) {
      // Another thread's work would be charged to stages.
      EXPECT_EQ(point.contains("stages"), series["renderer"] == "off");
      if (!point.contains("stages")) continue;
      EXPECT_GT(point["stages"]["pose"], 0);
      EXPECT_EQ(point["stages"].contains("draw"), draws);
      EXPECT_EQ(point["stages"].contains("candidates"), !draws);
      EXPECT_EQ(point.contains("draw_by"), draws);
      EXPECT_EQ(point.value("draw_by", "") == "timer", point["stages"].contains("wait"));
    }
  }
  const auto unasked = json_of(
      "vestige sweep small.mcap --detector cpu --counts 1 --min-time 0.01 --runs 1 "
      "--no-figure -o t --json -");
  EXPECT_FALSE(unasked["series"][0]["points"][0].contains("stages"));
}

TEST_F(SweepCommandLine, MeasuresThroughputIfAskedBesideTheFrequencyOfSingleFrames) {
  record_small();
  const std::string flags = " --counts 1,20 --min-time 0.01 --runs 2 --run-frames 10 -o s --force";
  const test::Outcome sweep = run("vestige sweep small.mcap --detector compute,cpu --renderer on --in-flight 4" +
                                  flags + test::gl_flags("osmesa"));
  ASSERT_EQ(sweep.exit_code, 0) << sweep.standard_error;
  EXPECT_THAT(sweep.standard_output, HasSubstr("Throughput: Hz of frames that detectors are given 4 at a time"));
  const auto json = json_in("s/sweep.json");
  ASSERT_EQ(json["series"].size(), 4U);
  for (const auto& series : json["series"])
    for (const auto& point : series["points"]) {
      EXPECT_GT(point["hz"], 0);
      // the renderer draws during the other passes only
      ASSERT_EQ(point.contains("throughput_hz"), series["renderer"] == "off");
      if (!point.contains("throughput_hz")) continue;
      EXPECT_GT(point["throughput_hz"], 0);
      EXPECT_NE(point["throughput_hz"], point["hz"]);
      EXPECT_EQ(point["in_flight"], 4);
      if (!point["throughput_hz_low"].is_null()) {
        EXPECT_LE(point["throughput_hz_low"], point["throughput_hz"]);
      }
    }
  EXPECT_EQ(run("cp -r s again && vestige compare s again").exit_code, 0);
  const test::Outcome crowds =
      run("vestige sweep small.mcap --detector cpu --avatars 1,2 --in-flight 4 --no-figure" + flags);
  EXPECT_THAT(crowds.standard_output, AllOf(HasSubstr("Throughput:"), HasSubstr("cpu, skip on, 2 people")));
  const test::Outcome unasked = run("vestige sweep small.mcap --detector cpu --no-figure" + flags);
  EXPECT_THAT(unasked.standard_output, Not(HasSubstr("Throughput")));
  EXPECT_FALSE(json_in("s/sweep.json")["series"][0]["points"][0].contains("throughput_hz"));
  expect_failure("vestige sweep small.mcap --in-flight 9 -o t", 2, {"--in-flight", "8"}, "t/sweep.json");
}

/// Whatever the colliders' order in the trace, the point of all of them sees what a replay sees.
TEST_F(SweepCommandLine, MeasuresTheWholeTraceWhereItIsAllAsked) {
  record_small();
  const auto replay = json_of("vestige replay small.mcap --detector cpu --json - -q");
  const auto point = json_of(
      "vestige sweep small.mcap --detector cpu --counts 20 --min-time 1e-9 --runs 1 "
      "--run-frames 10000 --no-figure -o s --force --json -")["series"][0]["points"][0];
  EXPECT_EQ(point["contacts"], replay["contacts"]);
}

TEST_F(SweepCommandLine, SaysWhatFurtherPlanesCost) {
  record_small();
  const test::Outcome sweep =
      run("vestige sweep small.mcap --detector paper,cpu --planes 1,3,8 --counts 5 --min-time 0.01 --runs 1 "
          "--run-frames 5 --no-figure -o s" +
          test::gl_flags("osmesa"));
  ASSERT_EQ(sweep.exit_code, 0) << sweep.standard_error;
  EXPECT_THAT(sweep.standard_output, AllOf(HasSubstr("3 planes"), HasSubstr("each further plane")));
  const auto series = json_in("s/sweep.json")["series"];
  std::vector<int> planes;
  for (const auto& one : series) {
    planes.push_back(one["planes"].get<int>());
    EXPECT_EQ(one["points"][0]["contacts"], series[0]["points"][0]["contacts"]);
    EXPECT_EQ(one["points"][0]["disagreements"], 0);
  }
  EXPECT_THAT(planes, testing::ElementsAre(1, 3, 8, 1)) << "only paper draws planes";
  expect_failure("vestige sweep small.mcap --detector cpu --planes 1:8 -o t", 2, {"--planes", "paper"}, "t/sweep.json");
  expect_failure("vestige sweep small.mcap --planes 9 -o t", 2, {"--planes", "9", "8"}, "t/sweep.json");
  expect_failure("vestige sweep small.mcap --planes 0 -o t", 2, {"--planes", "0"}, "t/sweep.json");
}

/// The default goes up to 100 colliders.
TEST_F(SweepCommandLine, MeasuresAsManyCollidersAsThereAreUnlessAskedForMore) {
  ASSERT_EQ(run("vestige record --count 3 --rate 100 --duration 0.1 -o three.mcap -q").exit_code, 0);
  ASSERT_EQ(run("vestige sweep three.mcap --detector cpu --min-time 1e-9 --no-figure -o s").exit_code, 0);
  EXPECT_EQ(json_in("s/sweep.json")["series"][0]["points"].size(), 3U);
  expect_failure("vestige sweep three.mcap --detector cpu --counts 1:4 -o t", 1, {"--counts", "4", "3"},
                 "t/sweep.json");
}

TEST_F(SweepCommandLine, SaysHowManyPlacesTheTraceHasRoomFor) {
  record_small();
  const test::Outcome sweep =
      run("vestige sweep small.mcap --detector cpu --counts 1 --min-time 1e-9 --runs 9999 --no-figure -o s");
  ASSERT_EQ(sweep.exit_code, 0) << sweep.standard_error;
  EXPECT_THAT(sweep.standard_error, HasSubstr("the trace has room for "));
  EXPECT_LT(json_in("s/sweep.json")["runs"], 9999);
  const test::Outcome whole =
      run("vestige sweep small.mcap --detector cpu --counts 1 --min-time 1e-9 --runs 1 --run-frames 100000 --no-figure "
          "-o w");
  EXPECT_THAT(whole.standard_error, HasSubstr("has room for 1 run of "));
  EXPECT_LT(json_in("w/sweep.json")["run_frames"], 100000);
}

/// Another than the one that was named is not measured in its stead.
TEST_F(SweepCommandLine, RefusesADeviceThatIsNotThere) {
  record_small();
  const test::Outcome sweep =
      run("vestige sweep small.mcap --detector geometry,cpu --device 99 --counts 1 --no-figure -o s");
  EXPECT_EQ(sweep.exit_code, 1);
  EXPECT_THAT(sweep.standard_error, HasSubstr("--device 99: this machine has "));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "s"));
}

TEST_F(SweepCommandLine, NoFigureOfAnEarlierRunStandsBesideNewResults) {
  record_small();
  ASSERT_EQ(run("mkdir s && touch s/frequency.png s/frequency.svg s/mine.png").exit_code, 0);
  ASSERT_EQ(
      run("vestige sweep small.mcap --detector cpu --counts 1 --min-time 0.01 --no-figure --force -o s").exit_code, 0);
  EXPECT_FALSE(std::filesystem::exists(folder_ / "s/frequency.png"));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "s/frequency.svg"));
  EXPECT_TRUE(std::filesystem::exists(folder_ / "s/mine.png"));
}

TEST_F(SweepCommandLine, GoesOnWithoutEmbree) {
  record_small();
  ASSERT_EQ(run("mkdir none && echo > none/libembree3.so.3").exit_code, 0);
  const test::Outcome sweep =
      run("LD_LIBRARY_PATH=\"$PWD/none\" vestige sweep small.mcap --detector cpu,embree --counts 1 --min-time 0.01 "
          "--runs 1 "
          "--no-figure -o s");
  EXPECT_EQ(sweep.exit_code, 0) << sweep.standard_error;
  EXPECT_THAT(sweep.standard_error, AllOf(HasSubstr("no series 'embree'"), HasSubstr("libembree3-3")));
  EXPECT_THAT(sweep.standard_output, HasSubstr("cpu"));
}

TEST_F(GrowthCommandLine, MeasuresCollidersAndTrianglesAndWhatSkippingSaves) {
  record_small();
  const test::Outcome growth =
      run("vestige growth small.mcap --detector paper,cpu --counts 1,20 --count 5 --subdivisions 1 "
          "--min-time 0.01 --runs 2 --run-frames 3 --no-figure -o g" +
          test::gl_flags("osmesa"));
  ASSERT_EQ(growth.exit_code, 0) << growth.standard_error;
  EXPECT_THAT(growth.standard_output, AllOf(HasSubstr("cpu, skip on"), HasSubstr("With 5 colliders"),
                                            HasSubstr("19992"), HasSubstr("What skipping saves")));
  const auto json = json_in("g/growth.json");
  EXPECT_EQ(json["complete"], true);
  EXPECT_EQ(json["by_colliders"]["series"].size(), 3U);
  EXPECT_EQ(json["by_colliders"]["series"][0]["points"].size(), 2U);
  ASSERT_EQ(json["by_triangles"].size(), 2U);
  EXPECT_EQ(json["by_triangles"][1]["triangles"], 4 * 4998);
  EXPECT_EQ(json["by_triangles"][1]["series"][1]["points"][0]["colliders"], 5);
  ASSERT_EQ(json["ablation"].size(), 3U);  // two counts, and the larger avatar
  for (const auto& one : json["ablation"]) {
    EXPECT_EQ(one["pairs"], one["triangles"].get<double>() * one["colliders"].get<double>());
    EXPECT_LE(one["pairs_tested"], one["pairs"]);
    EXPECT_NEAR(one["us_off"].get<double>() - one["us_on"].get<double>(),
                one["us_saved_by_frames"].get<double>() + one["us_saved_by_meshlets"].get<double>(), 1e-6);
  }
  expect_failure("vestige growth small.mcap --count 21 --counts 1 --subdivisions 0 -o h", 1, {"21", "20"});
  expect_failure("vestige growth small.mcap --subdivisions 9 -o h", 2, {"--subdivisions"});
  expect_failure("vestige growth --counts 10,1000001 -o h", 2, {"--counts", "1000001", "at most 1000000"});
  EXPECT_FALSE(std::filesystem::exists(folder_ / "h"));
}

TEST_F(GrowthCommandLine, SaysHowMuchMemoryADetectorHolds) {
  record_small();
  const test::Outcome growth =
      run("vestige growth small.mcap --detector cpu --skip on --counts 20 --count 20 --subdivisions 2 --min-time 0.01 "
          "--runs 1 --run-frames 3 --no-figure -o g");
  ASSERT_EQ(growth.exit_code, 0) << growth.standard_error;
  EXPECT_THAT(growth.standard_output, HasSubstr("Memory that each detector holds:"));
  const auto sizes = json_in("g/growth.json")["by_triangles"];
  const auto bytes = [&](std::size_t level) {
    return sizes[level]["series"][0]["points"][0].value("memory_bytes", 0.0);
  };
  EXPECT_GT(bytes(0), 0);
  EXPECT_GT(bytes(2), bytes(0));
}

TEST_F(GrowthCommandLine, LeavesWhatIsTooSlowOutOfLargerSizes) {
  record_small();
  const test::Outcome growth =
      run("vestige growth small.mcap --detector cpu --counts 2,20 --count 5 --subdivisions 1 --min-time 0.01 --runs 1 "
          "--run-frames 3 --frame-limit 1e-9 -o g");
  ASSERT_EQ(growth.exit_code, 0) << growth.standard_error;
  EXPECT_THAT(growth.standard_output,
              AllOf(HasSubstr("'cpu, skip on' above 2 colliders ("), HasSubstr("'cpu' above 4998 triangles (")));
  const auto json = json_in("g/growth.json");
  EXPECT_EQ(json["frame_limit_s"], 1e-9);
  for (const auto& series : json["by_colliders"]["series"]) EXPECT_EQ(series["points"].size(), 1U);
  ASSERT_EQ(json["by_triangles"].size(), 2U);
  for (const auto& series : json["by_triangles"][1]["series"]) EXPECT_EQ(series["points"].size(), 0U);
  ASSERT_EQ(json["left_out"]["triangles"].size(), 2U);
  EXPECT_EQ(json["left_out"]["colliders"][0]["above"], 2);
}

TEST_F(GrowthCommandLine, RecordsAShortTraceForCrowds) {
  const test::Outcome growth =
      run("vestige growth --detector cpu --skip on --counts 10,1200 --count 10 --subdivisions 0 --min-time 0.01 "
          "--runs 1 --run-frames 2 --no-figure -o g -q");
  ASSERT_EQ(growth.exit_code, 0) << growth.standard_error;
  const auto json = json_in("g/growth.json");
  EXPECT_EQ(json["crowded_trace"], "g/crowded.mcap");
  const auto points = json["by_colliders"]["series"][0]["points"];
  ASSERT_EQ(points.size(), 2U);
  EXPECT_EQ(points[1]["colliders"], 1200);
  EXPECT_GT(points[1]["contacts"], 0);
  expect_failure("vestige growth g/trace.mcap --counts 1001 --count 1 -o h", 1, {"1001", "1000"});
  expect_failure("vestige growth g/crowded.mcap --counts 1201 --count 1 -o h", 1, {"1201", "1200"});
}

TEST_F(GrowthCommandLine, SplitsAMapOfTrianglesWithThem) {
  ASSERT_EQ(run("vestige map make --layout torso16 --per-triangle -o vest.png -q && vestige record --colliders hug "
                "--count 25 --rate 60 --duration 4 --map vest.png -o vest.mcap -q")
                .exit_code,
            0);
  ASSERT_EQ(
      run("vestige growth vest.mcap --detector paper,cpu --surface mapped --counts 25 --count 25 --subdivisions 1 "
          "--min-time 0.01 --runs 1 --run-frames 200 --no-figure -o g -q" +
          test::gl_flags())
          .exit_code,
      0);
  // The finer skin lies where the coarser did, but for what bends.
  const auto sizes = json_in("g/growth.json")["by_triangles"];
  for (std::size_t series = 1; series <= 2; ++series) {
    const auto contacts = [&](std::size_t level) {
      return sizes[level]["series"][series]["points"][0]["contacts"].get<double>();
    };
    EXPECT_GT(contacts(0), 40);
    EXPECT_NEAR(contacts(1) / contacts(0), 1, 0.1);
  }
}

}  // namespace
}  // namespace vestige
