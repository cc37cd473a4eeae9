// 'vestige map' as a user runs it.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "tests/support/command_line.hpp"
#include "tests/support/gl/gl_context.hpp"
#include "traces/files/input_file.hpp"

namespace vestige {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

class Map : public test::CommandLineTest {};

TEST_F(Map, IsMadeCheckedAndRecordedByItsFileOrItsName) {
  const auto made = json_of("vestige map make --layout torso16 -o vest.png --json -");
  ASSERT_EQ(made["actuators"].size(), 16U);
  EXPECT_EQ(made["texels_in_conflict"], 0);
  const auto sidecar = nlohmann::json::parse(read_text_file(folder_ / "vest.json"));
  EXPECT_EQ(sidecar["actuators"][3]["name"], "chest right");
  EXPECT_EQ(sidecar["actuators"][3]["position_m"].size(), 3U);
  const auto checked = json_of("vestige map check vest.png --json -");
  EXPECT_EQ(checked["good"], true);
  EXPECT_EQ(checked["actuators"].size(), 16U);

  ASSERT_EQ(run("vestige record --count 20 --rate 60 --duration 1 --map vest.png -o file.mcap && "
                "vestige record --count 20 --rate 60 --duration 1 --map torso16 -o name.mcap")
                .exit_code,
            0);
  const auto hash = [&](const char* trace) {
    return json_of(std::string("vestige replay ") + trace + " --json -")["texture_hash"];
  };
  EXPECT_EQ(hash("file.mcap"), hash("name.mcap"));
  ASSERT_EQ(run("vestige record --count 20 --rate 60 --duration 1 -o builtin.mcap").exit_code, 0);
  EXPECT_NE(hash("name.mcap"), hash("builtin.mcap"));
}

TEST_F(Map, OfALayoutsOwnRegionFileIsTheLayout) {
  ASSERT_EQ(run("vestige map make --layout torso40 -o a.png --save-regions mine.json && "
                "vestige map make --regions mine.json -o b.png")
                .exit_code,
            0);
  EXPECT_EQ(read_file(folder_ / "a.png"), read_file(folder_ / "b.png"));
  EXPECT_EQ(read_file(folder_ / "a.json"), read_file(folder_ / "b.json"));
}

TEST_F(Map, MayBeMadeByTriangle) {
  EXPECT_THAT(run("vestige map make --layout torso16 --per-triangle -o vest.png").standard_output,
              HasSubstr("16 actuators"));
  EXPECT_EQ(nlohmann::json::parse(read_text_file(folder_ / "vest.json"))["triangles"], 4998);
  EXPECT_EQ(run("vestige map check vest.png").exit_code, 0);
  const test::Outcome split = run("vestige map make --layout paper6 --per-triangle -o split.png");
  EXPECT_EQ(split.exit_code, 0);
  EXPECT_THAT(split.standard_error, HasSubstr("2 pieces")) << "what 'map check' finds wrong";
  ASSERT_EQ(run("vestige record --colliders hug --count 50 --rate 60 --duration 1 --map vest.png -o a.mcap").exit_code,
            0);
  // Every detector looks it up: the published one on the GPU.
  const auto paper = json_of("vestige replay a.mcap --detector paper --json -" + test::gl_flags());
  const auto cpu = json_of("vestige replay a.mcap --detector cpu --json -");
  EXPECT_EQ(paper["actuators"], cpu["actuators"]);
  EXPECT_EQ(
      run("vestige replay a.mcap --detector cpu --verify geometry --surface mapped --law phantom --timeline a.csv "
          "-q" +
          test::gl_flags())
          .exit_code,
      0);
  expect_failure("vestige map make --layout torso16 --per-triangle --size 64 -o b.png", 2, {"--size"}, "b.png");
  EXPECT_EQ(
      run("vestige replay a.mcap --timeline a.csv --force -q && vestige plot timeline a.csv --map vest.png -o a -q")
          .exit_code,
      0);
  ASSERT_EQ(run("sed 's/\"skin\": \"[0-9a-f]/\"skin\": \"x/' vest.json > re.json && cp vest.png re.png").exit_code, 0);
  expect_failure("vestige record --map re.png -o b.mcap", 1, {"re.png", "another avatar", "--per-triangle"}, "b.mcap");
  // Alone it would look like an image in UV space.
  ASSERT_EQ(run("cp vest.png alone.png").exit_code, 0);
  expect_failure("vestige record --map alone.png -o b.mcap", 1, {"alone.png", "no sidecar", ".json"}, "b.mcap");
  const auto other = test::data("avatars/avatars/CesiumMan.glb");
  VESTIGE_REQUIRE_DATA(other);
  expect_failure("vestige record --map vest.png --avatar " + other.string() + " -o b.mcap", 1,
                 {"vest.png", "4998 triangles", "4672", "--per-triangle"}, "b.mcap");
}

TEST_F(Map, CheckFailsWithCauseAndRemedy) {
  ASSERT_EQ(run("vestige avatar --map-output map.png && sed -i 's/\"grey\": 240/\"grey\": 241/; "
                "s/\"actuators\": \\[/\"actuators\": [{\"grey\": 240}, /' map.json")
                .exit_code,
            0);
  const test::Outcome check = run("vestige map check map.png");
  EXPECT_EQ(check.exit_code, 4);
  EXPECT_THAT(check.standard_output, AllOf(HasSubstr("problem: actuator 7 'lower torso, left' can never fire"),
                                           HasSubstr("take it out of the sidecar")));
  EXPECT_EQ(run("vestige map check builtin").exit_code, 0);
}

TEST_F(Map, IsWrittenWithItsSidecarOrNotAtAll) {
  // Once the map itself is written, the disk is full.
  ASSERT_EQ(run("ln -s /dev/full a.json").exit_code, 0);
  expect_failure("vestige map make --layout torso16 --force -o a.png", 1, {"a.json", "No space left"}, "a.png");
  // A sidecar that cannot be read is not as if there were none.
  ASSERT_EQ(run("vestige map make --layout torso16 -o b.png && ln -sf nowhere b.json").exit_code, 0);
  expect_failure("vestige map check b.png", 1, {"b.json"});
}

TEST_F(Map, ThatEachTriangleHasItsOwnActuatorIsNoLoss) {
  const auto avatar = test::data("avatars/avatars/KayKit_Knight.glb");
  VESTIGE_REQUIRE_DATA(avatar);
  const test::Outcome made = run("vestige map make --layout torso16 -o knight.png --avatar " + avatar.string());
  EXPECT_EQ(made.exit_code, 0);
  EXPECT_THAT(made.standard_error, HasSubstr("gives each triangle an actuator instead"));
  EXPECT_THAT(made.standard_output, HasSubstr("a texel for each triangle"));
}

TEST_F(Map, SaysWhatIsWrongWithWhatItIsGiven) {
  expect_failure("vestige map make -o a.png", 2, {"--layout", "--regions"}, "a.png");
  expect_failure("vestige map make --layout torso17 -o a.png", 2, {"torso17"}, "a.png");
  expect_failure("vestige map make --layout torso16 -o a.jpg", 2, {"a.jpg", ".png"}, "a.jpg");
  expect_failure("vestige map make --layout torso16 -o -", 2, {"two files"});
  expect_failure("vestige map make --layout torso16 -o no/such/a.png", 1, {"no/such"});
  expect_failure("vestige map make --regions none.json -o a.png", 1, {"none.json"}, "a.png");
  write("mine.json", R"({"regions": [{"name": "arm", "below": ["upper_arm_lfet"]}]})");
  expect_failure("vestige map make --regions mine.json -o a.png", 1,
                 {"mine.json, region 'arm'", "did you mean 'upper_arm_left'?"}, "a.png");
  write("mine.json", R"({"regions": [{"name": "a\u0000b"}]})");
  expect_failure("vestige map make --regions mine.json -o a.png", 1, {"'name'", "control character"}, "a.png");
  write("mine.json", R"({"regions": [{"name": "arm", "hieght": [0, 1]}]})");
  expect_failure("vestige map make --regions mine.json -o a.png", 1, {"did you mean 'height'?"}, "a.json");
  write("mine.json", R"({"regions": [{"name": "a"}, {"name": "b", "part": "head"}]})");
  expect_failure("vestige map make --regions mine.json -o a.png", 1, {"'b'", "no skin belongs to it"}, "a.png");
  // The sidecar must not take the place of the regions, whatever --force allows.
  expect_failure("vestige map make --regions mine.json --force -o mine.png", 2,
                 {"beside 'mine.png' comes 'mine.json', which the regions are in"}, "mine.png");
  // A height is a share of the skin of the region, not of the body.
  write("mine.json", R"({"regions": [{"name": "arm", "height": [0, 1.7]}]})");
  expect_failure("vestige map make --regions mine.json -o a.png", 1, {"0 is its lowest point", "'height_m'"}, "a.png");
  ASSERT_EQ(run("touch a.json").exit_code, 0);
  expect_failure("vestige map make --layout torso16 -o a.png", 1, {"a.json", "--force"}, "a.png");
  expect_failure("vestige map check missing.png", 1, {"missing.png"});
  expect_failure("vestige map check none", 2, {"nothing to check"});
}

TEST_F(Map, OfAnAvatarWithoutTextureCoordinatesIsRefused) {
  const auto path = test::data("avatars/skin/SimpleSkin.gltf");
  VESTIGE_REQUIRE_DATA(path);
  write("skin.json", R"({"regions": [{"name": "skin"}]})");
  expect_failure("vestige map make --regions skin.json -o a.png --avatar " + path.string(), 1,
                 {"has no texture coordinates", "--per-triangle"}, "a.png");
  EXPECT_EQ(run("vestige map make --regions skin.json --per-triangle -o a.png --avatar " + path.string()).exit_code, 0);
  expect_failure("vestige map check builtin --avatar " + path.string(), 1, {"has no texture coordinates"});
}

TEST_F(Map, PartsListsWhatRegionsMayName) {
  const auto parts = json_of("vestige map parts --json -");
  EXPECT_EQ(parts["parts_by"], "joints");
  EXPECT_NEAR(parts["parts_m2"]["thigh left"].get<double>(), parts["parts_m2"]["thigh right"].get<double>(), 1e-3);
  EXPECT_TRUE(parts["joints_m2"].contains("thoracic_spine"));
}

TEST_F(Map, PreviewDrawsIt) {
  if (run("vestige plot --help").exit_code != 0) GTEST_SKIP() << "BUILT WITHOUT VTK: NO PREVIEW WAS DRAWN";
  const test::Outcome drawn = run("vestige map preview paper6 -o picture -q");
  EXPECT_TRUE(drawn.exit_code == 0 || drawn.exit_code == 3) << drawn.standard_error;
  EXPECT_THAT(read_text_file(folder_ / "picture.svg"), HasSubstr("upper torso, right"));
}

TEST_F(Map, MayFireElsewhere) {
  write("regions.json", R"({"regions": [{"name": "belly", "part": "vest", "side": "front"},
                                        {"name": "back", "part": "vest", "side": "back"}],
                            "fires": {"belly": {"back": 0.5}}})");
  ASSERT_EQ(run("vestige map make --regions regions.json -o vest.png").exit_code, 0);
  EXPECT_THAT(run("vestige map check vest.png").standard_output,
              AllOf(HasSubstr("'belly' fires back (0.5)"), HasSubstr("actuator 1 'belly' never fires")));
  // A punch from the front is felt at the back, half as strong.
  ASSERT_EQ(run("vestige record --colliders punch --rate 100 --duration 1 --map vest.png -o punch.mcap").exit_code, 0);
  ASSERT_EQ(run("vestige replay punch.mcap --timeline timeline.csv --contacts contacts.csv -q").exit_code, 0);
  std::ifstream timeline(folder_ / "timeline.csv");
  std::string line;
  int most = 0;
  std::getline(timeline, line);
  while (std::getline(timeline, line)) {
    EXPECT_THAT(line, HasSubstr(",0,")) << "the belly's actuator fires";
    most = std::max(most, std::stoi(line.substr(line.rfind(',') + 1)));
  }
  EXPECT_EQ(most, 128);
  ASSERT_EQ(run("vestige batch --maps vest.png --traces punch.mcap --laws binary -o batch -q").exit_code, 0);
  write("regions.json", R"({"regions": [{"name": "belly", "part": "vest"}], "fires": {"belly": {"head": 1}}})");
  expect_failure("vestige map make --regions regions.json -o bad.png", 1, {"there is no actuator 'head'"}, "bad.png");
  if (run("vestige plot --help").exit_code != 0) GTEST_SKIP() << "BUILT WITHOUT VTK: NO PREVIEW WAS DRAWN";
  ASSERT_EQ(run("vestige map preview vest.png -o picture -q").exit_code, 0);
  EXPECT_THAT(read_text_file(folder_ / "picture.svg"), HasSubstr("belly → back (0.5)"));
}

}  // namespace
}  // namespace vestige
