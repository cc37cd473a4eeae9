// `vestige viz`: what Foxglove and Lichtblick get to see, decoded by Foxglove's own schemas.

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "tests/support/builtin_avatar.hpp"
#include "tests/support/command_line.hpp"
#include "tests/support/duty_rows.hpp"
#include "tests/support/npm.hpp"
#include "tests/traces/viz/viz_json.hpp"
#include "traces/scene/reference_skinning.hpp"
#include "traces/trace_file/trace_reader.hpp"

namespace vestige {
namespace {

using nlohmann::json;
using test::matrix_of;
using test::vector_of;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::UnorderedElementsAre;

/// The frames of a message on /viz/tf, in the world.
std::map<std::string, glm::dmat4> frames_of(const json& message) {
  std::map<std::string, glm::dmat4> frames = {{"world", glm::dmat4(1)}};
  for (const json& transform : message["transforms"])
    frames[transform["child_frame_id"]] = frames.at(transform["parent_frame_id"]) * matrix_of(transform);
  return frames;
}

std::map<std::string, std::string> metadata_of(const json& entity) {
  std::map<std::string, std::string> metadata;
  for (const json& entry : entity["metadata"]) metadata[entry["key"]] = entry["value"];
  return metadata;
}

/// Rows of a CSV file, by the names of its columns.
std::vector<std::map<std::string, std::string>> read_csv(const std::filesystem::path& path) {
  std::ifstream stream(path);
  const auto cells_of = [](const std::string& line) {
    std::vector<std::string> cells;
    std::istringstream text(line);
    for (std::string cell; std::getline(text, cell, ',');) cells.push_back(cell);
    return cells;
  };
  std::string line;
  std::getline(stream, line);
  const std::vector<std::string> names = cells_of(line);
  std::vector<std::map<std::string, std::string>> rows;
  while (std::getline(stream, line)) {
    const std::vector<std::string> cells = cells_of(line);
    std::map<std::string, std::string>& row = rows.emplace_back();
    for (std::size_t i = 0; i < cells.size(); ++i) row[names[i]] = cells[i];
  }
  return rows;
}

class Viz : public test::CommandLineTest {
 protected:
  void SetUp() override { VESTIGE_REQUIRE_DATA(test::npm_package("@foxglove/schemas")); }

