// Motion capture on other bodies than the one that was captured.

#include "traces/motion/retarget.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "tests/support/made/edited_glb.hpp"
#include "tests/support/test_data.hpp"
#include "tests/traces/motion/bvh_text.hpp"
#include "tests/traces/motion/made_motion.hpp"
#include "traces/base/error.hpp"
#include "traces/body/body_roles.hpp"
#include "traces/gltf/avatar_gltf.hpp"
#include "traces/scene/builtin_avatar.hpp"

namespace vestige {
namespace {

const Avatar& mannequin() {
  static const Avatar avatar = parse_avatar_glb(builtin_avatar_glb(), "builtin");
  return avatar;
}

/// Where nodes are while an animation plays.
class Stage {
 public:
  Stage(const Avatar& avatar, const Animation& animation, double time_s) : avatar_(avatar) {
    world_matrices(avatar, sample_animation(avatar, animation, time_s), matrices_);
  }
  explicit Stage(const Avatar& avatar) : avatar_(avatar) { world_matrices(avatar, rest_pose(avatar), matrices_); }
  glm::dvec3 operator[](const std::string& name) const {
    const auto node = std::ranges::find(avatar_.nodes, name, &Node::name);
    EXPECT_NE(node, avatar_.nodes.end()) << name;
    return glm::dvec3(matrices_[static_cast<std::size_t>(node - avatar_.nodes.begin())][3]);
  }
  glm::dvec3 direction(const std::string& from, const std::string& to) const {
    return glm::normalize((*this)[to] - (*this)[from]);
  }

