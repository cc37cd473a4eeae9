// Runs vestige-plot as a user does and looks at what it leaves behind.

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfOutputFile.h>
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <vector>

#include "tests/analysis/plot/plot_fixture.hpp"
#include "traces/files/input_file.hpp"

namespace vestige {
namespace {

using test::kWhite;
using test::Outcome;
using test::Picture;
using test::Pixel;
using test::PlotTest;
using test::read_png;
using test::words_of;
using test::write_text;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

constexpr const char* kSweep = R"({
  "schema_version": 1, "commit": "0123456789abcdef", "dirty": false,
  "machine": {"processor": "Fast & Cool 9000", "cores": 2},
  "gl": {"renderer": "softpipe", "version": "4.5", "context": "egl"},
  "avatar": {"vertices": 2600, "triangles": 5000, "joints": 20},
  "series": [
    {"detector": "paper", "context": "egl", "skip": "off", "method": "static", "points": [
      {"colliders": 1, "hz": 2800, "hz_low": 2700, "hz_high": 2900},
      {"colliders": 100, "hz": 170, "hz_low": 160, "hz_high": 180}]},
    {"detector": "cpu", "context": null, "skip": "off", "method": "static", "points": [
      {"colliders": 1, "hz": 14000}, {"colliders": 100, "hz": 240}]},
    {"detector": "cpu", "context": null, "skip": "on", "method": "static", "points": [
      {"colliders": 1, "hz": 290000}, {"colliders": 100, "hz": 16000}]}]})";

constexpr Pixel kFirstActuator = {0, 114, 178};
constexpr Pixel kFullDuty = {8, 29, 66};

/// One contact of `actuator` in the middle of `frames` x `colliders` texels.
void write_textures(const std::filesystem::path& path, int colliders, int frames, float actuator) {
  const auto width = static_cast<std::size_t>(colliders);
  const auto height = static_cast<std::size_t>(frames);
  std::vector<float> texels(width * height, std::numeric_limits<float>::infinity());
  texels[height / 2 * width + width / 2] = actuator;
  Imf::Header header(colliders, frames);
  header.channels().insert("actuator", Imf::Channel(Imf::FLOAT));
  Imf::OutputFile file(path.c_str(), header);
  Imf::FrameBuffer buffer;
  buffer.insert("actuator", Imf::Slice::Make(Imf::FLOAT, texels.data(), header.dataWindow()));
  file.setFrameBuffer(buffer);
  file.writePixels(frames);
}

TEST_F(PlotTest, ASweepNamesItsSeriesThePublishedPointsAndWhereItComesFrom) {
  write_text(folder_ / "sweep.json", kSweep);
  const Outcome outcome = run("sweep .");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.standard_error;
  const std::string words = words_of(folder_ / "frequency.svg");
  for (const char* expected :
       {"paper", "cpu, no skipping", "cpu", "HAVE 2010, GeForce GTX 285", "1 kHz", "500 Hz", "Number of colliders",
        "Detection frequency (Hz)", "softpipe", "Fast & Cool 9000", "0123456789", "5000 triangles"})
    EXPECT_THAT(words, HasSubstr(expected));
  EXPECT_THAT(words, Not(HasSubstr("paper, no skipping")));  // it knows none, so there is nothing to tell apart
}

TEST_F(PlotTest, ASweepSaysWhatItWasMeasuredWithAndWhetherToItsEnd) {
  std::string sweep = kSweep;
  for (std::size_t at = sweep.find("static"); at != std::string::npos; at = sweep.find("static"))
    sweep.replace(at, 6, "ccd");
  sweep.insert(sweep.find('{') + 1, R"("surface": "mapped", "complete": false, )");
  write_text(folder_ / "sweep.json", sweep);
  EXPECT_EQ(run("sweep .").exit_code, 0);
  const std::string words = words_of(folder_ / "frequency.svg");
  for (const char* expected : {"Method: ccd", "Mapped triangles only", "Not complete"})
    EXPECT_THAT(words, HasSubstr(expected));
}

TEST_F(PlotTest, AResultThatHoldsNoNumberOfADoubleNamesItsFile) {
  write_text(folder_ / "sweep.json", R"({"series": [1e999]})");
  const Outcome outcome = run("sweep .");
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_THAT(outcome.standard_error, AllOf(HasSubstr("sweep.json"), HasSubstr("beyond the largest double")));
}

