// Traces whose avatar or map is damaged, and `recover` with an intact one, as a user sees it.

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>
#include <span>

#include "tests/support/command_line.hpp"
#include "traces/scene/builtin_avatar.hpp"

namespace vestige {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

class Replace : public test::CommandLineTest {
 protected:
  void SetUp() override {
    ASSERT_EQ(run("vestige record --count 20 --rate 100 --duration 1 -o a.mcap").exit_code, 0);
    hash_ = hash_of("a.mcap");
    ASSERT_EQ(hash_.size(), 64U);
    write("right.glb", builtin_avatar_glb());
    write("right.png", builtin_actuator_map_png());
    const std::string json = builtin_actuator_map_json();
    const auto bytes = std::as_bytes(std::span(json));
    json_.assign(bytes.begin(), bytes.end());
    write("right.json", json_);
    // The same body with another name of an animation, and another map.
    std::string other = read_text_file(folder_ / "right.glb");
    ASSERT_NE(other.find("\"walk\""), std::string::npos);
    other[other.find("\"walk\"") + 1] = 't';
    write("other.glb", std::as_bytes(std::span(other)));
    ASSERT_EQ(run("vestige map make --layout paper6 --avatar builtin --size 64 -o other.png").exit_code, 0);
  }

  std::string hash_of(const std::string& trace) const {
    return json_of("vestige replay " + trace + " --json -")["texture_hash"];
  }

  /// Flips one bit of an attachment of `from`, and writes the result as `to`.
  void damage(std::span<const std::byte> attachment, const std::string& from, const std::string& to) const {
    std::vector<std::byte> bytes = read_file(folder_ / from);
    const auto place = std::search(bytes.begin(), bytes.end(), attachment.begin(), attachment.end());
    ASSERT_NE(place, bytes.end());
    *(place + static_cast<std::ptrdiff_t>(attachment.size() / 2)) ^= std::byte{4};
    write(to, bytes);
  }

  /// Renames the metadata record `session`, so that nobody finds it.
  void lose_session(const std::string& file) const {
    std::string text = read_text_file(folder_ / file);
    const std::size_t at = text.find("session");
    ASSERT_NE(at, std::string::npos);
    text[at] = 'x';
    write(file, std::as_bytes(std::span(text)));
  }

