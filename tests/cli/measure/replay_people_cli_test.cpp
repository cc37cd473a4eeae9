// A trace of several people, replayed as a user does.

#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputPart.h>
#include <ImfMultiPartInputFile.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

#include "tests/support/command_line.hpp"
#include "traces/base/sha256.hpp"
#include "traces/gltf/avatar_gltf.hpp"
#include "traces/trace_file/trace_reader.hpp"
#include "traces/trace_file/trace_writer.hpp"

namespace vestige {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

constexpr const char* kAnn = "--avatar builtin --name ann ";
constexpr const char* kBob = "--avatar builtin --name bob --at 0,0,0.9,180 ";
constexpr int kFrames = 20;
constexpr int kBalls = 16;

class ReplayOfPeople : public test::CommandLineTest {
 protected:
  /// Balls that fly through where both stand, at several heights.
  void SetUp() override {
    std::string balls = "time_s,id,x,y,z\n";
    for (int frame = 0; frame < kFrames; ++frame)
      for (int id = 0; id < kBalls; ++id)
        balls += std::to_string(frame / 60.0) + "," + std::to_string(id) + "," +
                 std::to_string((id % 2 == 0 ? 1 : -1) * (0.6 - 0.06 * frame)) + "," + std::to_string(0.2 + 0.1 * id) +
                 "," + std::to_string(id % 4 < 2 ? 0.02 : 0.88) + "\n";
    write("balls.csv", balls);
    record(std::string(kAnn) + kBob, "two.mcap");
  }
  void record(const std::string& people, const std::string& trace) const {
    const test::Outcome outcome =
        run("vestige record --rate 60 --duration 0.33 --colliders balls.csv " + people + "-o " + trace);
    ASSERT_EQ(outcome.exit_code, 0) << outcome.standard_error;
  }
  nlohmann::json replay(const std::string& flags, const std::string& trace = "two.mcap") const {
    return json_of("vestige replay " + trace + " -q --json - " + flags);
  }
  /// Returns what was found on the people, without how.
  static nlohmann::json found_on(nlohmann::json run) {
    for (nlohmann::json& person : run["avatars"])
      for (const char* field : {"skinning", "law"}) person.erase(field);
    return run["avatars"];
  }
  std::size_t lines_in(const std::string& file) const {
    return static_cast<std::size_t>(std::ranges::count(read_text_file(folder_ / file), '\n'));
  }

