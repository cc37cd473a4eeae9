// Motion capture as others write it, and as it should not be written.

#include "traces/motion/bvh.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/test_data.hpp"
#include "tests/traces/motion/bvh_text.hpp"
#include "traces/base/error.hpp"

namespace vestige {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

const std::string kOneJoint =
    "HIERARCHY\nROOT hips\n{\nOFFSET 1 2 3\nCHANNELS 2 Xposition Zrotation\n}\nMOTION\nFrames: 2\nFrame Time: 0.5\n"
    "10 90\n20 -90\n";

std::string refusal(const std::string& text) {
  try {
    parse_bvh(text, "walk.bvh");
  } catch (const Error& error) {
    return error.what();
  }
  return "accepted";
}

std::string changed(const std::string& from, const std::string& to) {
  std::string text = kOneJoint;
  const std::size_t place = text.find(from);
  EXPECT_NE(place, std::string::npos) << from;
  return text.replace(place, from.size(), to);
}

TEST(Bvh, JointsChannelsAndFramesAreRead) {
  const BvhMotion motion = parse_bvh(kOneJoint, "walk.bvh");
  ASSERT_EQ(motion.joints.size(), 1U);
  EXPECT_EQ(motion.joints[0].name, "hips");
  EXPECT_EQ(motion.frame_count, 2U);
  EXPECT_EQ(motion.frame_time_s, 0.5);
  std::vector<BvhPlace> places;
  bvh_places(motion, 0, places);
  EXPECT_EQ(places[0].position, glm::dvec3(10, 2, 3)) << "a channel takes the place of that axis of the offset";
  const glm::dvec3 turned = places[0].rotation * glm::dvec3(1, 0, 0);
  EXPECT_NEAR(turned.y, 1, 1e-12) << "a quarter turn about z";
}

TEST(Bvh, RotationsAreMultipliedInTheOrderOfTheChannels) {
  const BvhMotion motion = parse_bvh(
      "HIERARCHY\nROOT a\n{\nOFFSET 0 0 0\nCHANNELS 2 Zrotation Xrotation\n}\nMOTION\nFrames: 1\nFrame Time: 1\n90 "
      "90\n",
      "order.bvh");
  std::vector<BvhPlace> places;
  bvh_places(motion, 0, places);
  // About x first: y becomes z. Then about z: z stays.
  const glm::dvec3 turned = places[0].rotation * glm::dvec3(0, 1, 0);
  EXPECT_NEAR(turned.z, 1, 1e-12);
}

TEST(Bvh, WhatProgramsWriteDifferentlyIsRead) {
  for (const std::string& text :
       {changed("ROOT hips\n{", "root hips {"), changed("Frames: 2", "Frames : 2"), changed("Frames: 2", "frames:2"),
        changed("Frame Time: 0.5", "Frame Time:0.5"), changed("10 90", "+10 .9e2"),
        changed("ROOT hips", "ROOT left hip"), changed("Xposition", "xPosition"), "\xEF\xBB\xBF" + kOneJoint})
    EXPECT_EQ(parse_bvh(text, "walk.bvh").frame_count, 2U) << text;
  std::string windows;
  for (const char c : kOneJoint) windows += c == '\n' ? "\r\n" : std::string(1, c);
  EXPECT_EQ(parse_bvh(windows, "walk.bvh").values, parse_bvh(kOneJoint, "walk.bvh").values);
}

TEST(Bvh, FramesBeyondTheAnnouncedOnesAreReadAndSaid) {
  const BvhMotion longer = parse_bvh(kOneJoint + "30 0\n40 0\n\n", "walk.bvh");
  EXPECT_EQ(longer.frame_count, 4U);
  EXPECT_EQ(longer.value(3, 0), 40);
  EXPECT_THAT(longer.warnings, ElementsAre("walk.bvh: 2 frames were announced, but there are 4, and all of these are "
                                           "read"));
  const BvhMotion cut = parse_bvh(kOneJoint + "30 0\n40", "walk.bvh");
  EXPECT_EQ(cut.frame_count, 3U);
  EXPECT_EQ(cut.values.size(), 6U);
  EXPECT_THAT(cut.warnings, ElementsAre(HasSubstr("there are 3, and all of these are read; a last one, which is cut "
                                                  "short, is left out")));
  EXPECT_THAT(parse_bvh(kOneJoint + " \n\n", "walk.bvh").warnings, IsEmpty());
  EXPECT_THAT(refusal(changed("Time: 0.5", "Time: 4e8") + "30 0\n"), HasSubstr("longer than 1e9 s"));
}

TEST(Bvh, NumbersTooSmallForTheirTypeAreZeroHoweverTheyAreWritten) {
  const std::string zeros(400, '0');
  for (const std::string& tiny : {std::string("1e-60"), std::string("1E-60"), std::string("-1E-400"),
                                  "0." + zeros + "1", "+0." + zeros + "1e30", "." + zeros + "1"})
    EXPECT_EQ(parse_bvh(changed("10 90", "10 " + tiny), "walk.bvh").values[1], 0) << tiny;
  for (const std::string& huge : {std::string("1e60"), std::string("1E400"), "1" + zeros, "1" + zeros + "e-10"})
    EXPECT_THAT(refusal(changed("10 90", "10 " + huge)), HasSubstr("out of range")) << huge;
  EXPECT_THAT(refusal(changed("10 90", "10 1E-60x")), HasSubstr("not a number"));
}

TEST(Bvh, WordsAreShownInFortyBytesOfWholeLetters) {
  EXPECT_EQ(shown_word(std::string(40, 'a')), std::string(40, 'a'));
  EXPECT_EQ(shown_word(std::string(41, 'a')), std::string(40, 'a') + "...");
  EXPECT_EQ(shown_word(std::string(39, 'a') + "\u00fc"), std::string(39, 'a') + "...");
}

TEST(Bvh, MistakesAreNamedByTheirLine) {
  const std::tuple<std::string, const char*, const char*> cases[] = {
      {"", "line 1", "HIERARCHY"},
      {changed("MOTION\n", ""), "line 7", "is not allowed here"},
      {kOneJoint.substr(0, kOneJoint.find("MOTION")), "line 7", "before MOTION"},
      {changed("}\n", ""), "line 6", "is not allowed here"},
      {changed("CHANNELS 2", "CHANNELS 7"), "line 5", "7 channels"},
      {changed("CHANNELS 2", "CHANNELS 3"), "line 5", "3 channels were announced"},
      {changed("CHANNELS 2", "CHANNELS 1"), "line 5", "'Zrotation' follows"},
      {changed("Xposition", "Wposition"), "line 5", "Wposition"},
      {changed("Xposition", "Zrotation"), "line 5", "twice"},
      {changed("OFFSET 1", "OFFSET nan"), "line 4", "nan"},
      {changed("Frames: 2", "Frames: 3"), "line 12", "3 frames were announced, but there are only 2"},
      {changed("20 -90\n", "20 -90\n5\n30 0\n"), "line 12", "frame 2 has 1 numbers"},
      {changed("20 -90\n", "20 -90\nthe end\n"), "line 12", "'the', which is not a number"},
      {changed("Frames: 2", "Frames 2"), "line 8", "expected a colon after Frames instead of '2'"},
      {changed("Frames: 2", "Frames: 99999999999999"), "line 8", "frames"},
      {changed("Frames: 2", "Frames: 0"), "line 8", "0 frames"},
      {changed("Frames: 2", "Frames: -1"), "line 8", "-1"},
      {changed("Frame Time: 0.5", "Frame Time: 0"), "line 9", "not positive"},
      {changed("Frame Time: 0.5", "Frame Time: 9e-10"), "line 9", "less than 1e-9 s"},
      {changed("10 90", "10"), "line 10", "1 numbers"},
      {changed("10 90", "10 90 5"), "line 10", "more than"},
      {changed("10 90", "10 inf"), "line 10", "inf"},
      {changed("10 90", "10 9,0"), "line 10", "9,0"}};
  for (const auto& [text, line, cause] : cases) {
    EXPECT_THAT(refusal(text), HasSubstr(std::string("walk.bvh, ") + line + ":")) << text;
    EXPECT_THAT(refusal(text), HasSubstr(cause)) << text;
  }
  std::string deep = "HIERARCHY\n";
  for (int i = 0; i < 100000; ++i) deep += i == 0 ? "ROOT a\n{\n" : "JOINT a\n{\n";
  EXPECT_THAT(refusal(deep), HasSubstr("deeper than 256"));
}

TEST(Bvh, CuttingAFileAnywhereIsAnErrorAndNoCrash) {
  const std::string text = test::bvh_person("\nFrames: 2\nFrame Time: 0.05\n" + test::bvh_frame("0 95 0") +
                                            test::bvh_frame("0 95 10", test::kLeftArmZ, 45));
  ASSERT_EQ(parse_bvh(text, "walk.bvh").joints.size(), 16U);
  for (std::size_t length = 0; length + 3 < text.size(); ++length)
    EXPECT_NE(refusal(text.substr(0, length)), "accepted") << length;
}

TEST(Bvh, RealCapturesAreRead) {
  const auto folder = test::data("avatars/motion");
  VESTIGE_REQUIRE_DATA(folder);
  const BvhMotion cmu = read_bvh(folder / "cmu_01_01.bvh");
  EXPECT_EQ(cmu.frame_count, 2752U);
  EXPECT_EQ(cmu.joints.size(), 31U);
  EXPECT_EQ(read_bvh(folder / "mh_walk1.bvh").frame_count, 14U);
  EXPECT_EQ(read_bvh(folder / "mh_zombieWalk1.bvh").frame_count, 31U);
}

}  // namespace
}  // namespace vestige