  std::string hash_;
  std::vector<std::byte> json_;
};

TEST_F(Replace, ADamagedAvatarIsReplacedByTheRecordedOneAndNothingIsLost) {
  damage(builtin_avatar_glb(), "a.mcap", "b.mcap");
  expect_failure("vestige replay b.mcap", 1,
                 {"has no undamaged attachment avatar.glb", "vestige recover b.mcap --avatar builtin -o mended.mcap"});
  for (const std::string avatar : {"right.glb", "builtin"}) {
    const test::Outcome recover = run("vestige recover b.mcap --force -o c.mcap --json r.json --avatar " + avatar);
    EXPECT_EQ(recover.exit_code, 0) << recover.standard_error;
    EXPECT_EQ(recover.standard_error, "");
    EXPECT_THAT(recover.standard_output, HasSubstr(avatar + " takes the place of the attachment avatar.glb"));
    const auto replaced = json_in("r.json")["replaced"];
    ASSERT_EQ(replaced.size(), 1U);
    EXPECT_EQ(replaced[0]["recorded"], true);
    EXPECT_EQ(hash_of("c.mcap"), hash_);
    EXPECT_THAT(run("vestige doctor c.mcap").standard_output,
                AllOf(HasSubstr("SHA-256 as recorded: actuator_map.json, actuator_map.png, avatar.glb"),
                      HasSubstr("no problem")));
  }
}

TEST_F(Replace, AnAvatarThatAnEarlierRecoveryKeptAsDamagedIsReplacedToo) {
  damage(builtin_avatar_glb(), "a.mcap", "b.mcap");
  const test::Outcome first = run("vestige recover b.mcap -o c.mcap");
  EXPECT_EQ(first.exit_code, 3);
  EXPECT_THAT(first.standard_error, HasSubstr("--avatar puts an intact one in its place"));
  const std::string remedy = "vestige recover c.mcap --avatar builtin -o mended.mcap";
  expect_failure("vestige replay c.mcap", 1, {remedy});
  expect_failure("vestige export c.mcap -o d", 1, {remedy});
  EXPECT_THAT(run("vestige doctor c.mcap").standard_output, HasSubstr(remedy));
  EXPECT_EQ(run(remedy).exit_code, 0);
  EXPECT_EQ(hash_of("mended.mcap"), hash_);
  EXPECT_THAT(run("vestige inspect mended.mcap").standard_output, Not(HasSubstr("avatar.glb.damaged")));
}

TEST_F(Replace, AnotherAvatarIsRefusedAndNothingIsWritten) {
  damage(builtin_avatar_glb(), "a.mcap", "b.mcap");
  expect_failure("vestige recover b.mcap --avatar other.glb -o c.mcap --json c.json", 1,
                 {"other.glb: is not the avatar.glb that b.mcap was recorded with", "--force"}, "c.mcap");
  EXPECT_FALSE(std::filesystem::exists(folder_ / "c.json"));
  // Whoever overwrites a file has not agreed to another avatar.
  ASSERT_EQ(run("echo mine > d.mcap").exit_code, 0);
  expect_failure("vestige recover b.mcap --avatar other.glb -o d.mcap --force", 1,
                 {"other.glb: is not the avatar.glb", "choose a new name for d.mcap"});
  EXPECT_EQ(read_text_file(folder_ / "d.mcap"), "mine\n");
}

TEST_F(Replace, AnotherAvatarWithForceIsSaidInTheFile) {
  damage(builtin_avatar_glb(), "a.mcap", "b.mcap");
  const test::Outcome recover = run("vestige recover b.mcap --avatar other.glb --force -o c.mcap --json r.json");
  EXPECT_EQ(recover.exit_code, 3);
  EXPECT_THAT(recover.standard_error, HasSubstr("other.glb takes the place of the attachment avatar.glb, and is not"));
  EXPECT_EQ(json_in("r.json")["replaced"][0]["recorded"], false);
  EXPECT_FALSE(json_of("vestige inspect c.mcap -q --json - ; true")["session"].contains("facing"))
      << "another avatar faces where its own file tells";
  const auto said = HasSubstr("`vestige recover --force` put another one in its place");
  const test::Outcome inspect = run("vestige inspect c.mcap --json inspect.json");
  EXPECT_EQ(inspect.exit_code, 3);
  EXPECT_THAT(inspect.standard_error, said);
  EXPECT_THAT(inspect.standard_output, HasSubstr("(not the recorded one)"));
  for (const auto& attachment : json_in("inspect.json")["attachments"]) {
    if (attachment["name"] == "avatar.glb") {
      EXPECT_EQ(attachment["recorded"], false);
    }
  }
  EXPECT_THAT(run("vestige doctor c.mcap --json doctor.json").standard_output, said);
  EXPECT_THAT(json_in("doctor.json")["files"][0]["attachment_checks"].dump(), HasSubstr("false"));
  const test::Outcome replay = run("vestige replay c.mcap");
  EXPECT_EQ(replay.exit_code, 3);
  EXPECT_THAT(replay.standard_error, said);
  // Who finds the right one later makes it good.
  EXPECT_EQ(run("vestige recover c.mcap --avatar right.glb -o d.mcap").exit_code, 0);
  EXPECT_EQ(hash_of("d.mcap"), hash_);
  EXPECT_THAT(run("vestige doctor d.mcap").standard_output, Not(HasSubstr("--force")));
}

TEST_F(Replace, WhatIsNoAvatarIsRefusedEvenWithForce) {
  damage(builtin_avatar_glb(), "a.mcap", "b.mcap");
  expect_failure("vestige recover b.mcap --avatar a.mcap --force -o c.mcap", 1, {"a.mcap"}, "c.mcap");
}

TEST_F(Replace, TheSummaryKnowsTheAvatarWhenTheSessionIsLost) {
  damage(builtin_avatar_glb(), "a.mcap", "b.mcap");
  lose_session("b.mcap");
  expect_failure("vestige replay b.mcap", 1, {"vestige recover b.mcap --avatar builtin -o mended.mcap"});
  expect_failure("vestige recover b.mcap --avatar other.glb -o c.mcap", 1, {"other.glb: is not the avatar.glb"},
                 "c.mcap");
  EXPECT_EQ(run("vestige recover b.mcap --avatar right.glb -o c.mcap").exit_code, 0);
  EXPECT_EQ(hash_of("c.mcap"), hash_);
}

TEST_F(Replace, ADamagedMapIsReplacedByTheRecordedOne) {
  damage(builtin_actuator_map_png(), "a.mcap", "image.mcap");
  damage(json_, "a.mcap", "text.mcap");
  damage(json_, "image.mcap", "both.mcap");
  for (const std::string file : {"image.mcap", "text.mcap", "both.mcap"}) {
    EXPECT_THAT(run("vestige replay " + file).standard_error, HasSubstr("vestige recover " + file + " --map builtin"));
    expect_failure(fmt::format("vestige recover {} --map other.png -o c.mcap", file), 1,
                   {"other.png: is not the actuator_map.", "--force"}, "c.mcap");
    for (const std::string map : {"right.png", "builtin"}) {
      const test::Outcome recover = run(fmt::format("vestige recover {} --map {} --force -o m.mcap", file, map));
      EXPECT_EQ(recover.exit_code, 0) << file << recover.standard_error;
      EXPECT_EQ(hash_of("m.mcap"), hash_) << file;
      EXPECT_THAT(run("vestige doctor m.mcap").standard_output, HasSubstr("no problem")) << file;
    }
  }
  ASSERT_EQ(run("cp right.png alone.png").exit_code, 0);
  expect_failure("vestige recover both.mcap --map alone.png -o c.mcap", 1, {"there is no sidecar"}, "c.mcap");
  EXPECT_EQ(run("vestige recover image.mcap --map alone.png -o d.mcap").exit_code, 0) << "the sidecar is intact";
  EXPECT_EQ(hash_of("d.mcap"), hash_);
}

TEST_F(Replace, AnotherMapWithForceReplacesImageAndSidecarTogether) {
  damage(builtin_actuator_map_png(), "a.mcap", "b.mcap");
  ASSERT_EQ(run("cp other.png alone.png").exit_code, 0);
  EXPECT_EQ(run("vestige recover b.mcap --map alone.png --force -o c.mcap").exit_code, 3);
  const test::Outcome doctor = run("vestige doctor c.mcap");
  EXPECT_THAT(doctor.standard_output,
              AllOf(HasSubstr("actuator_map.png is not the recorded one"),
                    HasSubstr("actuator_map.json, whose SHA-256 is recorded, is not there"), HasSubstr("--force")));
  EXPECT_EQ(run("vestige recover b.mcap --map other.png --force -o d.mcap").exit_code, 3);
  const auto attachments = nlohmann::json::parse(run("vestige inspect d.mcap --json -").standard_output)["attachments"];
  for (const auto& attachment : attachments) {
    if (attachment["name"].get<std::string>().starts_with("actuator_map")) {
      EXPECT_NE(attachment["recorded"], true) << attachment;
    }
  }
  EXPECT_EQ(run("vestige replay d.mcap").exit_code, 3);
}

TEST_F(Replace, WhatNothingNeedsIsSaid) {
  const test::Outcome unused = run("vestige recover a.mcap --avatar other.glb -o b.mcap");
  EXPECT_EQ(unused.exit_code, 0);
  EXPECT_THAT(unused.standard_error, HasSubstr("other.glb is not used"));
  EXPECT_EQ(hash_of("b.mcap"), hash_);
  ASSERT_EQ(run("vestige record --map none --count 2 --rate 10 --duration 1 -o bare.mcap").exit_code, 0);
  expect_failure("vestige recover bare.mcap --map builtin -o c.mcap", 1, {"was recorded without an actuator map"},
                 "c.mcap");
  expect_failure("vestige recover a.mcap --map none -o c.mcap", 2, {"--map"}, "c.mcap");
  expect_failure("vestige recover a.mcap --avatar right.glb --force -o right.glb", 2, {"would change an input file"});
}

}  // namespace
}  // namespace vestige
