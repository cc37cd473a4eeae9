// Which way an avatar faces.

#include "traces/body/find_facing.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

#include "tests/support/made/edited_glb.hpp"
#include "tests/support/made/made_avatars.hpp"
#include "tests/support/test_data.hpp"
#include "traces/body/bone_names.hpp"
#include "traces/gltf/avatar_gltf.hpp"

namespace vestige {
namespace {

using ::testing::HasSubstr;
using By = AvatarFacing::By;

AvatarFacing facing_of(const std::vector<std::byte>& glb) {
  return parse_avatar_glb(glb, "avatar.glb").facing;
}

/// The mannequin after `edit`.
template <typename Edit>
AvatarFacing facing_after(const Edit& edit) {
  return facing_of(test::edited_glb(builtin_avatar_glb(), edit));
}

/// Takes the sides out of the joints' names, but of those to keep.
void forget_sides(nlohmann::json& json, const std::set<std::string>& keep = {}) {
  for (const std::string& joint : test::side_joints())
    for (const char* side : {"_left", "_right"})
      if (!keep.contains(joint)) test::node_named(json, joint + side)["name"] = "something";
}

TEST(Facing, TurnsPlacesExactlyAndBack) {
  const glm::dvec3 p(0.1, 2, -0.3);
  for (const Facing facing : {Facing::kPlusZ, Facing::kPlusX, Facing::kMinusZ, Facing::kMinusX}) {
    EXPECT_EQ(turned_from_front(turned_to_front(p, facing), facing), p);
    EXPECT_EQ(turned_to_front(forward_of(facing), facing), glm::dvec3(0, 0, 1)) << to_string(facing);
    EXPECT_EQ(nearest_facing(forward_of(facing)), facing);
    EXPECT_EQ(forward_from_left(turned_from_front({1, 0, 0}, facing)), forward_of(facing));
    EXPECT_EQ(facing_named(to_string(facing)), facing);
  }
  EXPECT_EQ(forward_of(Facing::kPlusX), glm::dvec3(1, 0, 0));
  EXPECT_EQ(forward_of(Facing::kMinusX), glm::dvec3(-1, 0, 0));
  EXPECT_EQ(facing_named("z"), std::nullopt);
}

TEST(Facing, OfEveryMadeAvatarIsFoundByItsNamesHoweverItIsTurned) {
  for (const auto& [name, glb] : test::made_avatars())
    for (int quarters = 0; quarters < 4; ++quarters) {
      const AvatarFacing facing = facing_of(test::turned_glb(glb, quarters));
      const int faces = (quarters + (name == "VRM 0.x" ? 2 : 0)) % 4;
      EXPECT_EQ(facing.axis, static_cast<Facing>(faces)) << name << ", " << quarters << " quarters";
      EXPECT_EQ(facing.by, By::kSides) << name;
      const bool contradicts_vrm = name.starts_with("VRM") && quarters != 0;
      EXPECT_EQ(facing.doubt.empty(), !contradicts_vrm) << name << ": " << facing.doubt;
    }
}

TEST(Facing, OfRealAvatarsIsFound) {
  VESTIGE_REQUIRE_DATA(test::data("avatars/avatars"));
  for (const char* file : {"CesiumMan.glb", "Fox.glb", "KayKit_Knight.glb", "MakeHumanBase_cc0_8inf.glb",
                           "RiggedFigure_3dsmax/RiggedFigure.gltf", "greenman.glb"}) {
    const std::vector<std::byte> glb = read_avatar_glb(test::data("avatars/avatars") / file);
    for (int quarters = 0; quarters < 4; ++quarters) {
      const AvatarFacing facing = facing_of(test::turned_glb(glb, quarters));
      EXPECT_EQ(facing.axis, static_cast<Facing>(quarters)) << file << ", " << to_string(facing.by);
      EXPECT_EQ(facing.doubt, "") << file;
      EXPECT_EQ(facing.lies_deg, std::nullopt) << file;
    }
  }
}

TEST(Facing, IsThatOfTheFeetIfNoNameTellsASide) {
  const AvatarFacing facing = facing_after([](nlohmann::json& json) {
    forget_sides(json, {"foot", "toes"});
    test::hang_below(json, {{"rotation", {0, 1, 0, 0}}});
  });
  EXPECT_EQ(facing.axis, Facing::kMinusZ);
  EXPECT_EQ(facing.by, By::kFeet);
  EXPECT_EQ(facing.doubt, "");
}

TEST(Facing, IsThatOfVrmsVersionIfNothingElseTells) {
  const auto of_version = [](const char* extension, nlohmann::json bones) {
    return facing_after([&](nlohmann::json& json) {
      forget_sides(json);
      json["extensionsUsed"].push_back(extension);
      json["extensions"][extension] = {{"humanoid", {{"humanBones", bones}}}};
    });
  };
  const AvatarFacing old = of_version("VRM", {{{"bone", "hips"}, {"node", 1}}});
  EXPECT_EQ(old.axis, Facing::kMinusZ);
  EXPECT_EQ(old.by, By::kVrm);
  const AvatarFacing now = of_version("VRMC_vrm", {{"hips", {{"node", 1}}}});
  EXPECT_EQ(now.axis, Facing::kPlusZ);
  EXPECT_EQ(now.by, By::kVrm);
}

/// A table that has one bone, or one that nobody knows, does not hide what the names tell.
TEST(Facing, IsThatOfTheNamesWhereATableIsNotWhole) {
  for (const char* bone : {"hips", "nonsense", "leftHips"}) {
    const Avatar avatar = parse_avatar_glb(
        test::edited_glb(builtin_avatar_glb(),
                         [&](nlohmann::json& json) {
                           json["extensionsUsed"].push_back("VRM");
                           json["extensions"]["VRM"]["humanoid"]["humanBones"] = {{{"bone", bone}, {"node", 1}}};
                         }),
        "partial.vrm");
    EXPECT_EQ(avatar.facing.axis, Facing::kPlusZ) << bone;
    EXPECT_EQ(avatar.facing.by, By::kSides) << bone;
    EXPECT_THAT(avatar.facing.doubt, HasSubstr("VRM 0.x faces -z")) << bone;
    EXPECT_GE(avatar.humanoid.node_of.size(), 20U) << bone;
    if (bone == std::string("hips")) continue;
    EXPECT_THAT(avatar.warnings,
                ::testing::Contains(HasSubstr("partial.vrm: extensions.VRM.humanoid.humanBones[0]: there "
                                              "is no bone")))
        << bone;
  }
}

TEST(VrmTable, WithManyFaultsHasTheFirstTenToldAndTheOthersCounted) {
  const auto warnings = [](int faults) {
    return parse_avatar_glb(test::edited_glb(builtin_avatar_glb(),
                                             [&](nlohmann::json& json) {
                                               json["extensionsUsed"].push_back("VRM");
                                               nlohmann::json& bones =
                                                   json["extensions"]["VRM"]["humanoid"]["humanBones"];
                                               for (int i = 0; i < faults; ++i)
                                                 bones.push_back({{"bone", "wing"}, {"node", i}});
                                             }),
                            "winged.vrm")
        .warnings;
  };
  const std::vector<std::string> ten = warnings(10);
  ASSERT_EQ(ten.size(), 10U);
  EXPECT_THAT(ten.back(), HasSubstr("humanBones[9]"));
  const std::vector<std::string> many = warnings(10'007);
  ASSERT_EQ(many.size(), 11U);
  EXPECT_EQ(many.back(), "winged.vrm: and 9997 more faults in its table of bones");
}

TEST(Facing, IsAssumedAndDoubtedIfNothingTells) {
  const AvatarFacing facing = facing_after([](nlohmann::json& json) { forget_sides(json); });
  EXPECT_EQ(facing.axis, Facing::kPlusZ);
  EXPECT_EQ(facing.by, By::kAssumed);
  EXPECT_THAT(facing.doubt, HasSubstr("which way it faces"));
}

TEST(Facing, IsDoubtedWhereNamesContradictTheFeet) {
  const AvatarFacing facing = facing_after([](nlohmann::json& json) {
    for (const std::string& joint : test::side_joints()) {
      nlohmann::json& left = test::node_named(json, joint + "_left");
      test::node_named(json, joint + "_right")["name"] = joint + "_left";
      left["name"] = joint + "_right";
    }
  });
  EXPECT_EQ(facing.axis, Facing::kMinusZ) << "the names say what is left";
  EXPECT_THAT(facing.doubt, HasSubstr("feet point to +z"));
}

TEST(Facing, IsDoubtedWhereTheNamesContradictEachOther) {
  const AvatarFacing facing = facing_after([](nlohmann::json& json) {
    test::node_named(json, "thigh_left")["name"] = "x";
    test::node_named(json, "thigh_right")["name"] = "thigh_left";
    test::node_named(json, "x")["name"] = "thigh_right";
  });
  EXPECT_EQ(facing.axis, Facing::kPlusZ);
  EXPECT_THAT(facing.doubt, HasSubstr("LeftUpperLeg and RightUpperLeg lie the other way round"));
}

TEST(Facing, BetweenTwoAxesIsDoubted) {
  const AvatarFacing facing = facing_after([](nlohmann::json& json) {
    test::hang_below(json, {{"rotation", {0, 0.3826834, 0, 0.9238795}}});
  });
  EXPECT_THAT(facing.doubt, HasSubstr("between two axes"));
}

/// A body that lies or hangs has neither a left nor a front, whatever its names and its feet seem to tell.
TEST(Facing, OfABodyThatDoesNotStandIsNotFound) {
  struct Case {
    double degrees;
    glm::dvec3 axis;
    double lies_deg;
  };
  const glm::dvec3 x(1, 0, 0);
  const glm::dvec3 z(0, 0, 1);
  auto avatars = test::made_avatars();
  avatars["built-in"] = builtin_avatar_glb();
  for (const auto& [name, glb] : avatars)
    for (const Case& one : {Case{-90, x, 90}, {90, x, 90}, {90, z, 90}, {-90, z, 90}, {180, z, 180}, {50, x, 50}}) {
      if (name == "sits" && one.degrees > 0 && one.axis == x) continue;  // which is a body on all fours
      const AvatarFacing facing = facing_of(test::laid_glb(glb, one.degrees, one.axis));
      ASSERT_TRUE(facing.lies_deg) << name << ", " << one.degrees;
      EXPECT_NEAR(*facing.lies_deg, one.lies_deg, 6) << name;
      EXPECT_EQ(facing.by, By::kAssumed) << name;
      EXPECT_EQ(facing.left, std::nullopt) << name;
      EXPECT_EQ(facing.doubt, "") << name;
    }
}

TEST(Facing, OfABodyThatLeansIsFound) {
  for (const double degrees : {-40.0, 0.0, 40.0}) {
    const AvatarFacing facing = facing_of(test::laid_glb(builtin_avatar_glb(), degrees, {1, 0, 0}));
    EXPECT_EQ(facing.lies_deg, std::nullopt) << degrees;
    EXPECT_EQ(facing.by, By::kSides) << degrees;
    EXPECT_EQ(facing.axis, Facing::kPlusZ) << degrees;
  }
}

/// Its trunk lies, and yet its left is left and its head is in front.
TEST(Facing, OfABodyOnAllFoursIsFound) {
  const auto bent = test::edited_glb(builtin_avatar_glb(), [](nlohmann::json& json) {
    for (const char* side : {"_left", "_right"}) test::turn_joint(json, std::string("thigh") + side, -80, {1, 0, 0});
  });
  const AvatarFacing facing = facing_of(test::laid_glb(bent, 80, {1, 0, 0}));
  EXPECT_EQ(facing.lies_deg, std::nullopt);
  EXPECT_EQ(facing.by, By::kSides);
  EXPECT_EQ(facing.axis, Facing::kPlusZ);
}

TEST(Facing, OfABodyWithoutAKnownHeadIsFoundAsEver) {
  const auto headless = test::edited_glb(builtin_avatar_glb(),
                                         [](nlohmann::json& json) { test::node_named(json, "head")["name"] = "x"; });
  EXPECT_EQ(facing_of(test::laid_glb(headless, 90, {1, 0, 0})).lies_deg, std::nullopt);
}

TEST(Facing, ThatIsAskedForDoesNotMakeABodyStand) {
  AvatarFacing facing = facing_of(test::laid_glb(builtin_avatar_glb(), 90, {1, 0, 0}));
  set_facing(facing, Facing::kMinusX, By::kAsked);
  EXPECT_EQ(facing.axis, Facing::kMinusX);
  EXPECT_TRUE(facing.lies_deg);
}

/// Adds a copy of everything that the file shows, which faces the other way 2 m to the left, with its own skin.
void add_second_body(nlohmann::json& json) {
  const std::size_t count = json["nodes"].size();
  nlohmann::json nodes = json["nodes"];
  for (nlohmann::json& node : nodes) {
    if (node.contains("children"))
      for (nlohmann::json& child : node["children"]) child = child.get<std::size_t>() + count;
    if (node.contains("skin")) node["skin"] = 1;
    json["nodes"].push_back(node);
  }
  nlohmann::json skin = json["skins"][0];
  skin.erase("skeleton");
  for (nlohmann::json& joint : skin["joints"]) joint = joint.get<std::size_t>() + count;
  json["skins"].push_back(skin);
  nlohmann::json other = {{"name", "other"}, {"rotation", {0, 1, 0, 0}}, {"translation", {2, 0, 0}}};
  for (const nlohmann::json& root : json["scenes"][0]["nodes"])
    other["children"].push_back(root.get<std::size_t>() + count);
  json["scenes"][0]["nodes"].push_back(json["nodes"].size());
  json["nodes"].push_back(other);
}

/// Bones that only the second body has are not mixed with those of the first.
TEST(BodyRoles, OfTwoBodiesAreThoseOfTheFirstWhichIsSaid) {
  const Avatar two = parse_avatar_glb(test::edited_glb(builtin_avatar_glb(),
                                                       [](nlohmann::json& json) {
                                                         add_second_body(json);
                                                         test::node_named(json, "toes_left")["name"] = "x";
                                                       }),
                                      "two.glb");
  const std::size_t one = parse_avatar_glb(builtin_avatar_glb(), "builtin").nodes.size();
  EXPECT_FALSE(two.humanoid.node_of.contains("LeftToes"));
  EXPECT_EQ(two.humanoid.node_of.size(), 20U);
  for (const auto& [bone, node] : two.humanoid.node_of) EXPECT_LT(node, one) << bone;
  EXPECT_EQ(two.facing.axis, Facing::kPlusZ);
  EXPECT_THAT(two.warnings, ::testing::Contains(::testing::AllOf(HasSubstr("two.glb: has 2 skeletons of bodies"),
                                                                 HasSubstr("'pelvis'"))));
  EXPECT_THAT(parse_avatar_glb(builtin_avatar_glb(), "builtin").warnings, ::testing::IsEmpty());
}

TEST(BodyRoles, OfAVrmAreThoseOfItsTable) {
  const auto made = test::made_avatars();
  const Avatar named = parse_avatar_glb(builtin_avatar_glb(), "builtin");
  for (const char* name : {"VRM 0.x", "VRM 1.0"}) {
    const Avatar vrm = parse_avatar_glb(made.at(name), name);
    const auto roles = body_roles(vrm);
    const auto expected = body_roles(named);
    for (std::size_t i = 0; i < expected.size(); ++i) EXPECT_EQ(roles[i], expected[i]) << name << ", node " << i;
  }
}

TEST(BodyRoles, HaveANameEachThatLeadsBack) {
  const BodyRole roles[] = {{BodyPart::kHips, BodySide::kNone, 0},
                            {BodyPart::kSpine, BodySide::kNone, 2},
                            {BodyPart::kUpperArm, BodySide::kLeft, 0},
                            {BodyPart::kLittle, BodySide::kRight, 3}};
  const char* names[] = {"Hips", "UpperChest", "LeftUpperArm", "RightLittleDistal"};
  for (std::size_t i = 0; i < std::size(roles); ++i) {
    EXPECT_EQ(bone_name(roles[i]), names[i]);
    EXPECT_EQ(role_of_bone(names[i]), roles[i]);
  }
  EXPECT_EQ(role_of_bone("Tail"), std::nullopt);
}

}  // namespace
}  // namespace vestige
