// The built-in layouts, on the built-in avatar and on others.

#include "analysis/mapping/layouts.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>

#include "analysis/mapping/map_check.hpp"
#include "analysis/mapping/skin_patches.hpp"
#include "tests/analysis/mapping/map_fixture.hpp"
#include "tests/support/builtin_map.hpp"
#include "tests/support/message_of.hpp"
#include "tests/support/test_data.hpp"
#include "traces/base/error.hpp"
#include "traces/gltf/avatar_gltf.hpp"

namespace vestige {
namespace {

using test::mannequin;
using test::message_of;
using test::read;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

template <typename Visit>
void for_patches(const BodySurface& surface, double step_m, const Visit& visit) {
  for (std::uint32_t i = 0; i < surface.avatar().triangles.size(); ++i) {
    const SkinPatches patches = patches_of_length(surface, i, step_m);
    patches.for_each([&](const SkinPoint& p) { visit(p, surface.area_m2(i) / static_cast<double>(patches.count())); });
  }
}

class EveryLayout : public ::testing::TestWithParam<std::string> {};

/// The region's own point decides what should fire; near a border, half a texel decides.
TEST_P(EveryLayout, FiresTheRegionThatThePointIsInAlsoAcrossSeamsOfTheTexture) {
  const RegionPlan plan(mannequin(), parse_region_file(layout_regions_json(GetParam()), "layout"), "layout");
  const ActuatorMap map = read(make_layout(test::builtin_avatar(), GetParam()));
  ASSERT_EQ(map.actuator_count, plan.actuator_count());
  const BodySurface& surface = mannequin().surface();
  std::size_t points = 0;
  std::size_t wrong = 0;
  std::size_t black_inside = 0;
  std::vector<glm::dvec3> black;
  std::vector<glm::dvec3> without;
  for (std::uint32_t i = 0; i < surface.avatar().triangles.size(); ++i) {
    // Along the edges, where charts end, as well as inside.
    constexpr int kSteps = 12;
    for (int a = 0; a <= kSteps; ++a)
      for (int b = 0; a + b <= kSteps; ++b) {
        const SkinPoint p = {i, glm::dvec3(a, b, kSteps - a - b) / double{kSteps}};
        const std::uint16_t wanted = plan.at(p);
        const std::uint16_t found = map.at(surface.texture_coordinate(p));
        ++points;
        if (wanted == 0) without.push_back(surface.position_m(p));
        if (wanted == found) continue;
        ++wrong;
        if (found != 0) continue;
        black.push_back(surface.position_m(p));
      }
  }
  // Black is only the skin right beside that without an actuator: within three texels of it, 6 mm.
  for (const glm::dvec3& at : black) {
    double nearest_m = 1;
    for (const glm::dvec3& none : without) nearest_m = std::min(nearest_m, glm::distance(at, none));
    if (nearest_m > 0.006) ++black_inside;
  }
  EXPECT_LT(static_cast<double>(wrong), 0.02 * static_cast<double>(points));
  EXPECT_EQ(black_inside, 0U);
}

TEST_P(EveryLayout, IsSoundAndItsLeftIsAsLargeAsItsRight) {
  const ActuatorMapFiles files = make_layout(test::builtin_avatar(), GetParam());
  const ActuatorMap map = read(files);
  EXPECT_THAT(map.warnings, IsEmpty());
  const MapCheck check = check_map(mannequin(), map, "builtin");
  for (const MapFinding& finding : check.findings) EXPECT_EQ(finding.cause, "") << finding.kind;
  double left_m2 = 0;
  double right_m2 = 0;
  for (std::size_t i = 0; i < map.actuator_count; ++i) {
    ASSERT_TRUE(map.position_m[i].has_value());
    const double x_m = map.position_m[i]->x;
    if (map.names[i] == "head") {
      EXPECT_NEAR(x_m, 0, 0.02);
      continue;
    }
    (x_m > 0 ? left_m2 : right_m2) += check.actuators[i].area_m2;
    EXPECT_EQ(check.actuators[i].pieces, 1U) << map.names[i];
    EXPECT_GT(check.actuators[i].area_m2, 0.003) << map.names[i];
    if (map.names[i].find("left") != std::string::npos) {
      EXPECT_GT(x_m, 0) << map.names[i];
    }
    if (map.names[i].find("right") != std::string::npos) {
      EXPECT_LT(x_m, 0) << map.names[i];
    }
  }
  EXPECT_NEAR(left_m2 / right_m2, 1, 0.01);
}

TEST_P(EveryLayout, IsTheSameBytesEveryTime) {
  const ActuatorMapFiles first = make_layout(test::builtin_avatar(), GetParam());
  const ActuatorMapFiles second = make_layout(test::builtin_avatar(), GetParam());
  EXPECT_EQ(first.png, second.png);
  EXPECT_EQ(first.json, second.json);
}

INSTANTIATE_TEST_SUITE_P(Layouts, EveryLayout, ::testing::ValuesIn(layout_names()));

TEST(Layouts, HaveAsManyActuatorsAsTheirNamesSay) {
  const auto count = [](const char* layout) {
    return read(make_layout(test::builtin_avatar(), layout)).actuator_count;
  };
  EXPECT_EQ(count("paper6"), 6U);
  EXPECT_EQ(count("torso16"), 16U);
  EXPECT_EQ(count("torso40"), 40U);
  EXPECT_EQ(count("body"), 21U);
  EXPECT_THAT(message_of([] { make_layout(test::builtin_avatar(), "torso"); }), HasSubstr("there is no such layout"));
}

TEST(Layouts, OfThePaperIsTheBuiltInMapButForItsBorders) {
  const ActuatorMap map = read(make_layout(test::builtin_avatar(), "paper6"));
  EXPECT_EQ(map.names, test::builtin_map().names);
  const BodySurface& surface = mannequin().surface();
  double mapped_m2 = 0;
  double same_m2 = 0;
  for_patches(surface, 0.01, [&](const SkinPoint& p, double area_m2) {
    const glm::dvec2 at = surface.texture_coordinate(p);
    const std::uint16_t old = test::builtin_map().at(at);
    if (old == 0 && map.at(at) == 0) return;
    mapped_m2 += area_m2;
    if (old == map.at(at)) same_m2 += area_m2;
  });
  EXPECT_GT(same_m2, 0.95 * mapped_m2);
}

TEST(Layouts, AreTakenWhereverAMapIsNamed) {
  EXPECT_TRUE(is_layout("torso40"));
  EXPECT_FALSE(is_layout("builtin"));
  EXPECT_EQ(read_map_files(test::builtin_avatar(), "paper6").json, make_layout(test::builtin_avatar(), "paper6").json);
  EXPECT_FALSE(read_map_files(test::builtin_avatar(), "builtin").png.empty());
  EXPECT_TRUE(read_map_files(test::builtin_avatar(), "none").png.empty());
}

TEST(Layouts, LieOnRealAvatarsByTheirJointsNames) {
  for (const char* name : {"CesiumMan.glb", "KayKit_Knight.glb", "MakeHumanBase_cc0_8inf.glb", "greenman.glb"}) {
    const auto path = test::data("avatars/avatars") / name;
    VESTIGE_REQUIRE_DATA(path);
    const Avatar avatar = parse_avatar_glb(read_avatar_glb(path), name);
    EXPECT_EQ(Body(avatar).understanding(), Understanding::kJoints) << name;
    EXPECT_EQ(read(make_layout(avatar, "paper6")).actuator_count, 6U) << name;
  }
}

TEST(Layouts, OfTheWholeBodyLeaveOutWhatAnAvatarDoesNotHave) {
  for (const char* name : {"Fox.glb", "greenman.glb"}) {
    const auto path = test::data("avatars/avatars") / name;
    VESTIGE_REQUIRE_DATA(path);
    const MadeMap map = make_layout_map(parse_avatar_glb(read_avatar_glb(path), name), "body");
    EXPECT_GT(map.actuators.size(), 1U) << name;
    EXPECT_EQ(map.actuators.size() + map.left_out.size(), 21U) << name;
  }
}

/// How much of its skin fires what the layout means there, by area.
double right_share(const Avatar& avatar, const ActuatorMap& map, std::string_view layout) {
  const Body body(avatar);
  const RegionPlan plan(body, parse_region_file(layout_regions_json(layout), layout), layout);
  double right_m2 = 0;
  double all_m2 = 0;
  for_patches(body.surface(), 0.01, [&](const SkinPoint& p, double area_m2) {
    const std::uint16_t meant = plan.at(p);
    const std::uint16_t found = map.at(p.triangle, body.surface().texture_coordinate(p));
    if (meant == 0 && found == 0) return;
    all_m2 += area_m2;
    if (meant == found) right_m2 += area_m2;
  });
  return right_m2 / all_m2;
}

TEST(Layouts, GoByTriangleWhereTheTextureCannotTellTheirRegionsApart) {
  EXPECT_EQ(read(make_layout(test::builtin_avatar(), "paper6")).triangle_count, 0U);
  EXPECT_THAT(make_layout(test::builtin_avatar(), "paper6").warnings, IsEmpty());

  Avatar mirrored = test::builtin_avatar();
  for (glm::vec2& at : mirrored.texture_coordinate) at.x = std::abs(2 * at.x - 1);
  const ActuatorMapFiles files = make_layout(mirrored, "paper6");
  EXPECT_THAT(files.warnings, ElementsAre(HasSubstr("cannot tell its skin apart")));
  const ActuatorMap map = parse_actuator_map(files, mirrored, "paper6");
  EXPECT_EQ(map.triangle_count, mirrored.triangles.size());
  EXPECT_GT(right_share(mirrored, map, "paper6"), 0.9);

  Avatar bare = test::builtin_avatar();
  bare.texture_coordinate.assign(bare.texture_coordinate.size(), glm::vec2(0));
  const ActuatorMapFiles without = make_layout(bare, "torso16");
  EXPECT_THAT(without.warnings, IsEmpty());
  EXPECT_GT(right_share(bare, parse_actuator_map(without, bare, "torso16"), "torso16"), 0.8);
  EXPECT_TRUE(check_map(Body(bare), parse_actuator_map(without, bare, "torso16"), "bare").good());
}

TEST(Layouts, GoByTriangleWhereATexelOrMoreOfTheTextureIsAllTheSkinHas) {
  for (const float scale : {0.0004F, 3.0F}) {  // a palette's swatch; tiles
    Avatar avatar = test::builtin_avatar();
    for (glm::vec2& at : avatar.texture_coordinate) at *= scale;
    const ActuatorMapFiles files = make_layout(avatar, "torso16");
    EXPECT_GT(right_share(avatar, parse_actuator_map(files, avatar, "torso16"), "torso16"), 0.8) << scale;
  }
}

TEST(Layouts, GoByTriangleAtOnceWhereManyTrianglesCoverAllOfTheTexture) {
  Avatar avatar = test::builtin_avatar();
  for (std::size_t i = 0; i < avatar.texture_coordinate.size(); ++i)
    avatar.texture_coordinate[i] = glm::vec2(i % 3 == 1 ? 1 : 0, i % 3 == 2 ? 1 : 0);
  std::vector<double> shares;
  const MadeMap map = make_layout_map(avatar, "torso16", [&](double share) { shares.push_back(share); });
  EXPECT_THAT(map.warnings, ElementsAre(HasSubstr("times over, so the map gives each triangle an actuator instead")));
  EXPECT_EQ(map.triangle_count, avatar.triangles.size());
  EXPECT_GT(right_share(avatar, parse_actuator_map(map.files, avatar, "torso16"), "torso16"), 0.8);
  EXPECT_TRUE(std::ranges::is_sorted(shares));
  EXPECT_GT(shares.size(), 10U);
  EXPECT_LE(shares.back(), 1);
}

TEST(Layouts, ThatLackSkinAreRefusedHoweverTheTextureIsCovered) {
  Avatar hollow = test::builtin_avatar();  // open at the left of the front
  std::erase_if(hollow.triangles, [&](const glm::uvec3& triangle) {
    return std::ranges::any_of(std::array{triangle.x, triangle.y, triangle.z}, [&](std::uint32_t corner) {
      return hollow.position_bind[corner].x > 0 && hollow.position_bind[corner].z > 0;
    });
  });
  const auto refusal = [&] { return message_of([&] { make_layout(hollow, "torso16"); }); };
  EXPECT_THAT(refusal(), HasSubstr("no skin belongs to it"));
  for (std::size_t i = 0; i < hollow.texture_coordinate.size(); ++i)
    hollow.texture_coordinate[i] = glm::vec2(i % 3 == 1 ? 1 : 0, i % 3 == 2 ? 1 : 0);
  EXPECT_THAT(refusal(), HasSubstr("no skin belongs to it")) << "other actuators would get its number";
}

TEST(Layouts, LeaveNoActuatorOutThatIsSmallerThanATriangle) {
  const auto path = test::data("avatars/avatars/greenman.glb");
  VESTIGE_REQUIRE_DATA(path);
  const Avatar avatar = parse_avatar_glb(read_avatar_glb(path), "greenman");
  EXPECT_EQ(parse_actuator_map(make_layout(avatar, "torso16"), avatar, "torso16").actuator_count, 16U);
}

TEST(Layouts, TellTheHalvesOfGamesAvatarsApart) {
  for (const char* name : {"KayKit_Knight.glb", "greenman.glb"}) {
    const auto path = test::data("avatars/avatars") / name;
    VESTIGE_REQUIRE_DATA(path);
    const Avatar avatar = parse_avatar_glb(read_avatar_glb(path), name);
    const ActuatorMapFiles files = make_layout(avatar, "paper6");
    EXPECT_GT(right_share(avatar, parse_actuator_map(files, avatar, name), "paper6"), 0.75) << name;
  }
}

Avatar skeleton_of(const std::vector<std::pair<const char*, int>>& joints) {
  Avatar avatar = test::rigid_avatar({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}});
  avatar.nodes.clear();
  avatar.node_order.clear();
  for (const auto& [name, parent] : joints) {
    Node node;
    node.name = name;
    node.parent = parent;
    node.rest.translation = {std::string_view(name).find("_l") != std::string_view::npos ? 0.3F : 0.0F, 0.1F, 0.0F};
    avatar.node_order.push_back(static_cast<int>(avatar.nodes.size()));
    avatar.nodes.push_back(node);
  }
  return avatar;
}

TEST(Layouts, AreListedWhereANameIsNeitherALayoutNorAFile) {
  const auto read_named = [](const char* map) {
    return message_of([&] { static_cast<void>(read_map_files(test::builtin_avatar(), map)); });
  };
  EXPECT_EQ(read_named("torso41"),
            "torso41: there is no such file\n  the layouts are: paper6, torso16, torso40, body, builtin");
  EXPECT_EQ(read_named("torso41.png"), "torso41.png: there is no such file\n  check the name");
  for (const char* known : {"none", "builtin", "paper6"}) EXPECT_EQ(read_named(known), "no error");
}

TEST(JointNames, OfCommonRigsSayWhichPartTheyAre) {
  using enum SkinPart;
  const auto parts = [](const std::vector<std::pair<const char*, int>>& joints) {
    return parts_of_nodes(skeleton_of(joints));
  };
  EXPECT_THAT(parts({{"mixamorig:Hips", -1},
                     {"mixamorig:Spine", 0},
                     {"mixamorig:LeftShoulder", 1},
                     {"mixamorig:LeftArm", 2},
                     {"mixamorig:LeftForeArm", 3},
                     {"mixamorig:LeftHandIndex1", 4},
                     {"mixamorig:LeftUpLeg", 0},
                     {"mixamorig:LeftLeg", 6},
                     {"mixamorig:LeftToeBase", 7}}),
              ElementsAre(kTorso, kTorso, kTorso, kUpperArm, kForearm, kHand, kThigh, kShin, kFoot));
  EXPECT_THAT(parts({{"J_Bip_C_Head", -1}, {"J_Sec_Hair1", 0}, {"J_Bip_L_LowerArm", -1}, {"J_Bip_L_UpperLeg", -1}}),
              ElementsAre(kHead, kHead, kForearm, kThigh));
  EXPECT_THAT(parts({{"Armature", -1}, {"arm_joint_L_1", 0}, {"arm_joint_L_2", 1}, {"arm_joint_L_3", 2}, {"x", 3}}),
              ElementsAre(std::nullopt, kUpperArm, kForearm, kHand, kHand));
  EXPECT_THAT(parts({{"neck_joint_1", -1}, {"neck_joint_2", 0}}), ElementsAre(kNeck, kHead));
}

}  // namespace
}  // namespace vestige