  /// Writes a copy of the trace whose frames were changed, and in which all people may have one name.
  void rewrite(const std::string& to, const std::function<void(TraceFrame&)>& change,
               const std::string& name = "") const {
    TraceReader reader(folder_ / "two.mcap", People::kSeveral);
    std::vector<Avatar> avatars;
    for (const RecordedPerson& person : reader.people()) avatars.push_back(parse_avatar_glb(person.avatar_glb, "glb"));
    std::vector<TracePerson> people;
    for (std::size_t i = 0; i < avatars.size(); ++i)
      people.push_back(
          {avatars[i], {.avatar_glb = reader.people()[i].avatar_glb}, name.empty() ? reader.people()[i].name : name});
    TraceWriter writer(folder_ / to, {{"argv", "test"}}, people, {});
    TraceFrame frame;
    while (reader.next(frame)) {
      change(frame);
      writer.write(frame);
    }
    writer.finish();
  }
};

TEST_F(ReplayOfPeople, FindsEachAsIfAlone) {
  record(kAnn, "ann.mcap");
  record(kBob, "bob.mcap");
  const nlohmann::json two = replay("");
  ASSERT_EQ(two["avatars"].size(), 2U);
  std::uint64_t contacts = 0;
  Sha256 both;
  for (std::size_t i = 0; i < 2; ++i) {
    const nlohmann::json alone = replay("", i == 0 ? "ann.mcap" : "bob.mcap");
    ASSERT_EQ(alone["avatars"].size(), 1U);
    EXPECT_EQ(alone["avatars"][0]["texture_hash"], alone["texture_hash"]);
    EXPECT_EQ(alone["avatars"][0]["actuators"], alone["actuators"]);
    EXPECT_GT(alone["contacts"], 3);
    EXPECT_EQ(two["avatars"][i]["name"], i == 0 ? "ann" : "bob");
    EXPECT_EQ(two["avatars"][i]["contacts"], alone["contacts"]);
    EXPECT_EQ(two["avatars"][i]["texture_hash"], alone["texture_hash"]);
    EXPECT_EQ(two["avatars"][i]["actuators"], alone["actuators"]);
    contacts += alone["contacts"].get<std::uint64_t>();
    const auto hash = alone["texture_hash"].get<std::string>();
    both.update(std::as_bytes(std::span(hash)));
  }
  EXPECT_EQ(two["contacts"], contacts);
  EXPECT_EQ(two["texture_hash"], both.hex());
  const std::string seen = run("vestige replay two.mcap").standard_output;
  EXPECT_THAT(seen, HasSubstr("\nann: "));
  EXPECT_THAT(seen, HasSubstr("\nbob: "));
}

TEST_F(ReplayOfPeople, AllDetectorsGiveOneHashByEachMethod) {
  for (const char* method : {"static", "carried", "ccd"}) {
    const std::string by_method = std::string("--method ") + method;
    const nlohmann::json exact = replay("--detector exact --threads 2 " + by_method);
    EXPECT_GT(exact["contacts"], 6);
    // own context: OSMesa is one of those compared
    for (const char* flags :
         {"--detector cpu", "--detector cpu --skip off", "--detector geometry", "--detector geometry --skip off",
          "--detector geometry --context osmesa", "--detector cpu --threads 3", "--detector geometry --threads 2"})
      EXPECT_EQ(found_on(replay(flags + (" " + by_method))), found_on(exact)) << flags << ", " << method;
  }
  const nlohmann::json paper = replay("--detector paper");
  EXPECT_EQ(paper["avatars"][1]["contacts"], replay("")["avatars"][1]["contacts"]);
}

TEST_F(ReplayOfPeople, WritesWhoWasTouched) {
  const nlohmann::json two = replay("--contacts c.csv --textures t.exr --timeline a.csv");
  std::istringstream csv(read_text_file(folder_ / "c.csv"));
  std::string line;
  std::getline(csv, line);
  EXPECT_THAT(line, ::testing::EndsWith(",z,avatar"));
  std::pair<int, int> before;
  std::size_t rows[3] = {};
  while (std::getline(csv, line)) {
    const std::pair<int, int> place = {std::stoi(line), line.back() - '0'};
    EXPECT_GE(place, before) << "frames, then people";
    before = place;
    ++rows[place.second];
  }
  for (std::size_t i = 0; i < 2; ++i) EXPECT_EQ(two["avatars"][i]["contacts"], rows[i + 1]);

  Imf::MultiPartInputFile parts((folder_ / "t.exr").c_str());
  ASSERT_EQ(parts.parts(), 2);
  for (int i = 0; i < 2; ++i) {
    EXPECT_EQ(parts.header(i).name(), i == 0 ? "ann" : "bob");
    EXPECT_EQ(parts.header(i).dataWindow().max.x, kBalls - 1);
    EXPECT_EQ(parts.header(i).dataWindow().max.y, kFrames - 1);
    std::vector<float> t(static_cast<std::size_t>(kBalls) * kFrames);
    Imf::FrameBuffer buffer;
    buffer.insert("t", Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(t.data()), 4, 4 * kBalls));
    Imf::InputPart part(parts, i);
    part.setFrameBuffer(buffer);
    part.readPixels(0, kFrames - 1);
    EXPECT_EQ(two["avatars"][static_cast<std::size_t>(i)]["contacts"],
              std::ranges::count_if(t, [](float value) { return std::isfinite(value); }));
  }