TEST_F(PlotTest, APngIsSixAndAHalfInchesWideAt300DotsPerInchAndNotBlank) {
  write_text(folder_ / "sweep.json", kSweep);
  EXPECT_EQ(run("sweep sweep.json").exit_code, 0);
  const Picture picture = read_png(folder_ / "frequency.png");
  EXPECT_EQ(picture.width, 1950U);
  EXPECT_GT(picture.height, 1000U);
  const std::size_t white = picture.count(kWhite, 0, picture.width);
  EXPECT_GT(white, picture.pixels.size() / 2);
  EXPECT_LT(white, picture.pixels.size() * 99 / 100);
}

TEST_F(PlotTest, SeveralSweepsInOneFigureAreToldApart) {
  write_text(folder_ / "a.json", kSweep);
  write_text(folder_ / "b.json", kSweep);
  EXPECT_EQ(run("sweep a.json b.json -o .").exit_code, 0);
  const std::string words = words_of(folder_ / "frequency.svg");
  EXPECT_THAT(words, HasSubstr("cpu [1]"));
  EXPECT_THAT(words, HasSubstr("cpu [2]"));
}

constexpr const char* kGrowth = R"({
  "commit": "0123456789abcdef", "machine": {"processor": "Fast & Cool 9000", "cores": 2}, "colliders": 100,
  "avatar": {"vertices": 2600, "triangles": 5000},
  "by_colliders": {"series": [
    {"detector": "cpu", "context": "", "skip": "off", "gl": null, "points": [
      {"colliders": 1, "hz": 14000}, {"colliders": 1000, "hz": 24}]},
    {"detector": "cpu", "context": "", "skip": "on", "gl": null, "points": [
      {"colliders": 1, "hz": 290000}, {"colliders": 1000, "hz": 1600}]}]},
  "by_triangles": [
    {"triangles": 5000, "series": [
      {"detector": "cpu", "context": "", "skip": "off", "points": [{"colliders": 100, "hz": 240}]},
      {"detector": "cpu", "context": "", "skip": "on", "points": [{"colliders": 100, "hz": 16000}]}]},
    {"triangles": 20000, "series": [
      {"detector": "cpu", "context": "", "skip": "off", "points": [{"colliders": 100, "hz": 60}]},
      {"detector": "cpu", "context": "", "skip": "on", "points": [{"colliders": 100, "hz": 9000}]}]},
    {"triangles": 80000, "series": [
      {"detector": "cpu", "context": "", "skip": "off", "points": []},
      {"detector": "cpu", "context": "", "skip": "on", "points": [{"colliders": 100, "hz": 8000}]}]}],
  "left_out": {"colliders": [], "triangles": [{"series": "cpu", "above": 20000, "frame_s": 3.14}]}})";

TEST_F(PlotTest, AGrowthFigureNamesItsLinesAndWhatTheyRunAlong) {
  write_text(folder_ / "growth.json", kGrowth);
  const Outcome outcome = run("growth .");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.standard_error;
  const std::string words = words_of(folder_ / "growth.svg");
  for (const char* expected :
       {"cpu, no skipping", "cpu", "Number of colliders", "Number of triangles", "100 colliders", "Cost of a frame",
        "Fast & Cool 9000", "0123456789", "5000 triangles", "above 20000 (3.1 s a frame)"})
    EXPECT_THAT(words, HasSubstr(expected));
  EXPECT_LT(read_png(folder_ / "growth.png").height, 1500U);
}

