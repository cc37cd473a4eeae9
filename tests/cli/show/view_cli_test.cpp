// Pages of `vestige view`, opened in a real browser as a reader does.

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <functional>
#include <map>
#include <sstream>

#include "tests/support/command_line.hpp"
#include "tests/support/duty_rows.hpp"
#include "tests/support/npm.hpp"

namespace vestige {
namespace {

using nlohmann::json;
using ::testing::AllOf;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::Gt;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Le;
using ::testing::Lt;
using ::testing::Not;

/// The fields of one line of CSV, none of which is quoted.
using Row = std::vector<std::string>;

class View : public test::CommandLineTest {
 protected:
  void SetUp() override {
    VESTIGE_REQUIRE_DATA("/usr/bin/chromium");
    VESTIGE_REQUIRE_DATA(test::npm_package("playwright-core"));
  }

  void make(const std::string& flags, const std::string& record_flags = "--count 40 --duration 0.5") const {
    const test::Outcome made =
        run("vestige record -q " + record_flags + " -o t.mcap && vestige view -q t.mcap -o page.html " + flags);
    ASSERT_EQ(made.exit_code, 0) << made.standard_error;
  }

  /// Opens a page, does what `options` say (tests/npm/browse_page.mjs), and expects that the browser has nothing to
  /// complain of and asks for nothing else. Returns what was seen.
  json browse(const json& options, const std::string& page = "page.html") const {
    const test::Outcome outcome =
        run("node '" VESTIGE_SOURCE_DIR "/tests/npm/browse_page.mjs' '" + page + "' '" + options.dump() + "'");
    EXPECT_EQ(outcome.exit_code, 0) << outcome.standard_error;
    json result = json::parse(outcome.standard_output, nullptr, false);
    EXPECT_THAT(result["complaints"], IsEmpty()) << result;
    EXPECT_THAT(result["requests"], IsEmpty()) << result;
    return result["seen"];
  }

  /// Records the frames of t.mcap, each changed, as again.mcap.
  void retell(const std::function<void(json&)>& change) const {
    ASSERT_EQ(run("vestige export -q t.mcap -o t.ndjson").exit_code, 0);
    std::istringstream lines(read_text_file(folder_ / "t.ndjson"));
    std::string changed;
    for (std::string line; std::getline(lines, line);) {
      json frame = json::parse(line);
      change(frame);
      changed += frame.dump() + "\n";
    }
    write("again.ndjson", changed);
    ASSERT_LE(run("vestige record -q --live - -o again.mcap < again.ndjson").exit_code, 3);
  }

  void expect_totals(const json& page, const std::map<std::int64_t, std::vector<Row>>& contacts) const;

