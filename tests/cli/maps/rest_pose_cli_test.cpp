// Avatars that do not stand at rest, and those that are one point.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "tests/support/command_line.hpp"
#include "tests/support/made/edited_glb.hpp"
#include "tests/traces/motion/made_motion.hpp"
#include "traces/gltf/avatar_gltf.hpp"
#include "traces/scene/builtin_avatar.hpp"
#include "traces/trace_file/trace_writer.hpp"

namespace vestige {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

/// A folder with back.glb, which lies on its back, upside.glb, which hangs by its feet, and a motion.
class RestPose : public test::CommandLineTest {
 protected:
  RestPose() {
    write("back.glb", test::laid_glb(builtin_avatar_glb(), -90, {1, 0, 0}));
    write("upside.glb", test::laid_glb(builtin_avatar_glb(), 180, {0, 0, 1}));
    write("walk.bvh", test::made_bvh(test::made_motion("walk"), "y", "T"));
  }
  /// The built-in avatar scaled to a point, after `edit`.
  template <typename Edit>
  void write_point(const std::string& file, const Edit& edit) const {
    write(file, test::edited_glb(builtin_avatar_glb(), [&](nlohmann::json& json) {
            test::hang_below(json, {{"name", "hidden"}, {"scale", {0, 0, 0}}});
            edit(json);
          }));
  }

  static constexpr const char* kLies = "does not stand: at rest, its head lies 90 degrees away from +Y";
};

TEST_F(RestPose, ThatLiesIsToldInPlaceOfAFacing) {
  const test::Outcome back = run("vestige avatar back.glb");
  EXPECT_EQ(back.exit_code, 0);
  EXPECT_THAT(back.standard_output, AllOf(HasSubstr("though it does not stand"), Not(HasSubstr("by its feet"))));
  EXPECT_THAT(back.standard_error, HasSubstr(std::string("back.glb: ") + kLies));
  const auto json = json_of("vestige avatar upside.glb --json -");
  EXPECT_NEAR(json["lies_deg"].get<double>(), 180, 5);
  EXPECT_EQ(json["facing_by"], "assumed");
  EXPECT_TRUE(json_of("vestige avatar --json -")["lies_deg"].is_null());
  const test::Outcome parts = run("vestige map parts --avatar back.glb");
  EXPECT_THAT(parts.standard_output, AllOf(HasSubstr("cm²  hand\n"), HasSubstr("  hand_left\n")));
  EXPECT_THAT(parts.standard_output, AllOf(Not(HasSubstr("hand left")), Not(HasSubstr("vest\n"))));
}

TEST_F(RestPose, ThatLiesTakesNoMotionAndNoLayout) {
  for (const std::string file : {"back", "upside"})
    for (const std::string command :
         {"record --animation walk.bvh --duration 0.1 -o a.mcap", "record --animation walk.bvh --facing -x -o a.mcap",
          "import --motion walk.bvh -o a.mcap", "record --map torso16 --duration 0.1 -o a.mcap",
          "map make --layout body -o a.mcap.png", "map check torso40"}) {
      const test::Outcome refused = run("vestige " + command + " --avatar " + file + ".glb");
      EXPECT_EQ(refused.exit_code, 1) << command;
      EXPECT_THAT(refused.standard_error, AllOf(HasSubstr("error: "), HasSubstr(": the avatar does not stand"),
                                                HasSubstr(file == "back" ? "turn the avatar's root node by 90 degrees"
                                                                         : "turn the avatar's root node by 18")))
          << command;
      EXPECT_FALSE(std::filesystem::exists(folder_ / "a.mcap")) << command;
      EXPECT_FALSE(std::filesystem::exists(folder_ / "a.mcap.png")) << command;
    }
}

TEST_F(RestPose, ThatLiesIsRecordedWithItsOwnAnimationAndAGivenMap) {
  ASSERT_EQ(run("vestige map make --layout torso16 -o map.png").exit_code, 0);
  const test::Outcome recorded =
      run("vestige record --avatar back.glb --animation walk --map map.png --count 10 --duration 0.2 -o a.mcap");
  EXPECT_EQ(recorded.exit_code, 0);
  EXPECT_EQ(recorded.standard_error, std::string("vestige: warning: back.glb: ") + kLies +
                                         " as seen from its hips; its left and its front are not known\n");
  EXPECT_EQ(run("vestige replay a.mcap").exit_code, 0);
  const test::Outcome laid_on = run("vestige replay a.mcap --map-at 0=torso16");
  EXPECT_EQ(laid_on.exit_code, 1);
  EXPECT_THAT(laid_on.standard_error, HasSubstr("the avatar does not stand"));
}

TEST_F(RestPose, ThatIsAPointHasNoSurface) {
  write_point("point.glb", [](const nlohmann::json&) {});
  const test::Outcome refused = run("vestige record --avatar point.glb --duration 0.1 -o a.mcap");
  EXPECT_EQ(refused.exit_code, 1);
  EXPECT_THAT(refused.standard_error,
              AllOf(HasSubstr("point.glb: its whole skin lies in one point at rest, so it has no surface to touch"),
                    HasSubstr("set the scale of its root node to 1")));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "a.mcap"));

  const std::vector<std::byte> glb = read_avatar_glb(folder_ / "point.glb");
  const Avatar avatar = parse_avatar_glb(glb, "point.glb");
  TraceWriter trace(folder_ / "older.mcap", {}, {{avatar, {glb, {}, {}}}}, {});
  TraceFrame frame;
  frame.poses.front() = rest_pose(avatar);
  trace.write(frame);
  trace.finish();
  const test::Outcome replayed = run("vestige replay older.mcap");
  EXPECT_EQ(replayed.exit_code, 1);
  EXPECT_THAT(replayed.standard_error, HasSubstr("older.mcap, avatar.glb: its whole skin lies in one point"));
  EXPECT_EQ(run("vestige export older.mcap -o older").exit_code, 0);
}

/// An animation may hide the avatar at rest and show it later.
TEST_F(RestPose, ThatIsAPointIsTakenIfAnAnimationScalesIt) {
  write_point("hidden.glb", [](nlohmann::json& json) {
    // Its scale is what moves another node.
    for (nlohmann::json& animation : json["animations"])
      for (nlohmann::json channel : animation["channels"])
        if (channel["target"]["path"] == "translation") {
          channel["target"] = {{"node", json["nodes"].size() - 1}, {"path", "scale"}};
          animation["channels"].push_back(channel);
          return;
        }
    throw std::runtime_error("no animation moves anything");
  });
  EXPECT_EQ(run("vestige record --avatar hidden.glb --duration 0.1 -o a.mcap").exit_code, 0);
  EXPECT_EQ(run("vestige replay a.mcap").exit_code, 0);
}

}  // namespace
}  // namespace vestige