  record(kBob, "bob.mcap");
  replay("--timeline bob.csv", "bob.mcap");
  EXPECT_EQ(lines_in("a.csv"), kFrames + 1U);
  EXPECT_EQ(read_text_file(folder_ / "a.2.csv"), read_text_file(folder_ / "bob.csv"));
  expect_failure("vestige replay two.mcap --timeline a.csv", 1, {"a.csv", "--force"});
  std::filesystem::remove(folder_ / "a.csv");
  expect_failure("vestige replay two.mcap --timeline a.csv", 1, {"a.2.csv", "--force"}, "a.csv");
  expect_failure("vestige replay two.mcap --timeline b.csv --json b.2.csv", 2, {"b.2.csv", "share one file"}, "b.csv");
  expect_failure("vestige replay two.mcap --timeline -", 2, {"--timeline", "each of 2 people"});
  EXPECT_EQ(run("vestige replay two.mcap -q --map 1=none --timeline -").standard_output,
            read_text_file(folder_ / "a.2.csv"));
}

TEST_F(ReplayOfPeople, AreVerifiedByDetectorAndByFile) {
  EXPECT_EQ(replay("--verify exact")["verify"]["differing"], 0);
  for (const char* file : {"c.csv", "c.h5"}) {
    const nlohmann::json written = replay(std::string("--contacts ") + file);
    const nlohmann::json verified = replay(std::string("--verify ") + file)["verify"];
    EXPECT_EQ(verified["differing"], 0) << file;
    EXPECT_EQ(verified["expected"], written["contacts"]) << file;
  }
  run("vestige replay two.mcap --json r.json");
  EXPECT_EQ(run("vestige replay two.mcap --verify r.json").exit_code, 0);
  // The same contact, but on somebody else, and then on somebody who is not there.
  const std::string csv = read_text_file(folder_ / "c.csv");
  const auto verify_with = [&](const char* somebody) {
    std::string changed = csv;
    changed.replace(changed.rfind(",2\n") + 1, 2, somebody);
    write("changed.csv", changed);
    return "vestige replay two.mcap --verify changed.csv";
  };
  const test::Outcome outcome = run(verify_with("1\n"));
  EXPECT_EQ(outcome.exit_code, 4) << outcome.standard_error;
  EXPECT_THAT(outcome.standard_output, HasSubstr("2 contacts differ"));
  expect_failure(verify_with("3\n"), 1, {"changed.csv", "refers to avatar 3, but there are only 2"});
  expect_failure(verify_with("0\n"), 1, {"changed.csv", "avatar must be from 1 on"});
  run("sed 's/,[^,]*$//' c.csv > nobody.csv");
  expect_failure("vestige replay two.mcap --verify nobody.csv", 1, {"nobody.csv", "whom of the 2 people"});
}

TEST_F(ReplayOfPeople, TakeTheMapsThatTheyAreGiven) {
  const nlohmann::json as_recorded = replay("");
  const nlohmann::json two = replay("--map 2=torso40 --timeline a.csv");
  EXPECT_EQ(found_on(two)[0], found_on(as_recorded)[0]);
  EXPECT_EQ(two["avatars"][1]["actuators"].size(), 40U);
  EXPECT_EQ(two["map"], nlohmann::json({"2=torso40"}));
  const std::string timeline = read_text_file(folder_ / "a.2.csv");
  EXPECT_THAT(timeline.substr(0, timeline.find('\n')), ::testing::EndsWith(",actuator_40"));
  const test::Outcome without = run("vestige replay two.mcap --map 1=none --timeline b.csv");
  EXPECT_EQ(without.exit_code, 0) << without.standard_error;
  EXPECT_THAT(without.standard_error, HasSubstr("ann has no actuator, and so no timeline"));
  EXPECT_EQ(lines_in("b.csv"), kFrames + 1U) << "of bob, the first who has actuators";
  EXPECT_FALSE(std::filesystem::exists(folder_ / "b.2.csv"));
  record(kBob, "bob.mcap");
  EXPECT_EQ(found_on(replay("--map torso40", "bob.mcap"))[0], found_on(two)[1]);

  ASSERT_EQ(run("vestige map make --layout torso40 -o m.png").exit_code, 0);
  expect_failure("vestige replay two.mcap --map 2=m.png --json m.json --force", 2, {"m.json", "input"});
  expect_failure("vestige replay two.mcap --map 2=-", 2, {"--map", "standard input"});
  expect_failure("vestige replay two.mcap --map 99999999999999999999=builtin", 2, {"--map", "there is no person"});
  expect_failure("vestige replay two.mcap --map torso40", 2, {"--map", "holds 2 people", "--map 1=FILE"});
  expect_failure("vestige replay two.mcap --map 3=torso40", 2, {"--map", "there is no person 3", "2 people"});
  expect_failure("vestige replay two.mcap --map 0=torso40", 2, {"--map", "people count from 1"});
  expect_failure("vestige replay two.mcap --map 2=", 2, {"--map", "names no map"});
  for (const char* map : {"1.5=body", "K=torso40"})
    expect_failure(std::string("vestige replay two.mcap --map ") + map, 2,
                   {std::string("--map: '") + map + "': a person's number is expected", "--map 2=FILE.png"});
  EXPECT_EQ(run("cp m.png K=m.png && vestige replay bob.mcap --map K=m.png").exit_code, 0) << "a file of that name";
  expect_failure("vestige replay two.mcap --map 2=torso40 --map 2=builtin", 2, {"--map", "person 2 gets two maps"});
  expect_failure("vestige replay two.mcap --map 2=absent.png", 1, {"absent.png"});
  expect_failure("vestige replay two.mcap --map-at 0.1=builtin", 2, {"--map-at", "2 people"});
  expect_failure("vestige replay two.mcap --map 1=none --map 2=none --timeline d.csv", 2, {"--timeline"}, "d.csv");
}