TEST_F(PlotTest, AnAccuracyFigureNamesItsScenesLinesAndWhoIsOnTheFront) {
  const auto errors = [](double rate_hz, double missed, double wrong_actuator) {
    const auto rate = [](double value) {
      return fmt::format(R"({{"value": {}, "low": {}, "high": {}}})", value / 100, value / 200,
                         value == 0 ? 0.03 : value / 50);
    };
    return fmt::format(
        R"({{"rate_hz": {}, "within_tolerance": {{"wrong_share": {}, "missed_share": {}, "false_share": {},
            "wrong_actuator_share": {}}}}})",
        rate_hz, rate(missed + wrong_actuator), rate(missed), rate(0), rate(wrong_actuator));
  };
  const auto times = [](double rate_hz, double ms) {
    return fmt::format(R"({{"rate_hz": {}, "processor_ms_per_s": {{"value": {}, "low": {}, "high": null}}}})", rate_hz,
                       ms, ms * 0.9);
  };
  write_text(folder_ / "accuracy.json",
             fmt::format(R"({{"animation": "walk", "tolerance_ms": 10, "avatar": {{"triangles": 5000}},
    "scenes": [{{"colliders": "hug", "count": 100, "truth": {{"rate_hz": 30720, "events": 1631}}, "series": [
      {{"detector": "boxes", "approximate": true, "method": "static", "points": [{}, {}]}},
      {{"detector": "cpu", "approximate": false, "method": "ccd", "points": [{}, {}]}}]}}]}})",
                         errors(90, 30, 12), errors(1000, 20, 12), errors(90, 0, 0), errors(1000, 0, 0)));
  const std::string run_json = fmt::format(R"({{
    "commit": "0123456789abcdef", "dirty": false, "machine": {{"processor": "Fast & Cool 9000", "cores": 2}},
    "scenes": [{{"colliders": "hug", "pareto": [{{"detector": "boxes", "method": "static", "rate_hz": 90}},
      {{"detector": "cpu", "method": "ccd", "rate_hz": 90}}], "series": [
      {{"detector": "boxes", "method": "static", "gl": {{"renderer": "softpipe", "version": "4.5"}}, "points": [{}, {}]}},
      {{"detector": "cpu", "method": "ccd", "gl": null, "points": [{}, {}]}}]}}]}})",
                                           times(90, 0.5), times(1000, 5), times(90, 1), times(1000, 10));
  write_text(folder_ / "run.json", run_json);
  const Outcome outcome = run("accuracy .");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.standard_error;
  const std::string words = words_of(folder_ / "accuracy.svg");
  for (const char* expected :
       {"hug: 100 colliders, 1631 true events", "boxes, static", "cpu, ccd", "boxes static 90", "cpu ccd 90",
        "approximate: boxes", "Events wrong, for 100 true", "Processor time for a second of the scene (ms)",
        "Missed, for 100 true", "False, for 100 true", "Wrong actuator, for 100 true", "within 10 ms", "30720", "walk",
        "softpipe", "Fast & Cool 9000", "0123456789"})
    EXPECT_THAT(words, HasSubstr(expected));
  EXPECT_THAT(words, Not(HasSubstr("cpu ccd 1k")));
  EXPECT_EQ(read_png(folder_ / "accuracy.png").width, 1950U);

  // Times of another run are not drawn over these errors.
  std::string other = run_json;
  other.replace(other.rfind("\"ccd\""), 5, "\"static\"");
  write_text(folder_ / "run.json", other);
  const Outcome refused = run("accuracy . --force");
  EXPECT_EQ(refused.exit_code, 1);
  EXPECT_THAT(refused.standard_error, HasSubstr("scenes[0].series[1].method"));

  // A folder of an earlier version has no processor times.
  write_text(folder_ / "accuracy.json", R"({"animation": "walk", "avatar": {"triangles": 5000}, "scenes": [
    {"colliders": "hug", "count": 1, "truth": {"rate_hz": 30720, "events": 6}, "series": []}]})");
  EXPECT_EQ(run("accuracy . --force").exit_code, 1);
}

TEST_F(PlotTest, ASinglePulseAmongManyFramesStaysVisible) {
  std::string csv = "time_s,actuator_1,actuator_2\n";
  for (int frame = 0; frame < 50000; ++frame) csv += fmt::format("{},0,{}\n", frame / 1000.0, frame == 30000 ? 255 : 0);
  write_text(folder_ / "timeline.csv", csv);
  const Outcome outcome = run("timeline timeline.csv");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.standard_error;
  constexpr std::size_t kColourBarDots = 1750;
  EXPECT_GT(read_png(folder_ / "timeline.png").count(kFullDuty, 0, kColourBarDots), 50U);
  EXPECT_THAT(words_of(folder_ / "timeline.svg"), HasSubstr("Time (s)"));
  EXPECT_LT(std::filesystem::file_size(folder_ / "timeline.svg"), 100000U);
}

