// Which joints of an avatar are which bones of a human being.

#include "traces/body/humanoid.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/builtin_avatar.hpp"
#include "tests/traces/trace_file/trace_fixture.hpp"

namespace vestige {
namespace {

using ::testing::HasSubstr;
using ::testing::UnorderedElementsAre;

TEST(Humanoid, HasUnitysNamesWhateverTheJointsAreCalled) {
  const std::vector<std::pair<const char*, const char*>> bones = {
      {"mixamorig:Hips", "Hips"},         {"mixamorig:Spine", "Spine"},
      {"mixamorig:Spine1", "Chest"},      {"mixamorig:Spine2", "UpperChest"},
      {"mixamorig:Neck", "Neck"},         {"mixamorig:Head", "Head"},
      {"clavicle_r", "RightShoulder"},    {"upperarm_l", "LeftUpperArm"},
      {"LeftForeArm", "LeftLowerArm"},    {"mixamorig:RightHandIndex2", "RightIndexIntermediate"},
      {"thumb_03_r", "RightThumbDistal"}, {"mixamorig:LeftUpLeg", "LeftUpperLeg"},
      {"shin.R", "RightLowerLeg"},        {"Sword", ""}};
  Avatar avatar = test::skeleton(bones.size());  // each joint hangs from the one before
  for (std::size_t i = 0; i < bones.size(); ++i) avatar.nodes[i].name = bones[i].first;
  const Humanoid humanoid = find_humanoid(avatar, "{}");
  for (std::size_t i = 0; i < bones.size(); ++i) {
    const std::string bone = bones[i].second;
    if (bone.empty()) continue;
    ASSERT_TRUE(humanoid.node_of.contains(bone)) << bone;
    EXPECT_EQ(humanoid.node_of.find(bone)->second, i) << bone;
  }
  EXPECT_EQ(humanoid.node_of.size(), bones.size() - 1);
}

TEST(Humanoid, OfTheBuiltInAvatarIsWhole) {
  const Humanoid humanoid = test::builtin_avatar().humanoid;
  EXPECT_EQ(humanoid.node_of.size(), 21U);
  for (const char* name : {"Hips", "Spine", "Chest", "Neck", "Head", "LeftUpperArm", "RightLowerLeg", "LeftToes"})
    EXPECT_TRUE(humanoid.node_of.contains(name)) << name;
}

TEST(Humanoid, OfBonesInOnePlaceTheSecondIsLeftOutAndSaid) {
  const Humanoid humanoid = find_humanoid(test::skeleton(4), R"({"VRMC_vrm":{"humanoid":{"humanBones":)"
                                                             R"({"head":{"node":2},"hips":{"node":2}}}}})");
  EXPECT_EQ(humanoid.node_of, (decltype(humanoid.node_of){{"Head", 2}}));
  ASSERT_EQ(humanoid.problems.size(), 1U);
  EXPECT_THAT(humanoid.problems.front(), HasSubstr("humanBones.hips.node is 2, which is already the bone Head"));
}

TEST(Humanoid, IsWhatVrmSays) {
  const Avatar avatar = test::skeleton(4);
  const Humanoid one = find_humanoid(avatar, R"({"VRMC_vrm":{"humanoid":{"humanBones":{"hips":{"node":2},)"
                                             R"("leftThumbMetacarpal":{"node":3},"head":{"node":99},"jaw":5}}}})");
  EXPECT_EQ(one.source, Humanoid::Source::kVrm1);
  EXPECT_EQ(one.node_of, (decltype(one.node_of){{"Hips", 2}, {"LeftThumbProximal", 3}}));
  const std::string field = "extensions.VRMC_vrm.humanoid.humanBones.";
  EXPECT_THAT(one.problems,
              UnorderedElementsAre(field + "head.node is not a node of the file: the bone Head is left out",
                                   field + "jaw.node is not a node of the file: the bone Jaw is left out"));
  const Humanoid zero =
      find_humanoid(avatar, R"({"VRM":{"humanoid":{"humanBones":[{"bone":"hips","node":1},{"bone":7},5,)"
                            R"({"bone":"leftUpperArm","node":0}]}}})");
  EXPECT_EQ(zero.source, Humanoid::Source::kVrm0);
  EXPECT_EQ(zero.node_of, (decltype(zero.node_of){{"Hips", 1}, {"LeftUpperArm", 0}}));
}

TEST(Humanoid, OfTwoTablesOfVrmIsTheOneThatNamesBones) {
  const auto found = [](const std::string& vrm1, const std::string& vrm0) {
    return find_humanoid(test::skeleton(4), R"({"VRMC_vrm":{"humanoid":{"humanBones":)" + vrm1 +
                                                R"(}},"VRM":{"humanoid":{"humanBones":)" + vrm0 + "}}}");
  };
  for (const char* empty : {"{}", "[]", "null", R"({"wing":{"node":1}})", R"({"hips":{"node":4}})"}) {
    const Humanoid old = found(empty, R"([{"bone":"hips","node":1}])");
    EXPECT_EQ(old.source, Humanoid::Source::kVrm0) << empty;
    EXPECT_EQ(old.node_of, (decltype(old.node_of){{"Hips", 1}})) << empty;
  }
  const Humanoid now = found(R"({"hips":{"node":2}})", R"([{"bone":"hips","node":1},{"bone":"head","node":3}])");
  EXPECT_EQ(now.source, Humanoid::Source::kVrm1);
  EXPECT_EQ(now.node_of, (decltype(now.node_of){{"Hips", 2}}));
  EXPECT_EQ(found("{}", "[]").source, Humanoid::Source::kVrm1);
}

}  // namespace
}  // namespace vestige