  /// Records, then adds what viewers draw: man.mcap and seen.mcap.
  void record(const std::string& recording, const std::string& flags = "") const {
    const test::Outcome outcome =
        run("vestige record " + recording + " -o man.mcap && vestige viz man.mcap -o seen.mcap " + flags);
    ASSERT_EQ(outcome.exit_code, 0) << outcome.standard_error;
  }
  json seen() const { return json::parse(test::run_node("read_viz.mjs", folder_ / "seen.mcap")); }
  std::string text_of(const std::string& command) const { return run(command).standard_output; }
};

TEST_F(Viz, MarksEveryContactOnTheSkin) {
  record("--count 20 --rate 60 --duration 2 --origin 100,0,-40");
  ASSERT_EQ(run("vestige replay man.mcap --contacts contacts.csv").exit_code, 0);
  const json all = seen();
  std::map<std::int64_t, std::map<std::string, glm::dmat4>> frames;
  for (const json& message : all["/viz/tf"]["messages"]) frames[message["log_time"]] = frames_of(message);
  std::map<std::pair<std::string, std::string>, json> marks;  // by frame and collider
  EXPECT_EQ(all["/viz/contacts"]["schema"], "foxglove.SceneUpdate");
  for (const json& message : all["/viz/contacts"]["messages"])
    for (json entity : message["entities"]) {
      auto metadata = metadata_of(entity);
      entity["time"] = message["log_time"];
      EXPECT_TRUE(marks.emplace(std::pair(metadata["frame"], metadata["collider"]), entity).second);
    }
  const auto rows = read_csv(folder_ / "contacts.csv");
  ASSERT_GT(rows.size(), 20U);
  ASSERT_EQ(marks.size(), rows.size());
  std::set<std::string> touched;
  for (const auto& row : rows) {
    const json& entity = marks.at({row.at("frame"), row.at("collider")});
    auto metadata = metadata_of(entity);
    EXPECT_EQ(entity["id"], "contact " + row.at("collider"));
    EXPECT_EQ(metadata["triangle"], row.at("triangle"));
    EXPECT_EQ(metadata["actuator"] == "none", row.at("actuator") == "0");
    touched.insert(metadata["actuator"]);
    EXPECT_EQ(entity["lifetime"]["sec"], 0);
    EXPECT_EQ(entity["lifetime"]["nsec"], 200'000'000);
    ASSERT_EQ(entity["spheres"].size(), 1U);
    const glm::dmat4& joint = frames.at(entity["time"]).at(entity["frame_id"]);
    EXPECT_NE(entity["frame_id"], "world") << "it would not stay on the skin";
    const glm::dvec3 place(joint * glm::dvec4(vector_of(entity["spheres"][0]["pose"]["position"]), 1));
    const glm::dvec3 expected(std::stod(row.at("x")), std::stod(row.at("y")), std::stod(row.at("z")));
    EXPECT_LT(glm::length(place - expected), 1e-5);
  }
  EXPECT_GT(touched.size(), 1U);
}

TEST_F(Viz, SaysTheDutyOfEachActuatorWheneverOneChanges) {
  record("--count 20 --rate 500 --duration 1", "--law speed --hold 40 --mesh-rate 0");
  ASSERT_EQ(run("vestige replay man.mcap --law speed --hold 40 --timeline timeline.csv").exit_code, 0);
  const json all = seen();
  EXPECT_FALSE(all.contains("/viz/mesh"));
  EXPECT_THAT(text_of("vestige inspect seen.mcap --json -"),
              AllOf(HasSubstr("/viz/actuators"), Not(HasSubstr("/viz/mesh"))))
      << "a channel without messages";
  const json& duties = all["/viz/actuators"];
  EXPECT_EQ(duties["schema"], "vestige.viz.Actuators");
  std::vector<std::string> names;
  const json replayed = json_of("vestige replay man.mcap --json -");
  for (const json& actuator : replayed["actuators"]) names.push_back(actuator["name"]);
  ASSERT_EQ(duties["messages"][0]["actuators"].size(), names.size());
  for (std::size_t i = 0; i < names.size(); ++i) EXPECT_EQ(duties["messages"][0]["actuators"][i]["name"], names[i]);
  // What is said last holds.
  std::size_t next = 0;
  std::vector<int> held;
  std::set<int> levels;
  for (const test::Row& row : test::read_timeline(folder_ / "timeline.csv")) {
    const auto time_ns = static_cast<std::int64_t>(std::llround(row.time_s * 1e9));
    for (; next < duties["messages"].size() && duties["messages"][next]["log_time"] <= time_ns; ++next) {
      held.clear();
      for (const json& actuator : duties["messages"][next]["actuators"]) held.push_back(actuator["duty"]);
    }
    ASSERT_EQ(held, row.level) << row.time_s;
    levels.insert(held.begin(), held.end());
  }
  EXPECT_GT(levels.size(), 3U);
  EXPECT_GE(duties["messages"].size(), 60U) << "a plot draws lines between messages";
  EXPECT_LT(duties["messages"].size(), 500U);
}

TEST_F(Viz, ShowsThePosedSkinInTheColoursOfTheRegions) {
  record("--count 1 --rate 60 --duration 1", "--mesh-rate 10");
  const json all = seen();
  const json& messages = all["/viz/mesh"]["messages"];
  ASSERT_EQ(messages.size(), 10U);
  const Avatar& avatar = test::builtin_avatar();
  TraceReader reader(folder_ / "man.mcap");
  TraceFrame frame;
  for (const json& message : messages) {
    while (frame.time_ns != message["log_time"] || frame.poses.front().nodes.empty()) ASSERT_TRUE(reader.next(frame));
    ASSERT_EQ(message["entities"].size(), 1U);
    const json& entity = message["entities"][0];
    EXPECT_EQ(entity["frame_id"], "avatar");
    EXPECT_EQ(entity["id"], "skin");
    const json& skin = entity["triangles"][0];
    std::vector<glm::dvec3> expected;
    skin_reference(avatar, frame.poses.front(), frame.poses.front().origin_m, expected);
    ASSERT_EQ(skin["points"].size(), expected.size());
    for (std::size_t i = 0; i < expected.size(); ++i)
      ASSERT_LT(glm::length(vector_of(skin["points"][i]) - expected[i]), 1.1e-4) << i;
    ASSERT_EQ(skin["indices"].size(), 3 * avatar.triangles.size());
    for (std::size_t i = 0; i < avatar.triangles.size(); ++i)
      ASSERT_EQ(skin["indices"][3 * i + 1], avatar.triangles[i].y);
    ASSERT_EQ(skin["colors"].size(), expected.size());
    std::map<std::string, std::size_t> colours;
    for (const json& colour : skin["colors"]) ++colours[colour.dump()];
    EXPECT_EQ(colours.size(), 1U + 6) << "of the skin and of six regions";
  }
}

TEST_F(Viz, ShowsTheSkinOnceAtATinyRate) {
  record("--count 1 --rate 60 --duration 0.5", "--mesh-rate 1e-11");
  EXPECT_EQ(seen()["/viz/mesh"]["messages"].size(), 1U);
}

TEST_F(Viz, KeepsTheTraceAndEveryVerbTakesIt) {
  record("--count 20 --rate 200 --duration 1 --viz");
  const std::string own = " | grep -v '\"topic\":\"/viz'";
  EXPECT_EQ(text_of("vestige cat seen.mcap" + own), text_of("vestige cat man.mcap" + own));
  EXPECT_EQ(run("vestige doctor seen.mcap").exit_code, 0);
  const json inspected = json_of("vestige inspect seen.mcap --json -");
  std::map<std::string, std::size_t> messages;
  for (const json& channel : inspected["channels"]) {
    EXPECT_FALSE(messages.contains(channel["topic"])) << "two channels " << channel["topic"];
    messages[channel["topic"]] = channel["messages"];
  }
  EXPECT_EQ(messages["/viz/tf"], 60U) << "those of the recording are replaced";
  EXPECT_EQ(messages["/viz/scene"], 60U);
  EXPECT_EQ(messages["/viz/mesh"], 15U);
  EXPECT_EQ(inspected["attachments"], json_of("vestige inspect man.mcap --json -")["attachments"]);
  const std::string hash = json_of("vestige replay man.mcap --json -")["texture_hash"];
  EXPECT_EQ(json_of("vestige replay seen.mcap --json -")["texture_hash"], hash);
  EXPECT_EQ(run("vestige trim seen.mcap --to 0.5 -o a.mcap && vestige trim seen.mcap --from 0.5 -o b.mcap && "
                "vestige merge a.mcap b.mcap -o ab.mcap && vestige recover seen.mcap -o r.mcap && "
                "vestige export seen.mcap -o tables && vestige import tables -o again.mcap && "
                "vestige viz seen.mcap -o twice.mcap")
                .exit_code,
            0);
  for (const char* trace : {"ab.mcap", "r.mcap", "again.mcap", "twice.mcap"})
    EXPECT_EQ(json_of(fmt::format("vestige replay {} --json -", trace))["texture_hash"], hash) << trace;
  EXPECT_EQ(text_of("vestige cat ab.mcap"), text_of("vestige cat seen.mcap"));
  EXPECT_EQ(text_of("vestige cat twice.mcap"), text_of("vestige cat seen.mcap"));
}

TEST_F(Viz, TheLayoutNamesWhatIsInTheFile) {
  record("--count 20 --rate 60 --duration 1", "--layout layout.json");
  const json all = seen();
  const json layout = json_in("layout.json");
  std::vector<std::string> panels;
  for (const auto& [panel, config] : layout["configById"].items()) panels.push_back(panel);
  EXPECT_THAT(panels, UnorderedElementsAre("3D!vestige", "Plot!vestige", "RawMessages!vestige"));
  for (const auto& [panel, config] : layout["configById"].items()) {
    EXPECT_TRUE(config.contains("foxglovePanelTitle")) << panel;
    EXPECT_EQ(config["lichtblickPanelTitle"], config["foxglovePanelTitle"]) << panel;
  }
  EXPECT_EQ(layout["layout"]["first"], "3D!vestige");
  EXPECT_EQ(layout["layout"]["second"]["first"], "Plot!vestige");
  EXPECT_EQ(layout["layout"]["second"]["second"], "RawMessages!vestige");
  const json& scene = layout["configById"]["3D!vestige"];
  const auto frames = frames_of(all["/viz/tf"]["messages"][0]);
  EXPECT_TRUE(frames.contains(scene["followTf"]));
  EXPECT_EQ(scene["transforms"].size(), frames.size());
  for (const auto& [frame, place] : frames) EXPECT_EQ(scene["transforms"]["frame:" + frame]["visible"], false) << frame;
  for (const auto& [topic, config] : scene["topics"].items())
    EXPECT_EQ(all[topic]["schema"], "foxglove.SceneUpdate") << topic;
  EXPECT_EQ(scene["topics"].size(), 3U);
  EXPECT_TRUE(all.contains(layout["configById"]["RawMessages!vestige"]["topicPath"]));
  const json& actuators = all["/viz/actuators"]["messages"][0]["actuators"];
  const json& paths = layout["configById"]["Plot!vestige"]["paths"];
  ASSERT_EQ(paths.size(), actuators.size());
  for (std::size_t i = 0; i < paths.size(); ++i) {
    EXPECT_EQ(paths[i]["value"], fmt::format("/viz/actuators.actuators[{}].duty", i));
    EXPECT_EQ(paths[i]["label"], actuators[i]["name"]);
  }
}

TEST_F(Viz, ShowsEachOfSeveralPeople) {
  record("--colliders touch --rate 120 --duration 2", "--layout layout.json");
  const json all = seen();
  std::set<std::string> skins;
  for (const json& entity : all["/viz/mesh"]["messages"][0]["entities"]) skins.insert(entity["id"]);
  EXPECT_THAT(skins, UnorderedElementsAre("skin", "skin 2"));
  std::vector<std::string> names;
  for (const json& actuator : all["/viz/actuators"]["messages"][0]["actuators"]) names.push_back(actuator["name"]);
  ASSERT_EQ(names.size(), 12U);
  for (std::size_t i = 0; i < 6; ++i) EXPECT_EQ(names[6 + i], "2/" + names[i]);
  std::size_t marks = 0;
  bool second_touched = false;
  for (const json& message : all["/viz/contacts"]["messages"])
    for (const json& entity : message["entities"]) {
      ++marks;
      const bool of_second = entity["id"].get<std::string>().ends_with(" on person 2");
      EXPECT_EQ(entity["frame_id"].get<std::string>().starts_with("2/"), of_second);
      second_touched |= of_second;
    }
  EXPECT_TRUE(second_touched);
  EXPECT_EQ(marks, json_of("vestige replay man.mcap --json -")["contacts"]);
  EXPECT_EQ(json_in("layout.json")["configById"]["Plot!vestige"]["paths"].size(), 12U);
}

TEST_F(Viz, KeepsWhatIsLeftOfADamagedTrace) {
  ASSERT_EQ(run("vestige record --count 20 --rate 500 --duration 2 -o man.mcap && "
                "size=$(stat -c %s man.mcap) && printf 'XXXX' | dd of=man.mcap bs=1 seek=$((size / 2)) conv=notrunc")
                .exit_code,
            0);
  const test::Outcome outcome = run("vestige viz man.mcap -o seen.mcap");
  EXPECT_EQ(outcome.exit_code, 3) << outcome.standard_error;
  EXPECT_THAT(outcome.standard_error, HasSubstr("man.mcap: "));
  EXPECT_EQ(run("vestige doctor seen.mcap").exit_code, 0) << "what is copied is sound";
  EXPECT_EQ(json_of("vestige replay seen.mcap --json -")["texture_hash"],
            json::parse(text_of("vestige replay man.mcap --json -"))["texture_hash"]);
}

TEST_F(Viz, SaysHowContactsAreFoundAndFelt) {
  record_small();
  const json report = json_of("vestige viz small.mcap -o small_seen.mcap --method ccd --hold 40 --json - -q");
  EXPECT_EQ(report["method"], "ccd");
  EXPECT_EQ(report["surface"], "all");
  EXPECT_EQ(report["law"], json({{"name", "binary"}, {"hold_ms", 40}}));
  record("--map none --duration 0.1", "--json silent.json");
  EXPECT_FALSE(json_in("silent.json").contains("law")) << "nobody has an actuator";
}

TEST_F(Viz, RefusesWhatItCannotDo) {
  record_small();
  expect_failure("vestige viz - -o seen.mcap <small.mcap", 2, {"TRACE", "read twice", "name a file"}, "seen.mcap");
  expect_failure("vestige viz small.mcap -o seen.csv", 2, {"seen.csv", "end the name in .mcap"}, "seen.csv");
  expect_failure("vestige viz small.mcap -o small.mcap", 2, {"small.mcap"});
  expect_failure("vestige viz small.mcap -o seen.mcap --mesh-rate 61", 2, {"--mesh-rate"}, "seen.mcap");
  expect_failure("vestige viz small.mcap -o seen.mcap --law depth", 1, {"small.mcap", "only spheres are felt"},
                 "seen.mcap");
  expect_failure("vestige viz small.mcap -o seen.mcap --layout seen.mcap", 2, {"seen.mcap"}, "seen.mcap");
}

}  // namespace
}  // namespace vestige