TEST_F(PlotTest, ATimelineNamesItsActuatorsAsTheMapDoes) {
  write_text(folder_ / "six.csv",
             "time_s,actuator_1,actuator_2,actuator_3,actuator_4,actuator_5,actuator_6\n0,255,0,0,0,0,0\n");
  ASSERT_EQ(run("timeline six.csv --map builtin").exit_code, 0);
  const std::string words = words_of(folder_ / "six.svg");
  EXPECT_THAT(words, HasSubstr("1 upper torso, right"));
  EXPECT_THAT(words, HasSubstr("2 upper torso, left"));
  ASSERT_EQ(run("timeline six.csv --map builtin --actuators 2,4:5 -o some").exit_code, 0);
  const std::string some = words_of(folder_ / "some.svg");
  EXPECT_THAT(some, HasSubstr("2 upper torso, left"));
  EXPECT_THAT(some, HasSubstr("5 "));
  EXPECT_THAT(some, Not(HasSubstr("1 upper torso, right")));
  EXPECT_THAT(run("timeline six.csv --actuators 3,7 -o none").standard_error, HasSubstr("there is no actuator 7"));
  write_text(folder_ / "one.csv", "time_s,actuator_1\n0,255\n");
  const Outcome other = run("timeline one.csv --map builtin");
  EXPECT_EQ(other.exit_code, 1);
  EXPECT_THAT(other.standard_error, HasSubstr("builtin: has 6 actuators, but one.csv has 1"));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "one.svg"));
}

TEST_F(PlotTest, ASingleContactAmongManyTexelsStaysVisible) {
  write_textures(folder_ / "textures.exr", 2000, 4000, 1);
  const Outcome outcome = run("textures textures.exr -o picture.png");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.standard_error;
  constexpr std::size_t kLegendDots = 1500;
  EXPECT_GE(read_png(folder_ / "picture.png").count(kFirstActuator, 0, kLegendDots), 25U);
  EXPECT_THAT(words_of(folder_ / "picture.svg"), HasSubstr("actuator 1 (1)"));
}

TEST_F(PlotTest, FiguresThatExistAreKeptWithoutForce) {
  write_text(folder_ / "sweep.json", kSweep);
  write_text(folder_ / "frequency.png", "mine");
  const Outcome refused = run("sweep .");
  EXPECT_EQ(refused.exit_code, 1);
  EXPECT_THAT(refused.standard_error, HasSubstr("--force"));
  EXPECT_EQ(read_text_file(folder_ / "frequency.png"), "mine");
  EXPECT_FALSE(std::filesystem::exists(folder_ / "frequency.svg"));
  EXPECT_EQ(run("sweep . --force").exit_code, 0);
  EXPECT_EQ(read_png(folder_ / "frequency.png").width, 1950U);
}

TEST_F(PlotTest, WithoutOpenGlTheSvgIsWrittenAndTheLossIsSaid) {
  write_text(folder_ / "sweep.json", kSweep);
  const Outcome outcome = run("sweep .", "__EGL_VENDOR_LIBRARY_FILENAMES=/nonexistent");
  EXPECT_EQ(outcome.exit_code, 3);
  EXPECT_THAT(outcome.standard_error, HasSubstr("frequency.png: left out"));
  EXPECT_THAT(words_of(folder_ / "frequency.svg"), HasSubstr("cpu"));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "frequency.png"));
}

struct BadInput {
  const char* name;
  const char* command;
  const char* content;  ///< null: there is no file
  const char* cause;
};

class BadInputTest : public PlotTest, public ::testing::WithParamInterface<BadInput> {};

TEST_P(BadInputTest, IsRefusedNamingFileAndCauseAndLeavesNothing) {
  const BadInput& bad = GetParam();
  if (bad.content != nullptr) write_text(folder_ / "input", bad.content);
  const std::size_t files_before = file_count();
  const Outcome outcome = run(fmt::format("{} input", bad.command));
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_THAT(outcome.standard_error, StartsWith("vestige: error: input"));
  EXPECT_THAT(outcome.standard_error, HasSubstr(bad.cause));
  EXPECT_EQ(file_count(), files_before);
}

