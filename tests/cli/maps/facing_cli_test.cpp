// '--facing', and what is found without it.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "tests/support/command_line.hpp"
#include "tests/support/made/made_avatars.hpp"
#include "traces/files/input_file.hpp"

namespace vestige {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

/// A folder with turned.glb, which faces -x, and unnamed.glb, the same without names of joints.
class FacingFlag : public test::CommandLineTest {
 protected:
  FacingFlag() {
    const std::vector<std::byte> turned = test::turned_glb(builtin_avatar_glb(), 3);
    write("turned.glb", turned);
    write("unnamed.glb", test::edited_glb(turned, [](nlohmann::json& json) {
            for (nlohmann::json& node : json["nodes"]) node["name"] = "joint";
          }));
  }
  void write(const char* name, const std::vector<std::byte>& bytes) const {
    std::ofstream(folder_ / name, std::ios::binary)
        .write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  }
  std::string message(const std::string& command) const { return run(command).standard_error; }

  static constexpr const char* kDoubt =
      "unnamed.glb: neither its joints' names nor VRM tell which way it faces; +z is taken; --facing sets it";
};

TEST_F(FacingFlag, IsNotNeededWhereTheJointsTell) {
  const auto avatar = json_of("vestige avatar turned.glb --json -");
  EXPECT_EQ(avatar["facing"], "-x");
  EXPECT_EQ(avatar["facing_by"], "sides");
  EXPECT_THAT(run("vestige avatar turned.glb").standard_output, HasSubstr("faces          -x, by its left and right joints"));
  EXPECT_EQ(json_of("vestige map make --avatar turned.glb --layout torso16 -o t.png --json -")["facing"], "-x");
  EXPECT_EQ(nlohmann::json::parse(read_text_file(folder_ / "t.json"))["facing"], "-x");
  EXPECT_EQ(json_of("vestige map check t.png --avatar turned.glb --json -")["good"], true);
}

TEST_F(FacingFlag, SaysWhatNothingElseTells) {
  EXPECT_THAT(message("vestige avatar unnamed.glb"), HasSubstr(kDoubt));
  EXPECT_THAT(message("vestige avatar unnamed.glb --facing -x"), Not(HasSubstr("--facing")));
  EXPECT_THAT(message("vestige map make --avatar unnamed.glb --layout torso16 -o a.png"), HasSubstr(kDoubt));
  EXPECT_THAT(message("vestige map make --avatar unnamed.glb --facing -x --layout torso16 -o b.png"),
              Not(HasSubstr("--facing")));
  // Of the same body, with its facing told: a layout's left is left, which the names of the other file show.
  EXPECT_THAT(run("vestige map check b.png --avatar turned.glb").standard_output, Not(HasSubstr("side of the joints")));
  const test::Outcome wrong = run("vestige map check a.png --avatar turned.glb");
  EXPECT_EQ(wrong.exit_code, 4);
  EXPECT_THAT(wrong.standard_output, HasSubstr("'chest right' lies"));
  EXPECT_THAT(wrong.standard_output, HasSubstr("on the side of the joints named left"));
}

/// The trace keeps the facing: a layout that is laid onto its avatar later is the one that the recording would have
/// had.
TEST_F(FacingFlag, GoesWithTheTrace) {
  const std::string scene = " --avatar unnamed.glb --colliders punch --count 16 --rate 100 --duration 2";
  EXPECT_THAT(message("vestige record" + scene + " --map torso16 -o assumed.mcap"), HasSubstr(kDoubt));
  EXPECT_EQ(message("vestige record -q" + scene + " --facing -x --map torso16 -o now.mcap"), "");
  EXPECT_EQ(json_of("vestige inspect now.mcap --json -")["session"]["facing"], "-x");
  EXPECT_EQ(json_of("vestige inspect assumed.mcap --json -")["session"]["facing"], "+z");
  EXPECT_EQ(json_of("vestige replay now.mcap --map-at 0.5=torso16 --json -")["texture_hash"],
            json_of("vestige replay now.mcap --json -")["texture_hash"]);
  ASSERT_EQ(run("vestige trim now.mcap --to 1 -o part.mcap && vestige export now.mcap -o now.h5 && "
                "vestige import now.h5 -o again.mcap")
                .exit_code,
            0);
  for (const char* file : {"part.mcap", "again.mcap"})
    EXPECT_EQ(json_of(std::string("vestige inspect --json - ") + file)["session"]["facing"], "-x") << file;
}

TEST_F(FacingFlag, TakesAnAxis) {
  const test::Outcome wrong = run("vestige record --facing up -o a.mcap");
  EXPECT_EQ(wrong.exit_code, 2);
  EXPECT_THAT(wrong.standard_error, HasSubstr("--facing: up not in {+z,+x,-z,-x,auto}"));
}

}  // namespace
}  // namespace vestige