TEST_F(ReplayOfPeople, APoseThatIsNotFiniteEmptiesThatPersonOnly) {
  rewrite("broken.mcap", [](TraceFrame& frame) {
    if (frame.index >= 8) frame.poses[1].origin_m.y = std::numeric_limits<double>::quiet_NaN();
  });
  const nlohmann::json sound = replay("");
  for (const char* detector : {"cpu", "geometry", "exact"}) {
    const test::Outcome outcome =
        run(std::string("vestige replay broken.mcap --json r.json --force --detector ") + detector);
    EXPECT_EQ(outcome.exit_code, 3) << outcome.standard_error;
    EXPECT_THAT(outcome.standard_error,
                HasSubstr("bob: 12 poses and the ends of 0 segments are not finite, the first in frame 8"));
    const nlohmann::json broken = json_in("r.json");
    EXPECT_EQ(broken["non_finite_frames"], 12);
    EXPECT_EQ(broken["avatars"][0]["contacts"], sound["avatars"][0]["contacts"]);
    EXPECT_LT(broken["avatars"][1]["contacts"], sound["avatars"][1]["contacts"]);
    EXPECT_EQ(broken["avatars"][1]["non_finite_frames"], 12);
  }
}

TEST_F(ReplayOfPeople, OfOneNameAreToldApart) {
  rewrite(
      "same.mcap", [](TraceFrame&) {}, "person 2");
  const nlohmann::json same = replay("--textures t.exr", "same.mcap");
  EXPECT_EQ(same["avatars"][0]["name"], "person 2");
  EXPECT_EQ(same["avatars"][1]["name"], "person 2*");
}

TEST_F(ReplayOfPeople, AnAvatarWhoseChannelIsDamagedLeavesTheOthers) {
  std::vector<std::byte> bytes = read_file(folder_ / "two.mcap");
  const std::string topic = "/pose/2";
  const auto same = [](std::byte a, char b) { return static_cast<char>(a) == b; };
  const auto next = [&] { return std::search(bytes.begin(), bytes.end(), topic.begin(), topic.end(), same); };
  for (auto at = next(); at != bytes.end(); at = next()) at[1] = std::byte{'q'};
  write("damaged.mcap", bytes);
  const nlohmann::json sound = replay("");
  const test::Outcome outcome = run("vestige replay damaged.mcap --json r.json");
  EXPECT_EQ(outcome.exit_code, 3) << outcome.standard_error;
  EXPECT_THAT(outcome.standard_error, HasSubstr("there is no channel /pose/2, so person 2 has no pose in any frame"));
  const nlohmann::json damaged = json_in("r.json");
  EXPECT_EQ(damaged["avatars"][0], sound["avatars"][0]);
  EXPECT_EQ(damaged["avatars"][1]["contacts"], 0);
  EXPECT_EQ(damaged["frames"], kFrames);
}

}  // namespace
}  // namespace vestige