INSTANTIATE_TEST_SUITE_P(
    Plot, BadInputTest,
    ::testing::Values(
        BadInput{"MissingSweep", "sweep", nullptr, "no such file"},
        BadInput{"SweepCutOff", "sweep", R"({"commit": "x", "series": [)", "byte 28"},
        BadInput{"SweepIsAList", "sweep", "[1]", "not a JSON object"},
        BadInput{"NoSeriesField", "sweep", R"({"commit": "x"})", "series is missing"},
        BadInput{"EmptySeries", "sweep", R"({"commit": "x", "series": []})", "series is empty"},
        BadInput{"NoPoints", "sweep", R"({"commit": "x", "series": [{"detector": "cpu", "points": []}]})",
                 "series[0].points is empty"},
        BadInput{"NotANumber", "sweep",
                 R"({"commit": "x", "series": [{"detector": "cpu", "points": [{"colliders": 1, "hz": null}]}]})",
                 "series[0].points[0].hz is not a number"},
        BadInput{"ZeroFrequency", "sweep",
                 R"({"commit": "x", "series": [{"detector": "cpu", "points": [{"colliders": 1, "hz": 0}]}]})",
                 "series[0].points[0].hz is 0"},
        BadInput{"SameCountTwice", "sweep",
                 R"({"commit": "x", "series": [{"detector": "cpu", "points": [{"colliders": 1, "hz": 2},
                    {"colliders": 1, "hz": 3}]}]})",
                 "1 colliders twice"},
        BadInput{"MissingGrowth", "growth", nullptr, "input: there is no such folder"},
        BadInput{"GrowthIsAFile", "growth", "{}", "input: is not a folder"},
        BadInput{"MissingTimeline", "timeline", nullptr, "no such file"},
        BadInput{"EmptyTimeline", "timeline", "", "line 1"},
        BadInput{"WrongColumns", "timeline", "time_s,actuator_2\n0,1\n", "line 1"},
        BadInput{"NoFrame", "timeline", "time_s,actuator_1\n", "no frame"},
        BadInput{"TimeStandsStill", "timeline", "time_s,actuator_1\n1,0\n1,0\n", "line 3: time_s does not rise"},
        BadInput{"TimeIsNoNumber", "timeline", "time_s,actuator_1\nnan,0\n", "line 2: time_s"},
        BadInput{"DutyTooHigh", "timeline", "time_s,actuator_1\n0,256\n", "line 2: actuator_1"},
        BadInput{"FieldTooMany", "timeline", "time_s,actuator_1\n0,1,2\n", "line 2"},
        BadInput{"FieldMissing", "timeline", "time_s,actuator_1,actuator_2\n0,1\n", "line 2: actuator_2"},
        BadInput{"MissingTextures", "textures", nullptr, "no such file"},
        BadInput{"NoExr", "textures", "time_s,actuator_1\n", "not an OpenEXR"}),
    [](const auto& test) { return std::string(test.param.name); });

TEST_F(PlotTest, ACutOffExrIsRefused) {
  write_textures(folder_ / "whole.exr", 100, 2000, 1);
  const std::string whole = read_text_file(folder_ / "whole.exr");
  for (const std::size_t bytes : {whole.size() - 1, whole.size() / 2, std::size_t{300}, std::size_t{9}}) {
    write_text(folder_ / "cut.exr", std::string_view(whole).substr(0, bytes));
    const Outcome outcome = run("textures cut.exr");
    EXPECT_EQ(outcome.exit_code, 1) << bytes;
    EXPECT_THAT(outcome.standard_error, StartsWith("vestige: error: cut.exr"));
    EXPECT_EQ(file_count(), 2U);
  }
}

TEST_F(PlotTest, AnExrWithSomethingElseInItsActuatorPlaneIsRefused) {
  for (const float wrong : {-1.0F, 0.5F, 70000.0F, std::numeric_limits<float>::quiet_NaN()}) {
    write_textures(folder_ / "textures.exr", 4, 10, wrong);
    const Outcome outcome = run("textures textures.exr");
    EXPECT_EQ(outcome.exit_code, 1);
    EXPECT_THAT(outcome.standard_error, HasSubstr("textures.exr, frame 5, collider 2"));
  }
}

TEST_F(PlotTest, WrongUsageExitsWith2) {
  EXPECT_EQ(run("").exit_code, 2);
  EXPECT_EQ(run("sweep").exit_code, 2);
  EXPECT_EQ(run("timeline a.csv b.csv").exit_code, 2);
  EXPECT_EQ(run("sweep . --colour").exit_code, 2);
  EXPECT_THAT(run("timeline --froce").standard_error, HasSubstr("--froce"));
  EXPECT_THAT(run("scen a.mcap").standard_error, HasSubstr("scen: there is no such figure\n  did you mean 'scene'?"));
  const Outcome standard_output = run("timeline a.csv -o -");
  EXPECT_EQ(standard_output.exit_code, 2);
  EXPECT_THAT(standard_output.standard_error, HasSubstr("name a file: -o FILE"));
  EXPECT_EQ(run("--help").exit_code, 0);
}

TEST_F(PlotTest, AFullDiskBehindStandardOutputIsAnError) {
  for (const char* command : {"--help", "man", "complete ''"}) {
    const Outcome outcome = run(std::string(command) + " >/dev/full");
    EXPECT_EQ(outcome.exit_code, 1) << command;
    EXPECT_THAT(outcome.standard_error, HasSubstr("No space left")) << command;
  }
}

}  // namespace
}  // namespace vestige