 private:
  const Avatar& avatar_;
  std::vector<glm::dmat4> matrices_;
};

void expect_near(const glm::dvec3& a, const glm::dvec3& b, double tolerance, const char* what) {
  EXPECT_LT(glm::length(a - b), tolerance)
      << what << ": " << a.x << " " << a.y << " " << a.z << " instead of " << b.x << " " << b.y << " " << b.z;
}

BvhMotion person(const std::string& frames, std::size_t count) {
  return parse_bvh(test::bvh_person(fmt::format("\nFrames: {}\nFrame Time: 0.5\n", count) + frames), "person.bvh");
}

TEST(Retarget, LimbsPointWhereTheMotionsDoWhateverTheRestPose) {
  const BvhMotion motion = person(test::bvh_frame("0 95 0") + test::bvh_frame("0 95 0", test::kLeftArmZ, 90) +
                                      test::bvh_frame("0 95 0", test::kLeftThighX, -90),
                                  3);
  RetargetReport report;
  const Animation animation = retarget(motion, mannequin(), {}, "person.bvh", report);
  EXPECT_EQ(report.matched.size(), 17U) << "two spines follow the one";
  EXPECT_TRUE(report.unmatched_joints.empty()) << ::testing::PrintToString(report.unmatched_joints);

  const Stage rest(mannequin(), animation, 0);
  expect_near(rest.direction("upper_arm_left", "forearm_left"), {1, 0, 0}, 1e-4, "the T pose");
  expect_near(rest.direction("forearm_right", "hand_right"), {-1, 0, 0}, 1e-4, "the T pose");
  expect_near(rest.direction("thigh_left", "shin_left"), {0, -1, 0}, 1e-4, "standing");
  const Stage raised(mannequin(), animation, 0.5);
  expect_near(raised.direction("upper_arm_left", "forearm_left"), {0, 1, 0}, 1e-4, "an arm raised");
  expect_near(raised.direction("forearm_left", "hand_left"), {0, 1, 0}, 1e-4, "and what hangs from it");
  expect_near(raised.direction("forearm_right", "hand_right"), {-1, 0, 0}, 1e-4, "the other arm");
  const Stage kicking(mannequin(), animation, 1);
  expect_near(kicking.direction("thigh_left", "shin_left"), {0, 0, 1}, 1e-4, "a thigh raised to the front");
}

TEST(Retarget, TheHipsTravelByTheRatioOfTheirHeightsOrInTrueMetres) {
  const BvhMotion motion = person(test::bvh_frame("50 95 0") + test::bvh_frame("50 105 100"), 2);
  RetargetReport report;
  const Stage at_rest(mannequin());
  const double ratio = (at_rest["pelvis"].y - at_rest["foot_left"].y) / 95;
  const Animation fitted = retarget(motion, mannequin(), {}, "person.bvh", report);
  EXPECT_NEAR(report.metres_per_unit, ratio, 1e-9);
  EXPECT_EQ(report.likely_unit, "cm");
  expect_near(Stage(mannequin(), fitted, 0)["pelvis"], at_rest["pelvis"], 1e-5, "it starts at the avatar's place");
  expect_near(Stage(mannequin(), fitted, 0.5)["pelvis"], at_rest["pelvis"] + ratio * glm::dvec3(0, 10, 100), 1e-5,
              "and travels");
  const Animation metric = retarget(motion, mannequin(), {.metres_per_unit = 0.01}, "person.bvh", report);
  expect_near(Stage(mannequin(), metric, 0.5)["pelvis"], at_rest["pelvis"] + glm::dvec3(0, 0.1, 1), 1e-5, "in metres");
}

TEST(Retarget, OtherSkeletonsAreRefusedByName) {
  const BvhMotion dog =
      parse_bvh("HIERARCHY\nROOT tail\n{\nOFFSET 0 0 0\nCHANNELS 1 Xrotation\n}\nMOTION\nFrames: 1\nFrame Time: 1\n0\n",
                "dog.bvh");
  RetargetReport report;
  EXPECT_THROW(retarget(dog, mannequin(), {}, "dog.bvh", report), Error);
}

TEST(Retarget, AMotionWithFewNumbersDoesNotBecomeVeryMany) {
  constexpr std::size_t kFrames = 60000;
  BvhMotion motion = person(test::bvh_frame("0 95 0"), 1);
  const auto repeat = [&](std::size_t frames) {
    motion.frame_count = frames;
    motion.values.assign(frames * motion.channel_count, 0.0F);
  };
  const auto refusal = [&]() -> std::string {
    RetargetReport report;
    try {
      retarget(motion, mannequin(), {}, "person.bvh", report);
    } catch (const Error& error) {
      return error.what();
    }
    return "retargeted";
  };
  repeat(kFrames);
  EXPECT_EQ(refusal(), "retargeted") << "each joint has its own numbers";
  for (BvhJoint& joint : motion.joints) joint.channels.clear();
  motion.joints[0].channels = {BvhChannel::kYPosition};
  motion.channel_count = 1;
  repeat(kFrames);
  EXPECT_EQ(refusal(),
            "person.bvh: its 60000 frames become 5340000 numbers for the 17 joints of the avatar that follow it, more "
            "than 4674304\n  cut the motion into parts, or export it with fewer frames a second");
  repeat(kFrames / 2);
  EXPECT_EQ(refusal(), "retargeted");
}

/// All real motions on all real avatars that have a person's joints: upright, in one piece, feet near the floor.
TEST(Retarget, RealMotionsStandUprightOnRealAvatars) {
  VESTIGE_REQUIRE_DATA(test::data("avatars/motion"));
  struct Body {
    std::string name;
    Avatar avatar;
    const char *hips, *head, *foot, *other_foot, *hand;
  };
  const auto load = [](const char* name) {
    const auto path = test::data("avatars/avatars") / name;
    return parse_avatar_glb(read_avatar_glb(path), name);
  };
  const Body bodies[] = {
      {"mannequin", mannequin(), "pelvis", "head", "foot_left", "foot_right", "hand_left"},
      {"CesiumMan", load("CesiumMan.glb"), "Skeleton_torso_joint_1", "Skeleton_neck_joint_2", "leg_joint_L_3",
       "leg_joint_R_3", "Skeleton_arm_joint_L__2_"},
      {"Knight", load("KayKit_Knight.glb"), "hips", "head", "foot.l", "foot.r", "hand.l"},
      {"MakeHuman", load("MakeHumanBase_cc0_8inf.glb"), "root", "head", "foot.L", "foot.R", "wrist.L"}};
  for (const char* name : {"cmu_01_01.bvh", "mh_walk1.bvh", "mh_zombieWalk1.bvh"}) {
    BvhMotion motion = read_bvh(test::data("avatars/motion") / name);
    for (const Body& body : bodies) {
      SCOPED_TRACE(std::string(name) + " on " + body.name);
      RetargetReport report;
      const Animation animation = retarget(motion, body.avatar, {}, name, report);
      EXPECT_GE(report.matched.size(), 14U);
      const Stage rest(body.avatar);
      const double height = rest[body.head].y - rest[body.foot].y;
      const double floor = std::min(rest[body.foot].y, rest[body.other_foot].y);
      double lowest = 1e9;
      // The CMU actor climbs and jumps later on.
      for (double time_s = 0; time_s < std::min(animation.duration_s, 3.0); time_s += 0.05) {
        const Stage stage(body.avatar, animation, time_s);
        EXPECT_GT(stage[body.head].y - stage[body.hips].y, 0.3 * (rest[body.head].y - rest[body.hips].y)) << time_s;
        EXPECT_GT(stage[body.hips].y - std::min(stage[body.foot].y, stage[body.other_foot].y),
                  0.3 * (rest[body.hips].y - rest[body.foot].y))
            << time_s;
        lowest = std::min({lowest, stage[body.foot].y, stage[body.other_foot].y});
      }
      EXPECT_NEAR(lowest, floor, 0.12 * height) << "feet on the floor";
    }
  }
}

/// Whatever axis is up and however the skeleton lies at rest: who walks, walks, and who lies, lies.
TEST(Retarget, PeopleDoWhatTheMotionDoesInEveryConvention) {
  const Avatar same = test::made_avatar();
  constexpr double kStature_m = 1.73;
  for (const std::string motion : {"walk", "lie", "crawl", "handstand"}) {
    const std::vector<test::MadeFrame> frames = test::made_motion(motion);
    for (const std::string up : {"y", "z", "-y", "-z"})
      for (const std::string rest : {"T", "A", "standing", "lying", "x", "mirrored"}) {
        const std::string name = motion + ", up " + up + ", rest " + rest;
        SCOPED_TRACE(name);
        const BvhMotion bvh = parse_bvh(test::made_bvh(frames, up, rest), name);
        RetargetReport report;
        const Animation on_same = retarget(bvh, same, {}, name, report);
        EXPECT_TRUE(report.deviations.empty()) << report.deviations.front().what;
        EXPECT_NEAR(report.metres_per_unit, 0.01, 1e-4);
        const Animation on_other = retarget(bvh, mannequin(), {}, name, report);
        EXPECT_TRUE(report.deviations.empty()) << report.deviations.front().what;
        double farthest = 0;
        double most_turned = 0;
        for (std::size_t k = 0; k < frames.size(); ++k) {
          const double time_s = double{static_cast<float>(static_cast<double>(k) * bvh.frame_time_s)};
          const Stage stage(same, on_same, time_s);
          const Stage other(mannequin(), on_other, time_s);
          const auto at = [&](const std::string& joint) {
            const auto& joints = test::made_person();
            const auto found = std::ranges::find(joints, joint, &test::MadeJoint::name);
            return frames[k].position[static_cast<std::size_t>(found - joints.begin())];
          };
          for (const char* joint : {"Hips", "Head", "Hand_L", "Hand_R", "Foot_L", "Foot_R"})
            farthest = std::max(farthest, glm::length(stage[joint] - at(joint)));
          const std::array<std::array<const char*, 4>, 9> bones = {{
              {"UpperArm_L", "LowerArm_L", "upper_arm_left", "forearm_left"},
              {"LowerArm_L", "Hand_L", "forearm_left", "hand_left"},
              {"UpperArm_R", "LowerArm_R", "upper_arm_right", "forearm_right"},
              {"LowerArm_R", "Hand_R", "forearm_right", "hand_right"},
              {"UpperLeg_L", "LowerLeg_L", "thigh_left", "shin_left"},
              {"LowerLeg_L", "Foot_L", "shin_left", "foot_left"},
              {"UpperLeg_R", "LowerLeg_R", "thigh_right", "shin_right"},
              {"LowerLeg_R", "Foot_R", "shin_right", "foot_right"},
              {"Hips", "Head", "pelvis", "head"},
          }};
          for (const auto& [from, to, node, end] : bones)
            most_turned = std::max(
                most_turned,
                std::acos(std::min(1.0, glm::dot(glm::normalize(at(to) - at(from)), other.direction(node, end)))));
        }
        EXPECT_LT(farthest, 0.05 * kStature_m);
        EXPECT_LT(glm::degrees(most_turned), 5);
      }
  }
}

TEST(Retarget, ABodyThatCannotBendAsTheMotionDoesIsRefusedUnlessItIsAccepted) {
  Avatar stiff = mannequin();
  for (Node& node : stiff.nodes)
    if (node.name.ends_with("_spine") || node.name == "neck") node.name = "stick";
  const BvhMotion motion =
      person(test::bvh_frame("0 95 0") + test::bvh_frame("0 95 0", test::kSpineX, 20) + test::bvh_frame("0 95 0"), 3);
  RetargetReport report;
  retarget(motion, stiff, {}, "nod.bvh", report);
  ASSERT_FALSE(report.deviations.empty());
  const auto body = std::ranges::find(report.deviations, "hips to head", &Deviation::what);
  ASSERT_NE(body, report.deviations.end());
  EXPECT_NEAR(body->degrees, 18, 4);
  EXPECT_EQ(body->frame, 1U);
  const BvhMotion bow = person(test::bvh_frame("0 95 0") + test::bvh_frame("0 95 0", test::kSpineX, 80), 2);
  try {
    retarget(bow, stiff, {.refusal = "bend it"}, "bow.bvh", report);
    ADD_FAILURE() << "retargeted";
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("bow.bvh: frame 1: from hips to head, the avatar points"));
    EXPECT_THAT(error.what(), testing::HasSubstr("to accept this lean, bend it"));
  }
  retarget(bow, stiff, {.refusal = std::nullopt}, "bow.bvh", report);
  EXPECT_FALSE(report.deviations.empty());
}

/// +Y is up. Otherwise, the body's own up would be, and who walks would be laid down.
TEST(Retarget, AnAvatarThatDoesNotStandIsRefused) {
  const BvhMotion motion = parse_bvh(test::made_bvh(test::made_motion("walk"), "y", "T"), "walk.bvh");
  RetargetReport report;
  for (const double degrees : {-90.0, 90.0, 180.0}) {
    const Avatar laid = parse_avatar_glb(test::laid_glb(builtin_avatar_glb(), degrees, {1, 0, 0}), "laid.glb");
    for (const bool is_forced : {false, true}) try {
        RetargetOptions options;
        if (is_forced) options.refusal.reset();
        retarget(motion, laid, options, "walk.bvh", report);
        ADD_FAILURE() << degrees << " degrees: retargeted";
      } catch (const Error& error) {
        EXPECT_THAT(error.what(), testing::HasSubstr(fmt::format("walk.bvh: the avatar does not stand: at rest, its "
                                                                 "head lies {:.0f} degrees away from +Y",
                                                                 std::abs(degrees))));
        EXPECT_THAT(error.what(), testing::HasSubstr(
                                      fmt::format("turn the avatar's root node by {:.0f} degrees", std::abs(degrees))));
      }
  }
}

TEST(Retarget, TheBodyWalksTheWayThatTheAvatarFaces) {
  const BvhMotion motion = parse_bvh(test::made_bvh(test::made_motion("walk"), "z", "A"), "walk.bvh");
  RetargetReport report;
  const auto travel = [&](const Avatar& avatar) {
    const Animation animation = retarget(motion, avatar, {}, "walk.bvh", report);
    return Stage(avatar, animation, animation.duration_s)["pelvis"] - Stage(avatar, animation, 0)["pelvis"];
  };
  for (int quarters = 0; quarters < 4; ++quarters) {
    const auto facing = static_cast<Facing>(quarters);
    const Avatar turned = parse_avatar_glb(test::turned_glb(builtin_avatar_glb(), quarters), "turned.glb");
    EXPECT_GT(glm::dot(travel(turned), forward_of(facing)), 0.8) << "as found: " << to_string(facing);
    EXPECT_TRUE(report.deviations.empty()) << report.deviations.front().what;
    Avatar asked = mannequin();
    set_facing(asked.facing, facing, AvatarFacing::By::kAsked);
    EXPECT_GT(glm::dot(travel(asked), forward_of(facing)), 0.8) << "as asked: " << to_string(facing);
  }
}

TEST(Retarget, TheAxisThatIsAskedForIsUp) {
  const BvhMotion motion = parse_bvh(test::made_bvh(test::made_motion("walk"), "y", "x"), "walk.bvh");
  RetargetReport report;
  retarget(motion, mannequin(), {}, "walk.bvh", report);
  EXPECT_EQ(report.up.up, glm::dvec3(0, 1, 0));
  EXPECT_EQ(report.up.by, UpAxis::By::kGround);
  const Animation animation = retarget(motion, mannequin(), {.up = glm::dvec3(0, 0, 1)}, "walk.bvh", report);
  EXPECT_EQ(report.up.by, UpAxis::By::kAsked);
  EXPECT_GT(std::abs(Stage(mannequin(), animation, 0).direction("pelvis", "head").z), 0.99) << "who walked, lies";
}

TEST(BodyRoles, AreFoundInTheNamesOfManyPrograms) {
  struct Case {
    const char* name;
    BodyPart part;
    BodySide side;
  };
  const Case cases[] = {{"mixamorig:LeftUpLeg", BodyPart::kUpperLeg, BodySide::kLeft},
                        {"mixamorig:RightForeArm", BodyPart::kLowerArm, BodySide::kRight},
                        {"J_Bip_L_UpperArm", BodyPart::kUpperArm, BodySide::kLeft},
                        {"leftUpperArm", BodyPart::kUpperArm, BodySide::kLeft},
                        {"Bip01 R Calf", BodyPart::kLowerLeg, BodySide::kRight},
                        {"Character1_LeftLeg", BodyPart::kLowerLeg, BodySide::kLeft},
                        {"lShldr", BodyPart::kUpperArm, BodySide::kLeft},
                        {"rForeArm", BodyPart::kLowerArm, BodySide::kRight},
                        {"LeftElbow", BodyPart::kLowerArm, BodySide::kLeft},
                        {"thigh.R", BodyPart::kUpperLeg, BodySide::kRight},
                        {"DEF-foot.L", BodyPart::kFoot, BodySide::kLeft},
                        {"CC_Base_R_Hand", BodyPart::kHand, BodySide::kRight},
                        {"upper_arm_left", BodyPart::kUpperArm, BodySide::kLeft},
                        {"LoArm_R", BodyPart::kLowerArm, BodySide::kRight},
                        {"Hips", BodyPart::kHips, BodySide::kNone},
                        {"Bip01 Pelvis", BodyPart::kHips, BodySide::kNone},
                        {"LeftToeBase", BodyPart::kToes, BodySide::kLeft}};
  for (const Case& one : cases) {
    const NamedJoint joint = {one.name, -1};
    const auto roles = body_roles(std::span(&joint, 1));
    ASSERT_TRUE(roles[0]) << one.name;
    EXPECT_EQ(*roles[0], (BodyRole{one.part, one.side, 0})) << one.name;
  }
  for (const char* name : {"handIK.l", "Armature", "kneePole_L", "LeftUpLegTwist", "hand_socket_R", "tail01", ""}) {
    const NamedJoint joint = {name, -1};
    EXPECT_FALSE(body_roles(std::span(&joint, 1))[0]) << name;
  }
  const NamedJoint index = {"LeftHandIndex2", -1};
  EXPECT_EQ(*body_roles(std::span(&index, 1))[0], (BodyRole{BodyPart::kIndex, BodySide::kLeft, 2}));
}

}  // namespace
}  // namespace vestige