  /// The rows of contacts.csv by frame.
  std::map<std::int64_t, std::vector<Row>> contacts_by_frame() const {
    std::map<std::int64_t, std::vector<Row>> rows;
    std::istringstream file(read_text_file(folder_ / "contacts.csv"));
    std::string line;
    for (std::getline(file, line); std::getline(file, line);) {
      Row row;
      std::istringstream fields(line);
      for (std::string field; std::getline(fields, field, ',');) row.push_back(field);
      rows[std::stoll(row[0])].push_back(row);
    }
    return rows;
  }
};

const json kSee = {{"see", true}};

json press(const std::string& key) {
  return {{"press", key}, {"see", true}};
}

TEST_F(View, DrawsTheBodyAndStandsStillWhereTheReaderWantsNoMotion) {
  make("");
  const json seen = browse({{"steps", {kSee, kSee}}});
  EXPECT_EQ(seen[0]["title"], "t.mcap");
  EXPECT_THAT(seen[0]["about"].get<std::string>(),
              AllOf(HasSubstr("500 frames"), HasSubstr("40 colliders"), HasSubstr("detector cpu")));
  EXPECT_THAT(seen[0]["middle"]["opaque"].get<double>(), Gt(0.2)) << seen;
  EXPECT_THAT(seen[0]["middle"]["colourful"].get<double>(), Gt(0.04)) << "regions have colours";
  EXPECT_EQ(seen[0]["failure"], "");
  EXPECT_THAT(seen[0]["warnings"], IsEmpty());
  EXPECT_EQ(seen[0]["play"], "Play");
  EXPECT_EQ(seen[0], seen[1]) << "nothing moves";
}

TEST_F(View, SaysHowContactsAreFoundAndFelt) {
  make("--method ccd --surface mapped --hold 40 --json view.json");
  EXPECT_THAT(browse({{"steps", {kSee}}})[0]["about"].get<std::string>(),
              HasSubstr("detector cpu · method ccd · surface mapped · law binary, hold 40 ms"));
  const json report = json_in("view.json");
  EXPECT_EQ(report["method"], "ccd");
  EXPECT_EQ(report["surface"], "mapped");
  EXPECT_EQ(report["law"], json({{"name", "binary"}, {"hold_ms", 40}}));
}

TEST_F(View, PlaysToTheEndWhereTheReaderDoesNotMind) {
  make("", "--count 40 --duration 0.2");
  const json seen = browse({{"motion", true}, {"steps", {{{"wait_for", "Play"}}, kSee}}});
  EXPECT_EQ(seen[0]["frame"], 199);
}

/// Expects in the table of the whole trace what contacts.csv and timeline.csv say: from the motor that is on longest to
/// the one that is on shortest.
void View::expect_totals(const json& page, const std::map<std::int64_t, std::vector<Row>>& contacts) const {
  std::map<std::string, std::map<std::string, int>> of_collider;  // by actuator
  for (const auto& [frame, rows] : contacts)
    for (const Row& row : rows) ++of_collider[page["actuators"][std::stoul(row[9])]][row[2]];
  const std::vector<test::Row> timeline = test::read_timeline(folder_ / "timeline.csv");
  double longest_s = 1e9;
  ASSERT_EQ(page["totals"].size(), timeline.front().level.size());
  for (const json& total : page["totals"]) {
    const std::string name = total[0];
    const auto column = std::ranges::find(page["actuators"], json(name)) - page["actuators"].begin() - 1;
    double on_s = 0;
    for (std::size_t i = 0; i < timeline.size(); ++i) {
      const std::size_t next = std::min(i + 1, timeline.size() - 1);  // the last frame lasts as long as the one before
      if (timeline[i].level[static_cast<std::size_t>(column)] > 0)
        on_s += timeline[next].time_s - timeline[next - 1].time_s;
    }
    EXPECT_NEAR(std::stod(total[1].get<std::string>()), on_s, 0.0006) << name;
    EXPECT_LE(on_s, longest_s + 1e-9) << name;
    longest_s = on_s;
    int all = 0;
    int most = 0;
    std::string by = "–";
    for (const auto& [collider, count] : of_collider[name]) {
      all += count;
      if (count == most) by = "several";
      if (count > most) by = fmt::format("{} ({})", collider, count);
      most = std::max(most, count);
    }
    EXPECT_EQ(total[2], std::to_string(all)) << name;
    EXPECT_EQ(total[3], by) << name;
  }
}

// Every contact is on the page, at its frame, on the skin and at its collider, as exactly as the page says.
TEST_F(View, ShowsTheContactsOfTheCsv) {
  make("--json view.json", "--count 100 --duration 1");
  ASSERT_EQ(run("vestige replay -q t.mcap --contacts contacts.csv --timeline timeline.csv").exit_code, 0);
  const auto expected = contacts_by_frame();
  json steps = json::array({{{"gaps", true}}});
  for (int i = 0; i < 20; ++i) steps.push_back(press("n"));
  json seen = browse({{"steps", steps}});
  std::size_t contacts = 0;
  for (const auto& [frame, rows] : expected) contacts += rows.size();
  const json error_mm = json_in("view.json")["error_mm"];
  EXPECT_EQ(seen[0]["contacts"], contacts);
  EXPECT_THAT(seen[0]["skin"].get<double>(), AllOf(Gt(0), Lt(error_mm["skin"].get<double>())));
  EXPECT_THAT(seen[0]["collider"].get<double>(),
              AllOf(Gt(0), Lt(error_mm["skin"].get<double>() + error_mm["colliders"].get<double>())));
  EXPECT_THAT(error_mm["skin"].get<double>(), Lt(1)) << "a page for the eye";
  seen.erase(0);
  expect_totals(seen[0], expected);
  auto next = expected.begin();
  for (const json& page : seen) {
    ASSERT_NE(next, expected.end());
    EXPECT_EQ(page["frame"], next->first);
    ASSERT_EQ(page["contacts"].size(), next->second.size());
    for (std::size_t i = 0; i < next->second.size(); ++i) {
      const Row& row = next->second[i];
      EXPECT_EQ(page["contacts"][i][0], row[2]);
      EXPECT_EQ(page["contacts"][i][1], row[3]);
      EXPECT_NEAR(std::stod(page["contacts"][i][2].get<std::string>()), std::stod(row[4]), 0.0006);
      const std::size_t actuator = std::stoul(row[9]);
      EXPECT_EQ(page["contacts"][i][3],
                actuator == 0 ? json("no actuator") : page["actuators"][actuator]);  // after "any"
    }
    ++next;
  }
}

TEST_F(View, CountsTheLastFrameOfAMotorThatIsOnToTheEnd) {
  make("", "--colliders rest --count 1 --rate 10 --duration 1");
  EXPECT_EQ(browse({{"steps", {kSee}}})[0]["totals"][0], json({"upper torso, left", "0.700", "7", "0 (7)"}));
}

TEST_F(View, ScrubbingAndJumpingShowAnotherFrame) {
  make("");
  ASSERT_EQ(run("vestige replay -q t.mcap --contacts contacts.csv --timeline timeline.csv").exit_code, 0);
  std::int64_t of_torso = -1;
  std::string collider;
  for (const auto& [frame, rows] : contacts_by_frame())
    for (const Row& row : rows)
      if (of_torso < 0 && row[9] == "2") std::tie(of_torso, collider) = std::pair(frame, row[2]);
  ASSERT_GE(of_torso, 0);
  const json seen = browse({{"steps",
                             {kSee,
                              {{"scrub", 300}, {"see", true}},
                              {{"drag", {"#raster", 0.3, 0.9}}, {"see", true}},
                              {{"scrub", 0}},
                              {{"choose", {"#of-actuator", "upper torso, left"}}},
                              {{"click", "#contact-after"}, {"see", true}},
                              {{"scrub", 0}},
                              {{"choose", {"#of-collider", collider}}},
                              {{"click", "#contact-after"}, {"see", true}}}}});
  EXPECT_EQ(seen[1]["frame"], 300);
  EXPECT_EQ(seen[1]["time"], "0.3000 s");
  EXPECT_NE(seen[1]["picture"]["sum"], seen[0]["picture"]["sum"]);
  EXPECT_THAT(seen[2]["frame"].get<int>(), AllOf(Gt(400), Lt(490)));
  EXPECT_EQ(seen[3]["frame"], of_torso);
  EXPECT_EQ(seen[4]["frame"], of_torso);
  EXPECT_THAT(seen[4]["motors"], Contains(json({"255", "upper torso, left"})));
}

// A trace may have frames of one time: each can be reached, and each contact.
TEST_F(View, ShowsFramesOfOneTimeOneByOne) {
  ASSERT_EQ(run("vestige record -q --count 40 --duration 0.2 -o t.mcap").exit_code, 0);
  retell([](json& frame) {
    const int pair = frame["frame"].get<int>() / 2;
    frame["time_s"] = 0.002 * pair;
  });
  ASSERT_EQ(run("vestige view -q again.mcap -o page.html").exit_code, 0);
  const json seen = browse({{"steps",
                             {press("ArrowRight"), press("ArrowRight"), press("ArrowRight"), press("ArrowLeft"),
                              press("n"), press("n"), press("p")}}});
  EXPECT_EQ(seen[0]["frame"], 1);
  EXPECT_EQ(seen[1]["frame"], 2);
  EXPECT_EQ(seen[2]["frame"], 3);
  EXPECT_EQ(seen[3]["frame"], 2);
  EXPECT_THAT(seen[4]["contacts"], Not(IsEmpty()));
  EXPECT_THAT(seen[5]["contacts"], Not(IsEmpty()));
  EXPECT_EQ(seen[6]["frame"], seen[4]["frame"]);
}

// The page says how far skin is drawn from its place, at most. So a leap is not smeared over many frames.
TEST_F(View, ALeapIsSeenInItsFrame) {
  ASSERT_EQ(run("vestige record -q --animation none --count 1 --duration 0.2 -o t.mcap").exit_code, 0);
  retell([](json& frame) {
    if (frame["frame"].get<int>() >= 109) frame["pose"]["origin"][1] = 5;
  });
  ASSERT_EQ(run("vestige view -q again.mcap -o page.html").exit_code, 0);
  const json seen =
      browse({{"steps", {{{"press", "f"}, {"scrub", 108}, {"see", true}}, {{"scrub", 109}, {"see", true}}}}});
  EXPECT_THAT(seen[0]["middle"]["opaque"].get<double>(), Gt(0.2));
  EXPECT_THAT(seen[1]["middle"]["opaque"].get<double>(), Lt(0.02)) << "far above the picture";
}

TEST_F(View, SaysWhatIsNotFinite) {
  ASSERT_EQ(run("vestige record -q --count 1 --duration 0.2 -o t.mcap").exit_code, 0);
  retell([](json& frame) {
    if (frame["frame"].get<int>() == 100) frame["pose"]["nodes"][7][0] = 3e38;
  });
  EXPECT_EQ(run("vestige view -q again.mcap -o page.html").exit_code, 3);
  const json seen = browse({{"steps", {{{"scrub", 100}, {"see", true}}}}});
  EXPECT_THAT(seen[0]["warnings"], Contains(HasSubstr("not finite, the first in frame 100")));
  EXPECT_THAT(seen[0]["middle"]["opaque"].get<double>(), Gt(0.2)) << "the body stays where it was";
}

// An absurd place is finite, so the detector takes it; the page must not promise to show it.
TEST_F(View, SaysWhatIsTooFarAwayToDraw) {
  ASSERT_EQ(run("vestige record -q --count 3 --duration 0.2 -o t.mcap").exit_code, 0);
  retell([](json& frame) {
    if (frame["frame"] == 0) frame["pose"]["origin"] = {1e30, 0, 0};
    if (frame["frame"] == 100) frame["colliders"][1]["position"] = {0, 3e5, 0};
  });
  const test::Outcome made = run("vestige view again.mcap -o page.html");
  EXPECT_EQ(made.exit_code, 0);
  EXPECT_THAT(made.standard_error, HasSubstr("1 pose and 1 place of colliders cannot be drawn"));
  const json seen = browse({{"steps", {{{"scrub", 150}, {"see", true}}}}});
  EXPECT_THAT(seen[0]["warnings"], ElementsAre(HasSubstr("1 pose and 1 place")));
  EXPECT_THAT(seen[0]["middle"]["opaque"].get<double>(), Gt(0.2)) << "all others are";
}

TEST_F(View, LooksAtTheFaceOfWhoStandsTurned) {
  make("", "--count 1 --duration 0.05");
  const json ahead = browse({{"steps", {kSee, press("3")}}});
  make("--force", "--force --at 0,0,0,180 --count 1 --duration 0.05");
  const json turned = browse({{"steps", {kSee}}});
  EXPECT_NEAR(turned[0]["middle"]["opaque"].get<double>(), ahead[0]["middle"]["opaque"].get<double>(), 0.005);
  EXPECT_NEAR(turned[0]["middle"]["colourful"].get<double>(), ahead[0]["middle"]["colourful"].get<double>(), 0.002);
  EXPECT_NE(ahead[0]["picture"]["sum"], ahead[1]["picture"]["sum"]);
}

// Playing, pausing and looking around at once neither plays faster nor loses what was asked for.
TEST_F(View, ManyCommandsAtOnceAreAllObeyed) {
  make("");
  const std::string commands = "for (let i = 0; i < 9; ++i) vestige.toggle(); vestige.seekRow(200); vestige.pause()";
  const json seen = browse(
      {{"steps",
        {{{"run", commands}, {"see", true}}, {{"run", "vestige.raster.zoom(0.1, 0.4)"}, {"see_timeline", true}}}}});
  EXPECT_EQ(seen[0]["frame"], 200);
  EXPECT_THAT(seen[1][0].get<double>(), Gt(0.3)) << "the part that was asked for, though the cursor is elsewhere";
}

TEST_F(View, ObeysTheKeyboard) {
  make("");
  json steps = json::array({kSee});
  for (const char* key :
       {"End", "Home", "ArrowRight", "Shift+ArrowRight", "ArrowLeft", "[", "]", "2", "1", "b", "b", "g", "c"})
    steps.push_back(press(key));
  // So slow that it is still playing when the second key comes, however busy the machine is.
  steps.push_back({{"choose", {"#speed", "1/50"}}});
  steps.push_back({{"press", " "}, {"wait_for", "Pause"}});
  steps.push_back({{"run", "new Promise((done) => setInterval(() => { if (vestige.row > 10) done(); }, 10))"}});
  steps.push_back(press(" "));
  steps.push_back(press("?"));
  const json seen = browse({{"steps", steps}});
  EXPECT_EQ(seen[1]["frame"], 499);
  EXPECT_EQ(seen[2]["frame"], 0);
  EXPECT_EQ(seen[3]["frame"], 1);
  EXPECT_EQ(seen[4]["frame"], 11);
  EXPECT_EQ(seen[5]["frame"], 10);
  EXPECT_EQ(seen[6]["speed"], "1/2");
  EXPECT_EQ(seen[7]["speed"], "1");
  EXPECT_NE(seen[8]["picture"]["sum"], seen[7]["picture"]["sum"]) << "from behind";
  EXPECT_NE(seen[9]["picture"]["sum"], seen[8]["picture"]["sum"]);
  EXPECT_THAT(seen[10]["picture"]["opaque"].get<double>(), Lt(seen[9]["picture"]["opaque"].get<double>() / 2));
  EXPECT_EQ(seen[11]["picture"], seen[9]["picture"]);
  EXPECT_THAT(seen[12]["picture"]["colourful"].get<double>(), Lt(0.002)) << "no regions";
  EXPECT_THAT(seen[13]["picture"]["opaque"].get<double>(), Lt(seen[12]["picture"]["opaque"].get<double>()));
  EXPECT_EQ(seen[14]["play"], "Play");
  EXPECT_THAT(seen[14]["frame"].get<int>(), Gt(10));
  EXPECT_EQ(seen[15]["help"], true);
}

TEST_F(View, NamesStayText) {
  const std::string name = "<img src=x onerror=alert(1)> <script>'&\".mcap";
  ASSERT_EQ(run("vestige map make -q --layout paper6 --save-regions r.json -o a.png && "
                "sed -i 's|upper torso, right|<img src=x onerror=alert(2)>|; s|upper torso, left|</script><!--<b>|' "
                "r.json && "
                "vestige map make -q --regions r.json -o b.png && "
                "vestige record -q --map b.png --count 40 --duration 0.5 -o t.mcap && "
                "cp t.mcap \"$(cat <<'END'\n" +
                name + "\nEND\n)\" && vestige view -q -o page.html \"$(cat <<'END'\n" + name + "\nEND\n)\"")
                .exit_code,
            0);
  const json seen = browse({{"steps", {press("n")}}});
  EXPECT_EQ(seen[0]["title"], name);
  EXPECT_EQ(seen[0]["tab"], name);
  EXPECT_EQ(seen[0]["actuators"][1], "<img src=x onerror=alert(2)>");
  EXPECT_EQ(seen[0]["actuators"][2], "</script><!--<b>");
  EXPECT_EQ(seen[0]["images"], 0);
}

TEST_F(View, TwoMapsStandSideBySide) {
  make("--maps paper6 none");
  const json seen = browse({{"steps", {kSee, press("d")}}});
  EXPECT_THAT(seen[0]["left"]["colourful"].get<double>(), Gt(0.01));
  EXPECT_THAT(seen[0]["right"]["colourful"].get<double>(), Lt(0.002)) << "no regions";
  EXPECT_THAT(seen[0]["right"]["opaque"].get<double>(), Gt(0.05));
  EXPECT_EQ(seen[0]["sides"], json({"paper6", "none"}));
  EXPECT_THAT(seen[1]["alone"], ElementsAre(HasSubstr("paper6: "))) << "felt on the left only";
}

TEST_F(View, MarksWhatOneDetectorMisses) {
  make("--detectors boxes,cpu --json view.json", "--count 100 --duration 1");
  const json sides = json_in("view.json")["sides"];
  EXPECT_EQ(sides[1]["detector"], "cpu");
  EXPECT_NE(sides[0]["contacts"], sides[1]["contacts"]);
  json steps = json::array();
  for (int i = 0; i < 10; ++i) steps.push_back(press("d"));
  int frame = 0;
  for (const json& seen : browse({{"steps", steps}})) {
    EXPECT_THAT(seen["alone"], Not(IsEmpty()));
    EXPECT_THAT(seen["frame"].get<int>(), Gt(frame));
    frame = seen["frame"].get<int>();
  }
  make("--force --detectors exact,cpu", "--force --count 20 --duration 0.1");
  const json same = browse({{"steps", {press("d")}}});
  EXPECT_EQ(same[0]["frame"], 0) << "no contact is on one side alone";
  EXPECT_THAT(same[0]["about"].get<std::string>(), HasSubstr("0 on one side alone"));
}

TEST_F(View, TakesTwoSidesHoweverTheyAreWritten) {
  record_small();
  const auto sides_of = [&](const std::string& flags) {
    return json_of("vestige view -q --force -o page.html " + flags + " --json -")["sides"];
  };
  const json sides = sides_of("--detectors cpu,boxes small.mcap");
  ASSERT_EQ(sides.size(), 2U);
  EXPECT_EQ(sides[1]["title"], "boxes");
  EXPECT_EQ(sides_of("small.mcap --detectors cpu boxes"), sides);
  EXPECT_EQ(sides_of("small.mcap --maps 1=paper6 none")[0]["title"], "paper6") << "there is one person";
  EXPECT_EQ(run("vestige view -q --force small.mcap --detectors decimated,cpu --keep 0.3").exit_code, 0);
}

TEST_F(View, AccuracyShowsWhatIsMissed) {
  const test::Outcome measured =
      run("vestige accuracy --detector cpu,boxes --method static --colliders swarm,still --count 20 --duration 0.4 "
          "--rate 90 --truth-rate 4000 --events 1 --check-frames 5 --passes 1 -o a");
  ASSERT_EQ(measured.exit_code, 0) << measured.standard_error;
  EXPECT_THAT(measured.standard_output, HasSubstr("a/missed.html: What cpu, static misses at 90 Hz in still;"));
  const json seen = browse({{"steps", {kSee, press("d")}}}, "a/missed.html");
  EXPECT_EQ(seen[0]["title"], "What cpu, static misses at 90 Hz in still");
  EXPECT_EQ(seen[0]["sides"], json({"cpu, static", "cpu, ccd"}));
  EXPECT_THAT(seen[0]["about"].get<std::string>(),
              HasSubstr("contacts of each frame, where accuracy's table counts events of 1 seed against true ones at "
                        "4000 Hz"));
  EXPECT_THAT(seen[1]["alone"], ElementsAre(HasSubstr("cpu, ccd: ")));
}

TEST_F(View, RefusesSidesThatCannotBe) {
  record_small();
  for (const auto& [flags, words] : std::vector<std::pair<std::string, std::string>>{
           {"--detectors cpu", "two sides"},
           {"--detectors cpu,exact,boxes", "two sides"},
           {"--detectors cpu,cqu", "did you mean 'cpu'"},
           {"--detectors cpu,exact --maps paper6 torso40", "excludes"},
           {"--detectors cpu,exact --detector cpu", "excludes"},
           {"--maps paper6 torso40 --map none", "excludes"},
           {"--maps paper6 -", "--maps: a map cannot come from"},
           {"--maps paper6 paper6", "the same"},
           {"--maps paper6,paper6", "the same"},
           {"--maps paper6 1=paper6", "the same"},
           {"--detectors cpu cpu", "named twice"},
           {"--detectors boxes,cpu --keep 0.5", "--detectors boxes,cpu"},
           {"--detectors decimated,paper --method carried", "choose the detector geometry, compute or cpu"}})
    expect_failure("vestige view small.mcap " + flags, 2, {words}, "small.html");
  expect_failure("vestige view small.mcap --maps paper6 nowhere.png", 1, {"nowhere.png"}, "small.html");
}

TEST_F(View, FitsAPhone) {
  make("--map torso40");
  const json seen = browse({{"width", 360}, {"height", 700}, {"steps", {press("n")}}});
  EXPECT_EQ(seen[0]["width"], 360) << "nothing to scroll sideways";
  EXPECT_THAT(seen[0]["middle"]["opaque"].get<double>(), Gt(0.2));
}

TEST_F(View, WithoutWebGlThereAreStills) {
  make("");
  const json seen = browse({{"webgl", false}, {"steps", {kSee, press("End"), press("2")}}});
  EXPECT_THAT(seen[0]["failure"].get<std::string>(), HasSubstr("WebGL"));
  EXPECT_THAT(seen[0]["middle"]["colourful"].get<double>(), Gt(0.04));
  EXPECT_EQ(seen[1]["frame"], 499);
  EXPECT_NE(seen[1]["picture"]["sum"], seen[0]["picture"]["sum"]);
  EXPECT_NE(seen[2]["picture"]["sum"], seen[1]["picture"]["sum"]);
}

TEST_F(View, ShowsWhatIsLeftOfADamagedTrace) {
  ASSERT_EQ(run("vestige record -q --count 40 --duration 1 -o t.mcap && truncate -s -100000 t.mcap").exit_code, 0);
  const test::Outcome outcome = run("vestige view -q t.mcap -o page.html");
  EXPECT_EQ(outcome.exit_code, 3) << outcome.standard_error;
  const json seen = browse({{"steps", {press("End")}}});
  EXPECT_THAT(seen[0]["warnings"], Not(IsEmpty()));
  EXPECT_THAT(seen[0]["frame"].get<int>(), AllOf(Gt(50), Lt(999)));
  EXPECT_THAT(seen[0]["middle"]["opaque"].get<double>(), Gt(0.2));
}

TEST_F(View, ShowsSceneryOfAnySize) {
  make("", "--colliders none --duration 0.1");
  EXPECT_EQ(browse({{"steps", {press("n")}}})[0]["frame"], 0) << "there is no contact to go to";
  make("--force", "--force --count 1000 --duration 0.05");
  EXPECT_THAT(browse({{"steps", {press("End")}}})[0]["about"].get<std::string>(), HasSubstr("1,000 colliders"));
  make("--force", "--force --avatar builtin --name ann --avatar builtin --name bob --at 0,0,0.9,180 --duration 0.1");
  const json two = browse({{"steps", {kSee}}});
  EXPECT_THAT(two[0]["middle"]["opaque"].get<double>(), Gt(0.2));
  EXPECT_THAT(two[0]["actuators"], AllOf(Contains("ann: upper torso, left"), Contains("bob: no actuator")));
}

TEST_F(View, PagesAreSmall) {
  make("--json two.json", "--count 100 --duration 2");
  EXPECT_THAT(json_in("two.json")["bytes"].get<double>(), Le(4e6));
  make("--force --json minute.json", "--force --count 100 --duration 60");
  EXPECT_THAT(json_in("minute.json")["bytes"].get<double>(), Le(25e6));
}

TEST_F(View, WritesBesideTheTraceOrToStandardOutput) {
  record_small();
  ASSERT_EQ(run("vestige view -q small.mcap && vestige view -q small.mcap -o - > b.html").exit_code, 0);
  EXPECT_EQ(read_text_file(folder_ / "small.html"), read_text_file(folder_ / "b.html"));
  expect_failure("vestige view small.mcap", 1, {"small.html", "--force"});
  expect_failure("vestige view small.mcap --open -o -", 2, {"--open", "-o"});
  expect_failure("vestige view - < small.mcap", 2, {"-o OUT.html"});
  ASSERT_EQ(run("vestige view -q --force --map none small.mcap").exit_code, 0) << "--map takes one value";
  expect_failure("vestige view none.mcap -o c.html", 1, {"none.mcap"}, "c.html");
  expect_failure("vestige view small.mcap -o missing/c.html", 1, {"missing"});
  expect_failure(
      "vestige record -q --duration 0 -o e.mcap; head -c 100 small.mcap > e.mcap; vestige view e.mcap -o c.html", 1,
      {"e.mcap"}, "c.html");
}

TEST(ViewScripts, AreClean) {
  VESTIGE_REQUIRE_DATA(test::npm_package("eslint"));
  EXPECT_EQ(test::run_node("lint_page.mjs", VESTIGE_SOURCE_DIR "/analysis/view/page"), "[]\n");
}

}  // namespace
}  // namespace vestige
