// Maps made from regions, and what is wrong with maps, on the built-in avatar and on small ones made for it.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <glm/geometric.hpp>

#include "analysis/mapping/layouts.hpp"
#include "analysis/mapping/map_check.hpp"
#include "analysis/mapping/map_maker.hpp"
#include "analysis/mapping/skin_patches.hpp"
#include "tests/support/builtin_avatar.hpp"
#include "tests/support/builtin_map.hpp"
#include "tests/support/message_of.hpp"
#include "tests/support/small_avatar.hpp"
#include "tests/support/test_data.hpp"
#include "traces/avatar_gltf.hpp"
#include "traces/error.hpp"

namespace vestige {
namespace {

using test::message_of;
using ::testing::Contains;
using ::testing::Each;
using ::testing::ElementsAre;
using ::testing::Field;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

const Body& mannequin() {
  static const Body body(test::builtin_avatar());
  return body;
}

MadeMap make(const Body& body, const std::string& regions, MapSettings settings = {}) {
  const RegionPlan plan(body, parse_region_file(regions, "mine.json"), "mine.json");
  return make_map(body, plan, settings, "mine.json", "man.glb");
}

ActuatorMap read(const ActuatorMapFiles& files) {
  return parse_actuator_map(files.png, files.json, "made");
}

template <typename Visit>
void for_patches(const BodySurface& surface, double step_m, const Visit& visit) {
  for (std::uint32_t i = 0; i < surface.avatar().triangles.size(); ++i) {
    const SkinPatches patches = patches_of_length(surface, i, step_m);
    patches.for_each([&](const SkinPoint& p) { visit(p, surface.area_m2(i) / static_cast<double>(patches.count())); });
  }
}

/// A rectangle of skin in the plane z = 0, from (x, y) on, shown by the same rectangle of the texture, moved by
/// `shift`.
void add_rectangle(Avatar& avatar, glm::vec2 low, glm::vec2 high, glm::vec2 shift = glm::vec2(0)) {
  const auto first = static_cast<std::uint32_t>(avatar.position_bind.size());
  for (const glm::vec2 corner : {low, glm::vec2(high.x, low.y), high, glm::vec2(low.x, high.y)}) {
    avatar.position_bind.emplace_back(corner, 0.0F);
    avatar.texture_coordinate.push_back(corner + shift);
    Influences rigid;
    rigid.weight[0] = 1;
    avatar.influences.push_back(rigid);
  }
  avatar.triangles.emplace_back(first, first + 1, first + 2);
  avatar.triangles.emplace_back(first, first + 2, first + 3);
}

Avatar flat_avatar() {
  Avatar avatar = test::rigid_avatar({}, {});
  return avatar;
}

/// A map of side x side texels whose actuators `actuator_at` says, by column and row.
ActuatorMap painted(std::uint32_t side, std::size_t actuators,
                    const std::function<int(std::uint32_t, std::uint32_t)>& actuator_at) {
  ActuatorMap map;
  map.width = side;
  map.height = side;
  map.actuator.clear();
  for (std::uint32_t row = 0; row < side; ++row)
    for (std::uint32_t column = 0; column < side; ++column)
      map.actuator.push_back(static_cast<std::uint16_t>(actuator_at(column, row)));
  map.actuator_count = actuators;
  for (std::size_t i = 1; i <= actuators; ++i) map.names.push_back("a" + std::to_string(i));
  map.position_m.resize(actuators);
  return map;
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

TEST(Layouts, SayWhenTheTextureCannotTellTheirRegionsApart) {
  Avatar mirrored = test::builtin_avatar();
  for (glm::vec2& at : mirrored.texture_coordinate) at.x = std::abs(2 * at.x - 1);
  EXPECT_THAT(make_layout_map(mirrored, "paper6").warnings, Contains(HasSubstr("texels")));
  EXPECT_THAT(make_layout_map(test::builtin_avatar(), "paper6").warnings, IsEmpty());
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

TEST(Regions, AreWhereHeightAngleAndSideSay) {
  const MadeMap map = make(mannequin(), R"({"regions": [
      {"name": "navel", "part": "vest", "height": [0, 0.4], "angle": [-20, 20]},
      {"name": "spine", "part": "vest", "angle": [170, 190]},
      {"name": "chest, left", "part": "vest", "height": [0.6, 1], "side": ["front", "left"]},
      {"name": "wrist", "below": ["hand_right"], "height": [0.8, 1]},
      {"name": "knees", "joints": ["shin_*"], "height_m": [0.4, 0.5], "side": "front"}]})");
  ASSERT_THAT(map.actuators, SizeIs(5));
  const auto at = [&](std::size_t i) { return map.actuators[i].position_m; };
  EXPECT_NEAR(at(0).x, 0, 0.01);
  EXPECT_GT(at(0).z, 0.05);
  EXPECT_LT(at(0).y, 1.15);
  EXPECT_NEAR(at(1).x, 0, 0.01);
  EXPECT_LT(at(1).z, -0.05);
  EXPECT_GT(at(2).x, 0.03);
  EXPECT_GT(at(2).y, 1.24);
  EXPECT_LT(at(3).x, -0.3);
  EXPECT_GE(at(4).y, 0.4);
  EXPECT_LT(at(4).y, 0.5);
}

TEST(Regions, GoToTheFirstThatAPointBelongsToAndOneNameIsOneActuator) {
  const MadeMap map = make(mannequin(), R"({"regions": [
      {"name": "hands", "part": "hand left"},
      {"name": "all but that", "part": ["hand", "head"]},
      {"name": "hands", "part": "foot"}]})");
  ASSERT_THAT(map.actuators, SizeIs(2));
  EXPECT_EQ(map.actuators[0].name, "hands");
  const MadeMap lone = make(mannequin(), R"({"regions": [{"name": "a", "part": ["hand left", "foot"]}]})");
  EXPECT_NEAR(map.actuators[0].area_m2, lone.actuators[0].area_m2, 1e-9);
}

/// Every point has the actuator that is nearest along the skin: the front of the chest is not reached through the body.
TEST(Regions, AroundActuatorsAreNearestAlongTheSurface) {
  const MadeMap map = make(mannequin(), R"({"regions": [{"name": "v", "part": "vest", "actuators": [
      {"name": "front", "height": 0.5, "angle": 0}, {"name": "back", "height": 0.5, "angle": 180}]}]})");
  ASSERT_THAT(map.actuators, SizeIs(2));
  EXPECT_NEAR(map.actuators[0].position_m.x, 0, 0.01);
  EXPECT_GT(map.actuators[0].position_m.z, 0.06);
  EXPECT_LT(map.actuators[1].position_m.z, -0.06);
  EXPECT_NEAR(map.actuators[0].area_m2 / map.actuators[1].area_m2, 1, 0.25);
  const MadeMap spot = make(mannequin(), R"({"regions": [{"name": "v", "part": "vest", "radius_m": 0.05,
      "actuators": [{"name": "heart", "position_m": [0.06, 1.3, 0.2]}]}]})");
  EXPECT_NEAR(spot.actuators[0].area_m2, 3.14159 * 0.05 * 0.05, 0.0012);
}

TEST(Regions, ThatCannotBeSayWhichAndWhy) {
  const auto cause = [](const std::string& regions) {
    return message_of([&] { make(mannequin(), R"({"regions": [)" + regions + "]}"); });
  };
  EXPECT_THAT(cause(R"({"name": "a", "part": "trunk"})"),
              ::testing::AllOf(HasSubstr("mine.json, region 'a'"), HasSubstr("no part 'trunk'"), HasSubstr("forearm")));
  EXPECT_THAT(cause(R"({"name": "a", "joints": ["spline"]})"),
              ::testing::AllOf(HasSubstr("no joint 'spline'"), HasSubstr("thoracic_spine")));
  EXPECT_THAT(cause(R"({"name": "a", "prat": "torso"})"), HasSubstr("no field 'prat'"));
  EXPECT_THAT(cause(R"({"part": "torso"})"), HasSubstr("regions[0]: has no 'name'"));
  EXPECT_THAT(cause(R"({"name": "a", "height": [0.5, 0.5]})"), HasSubstr("'height' does not go from the lower"));
  EXPECT_THAT(cause(R"({"name": "a", "height": [0, 2]})"), HasSubstr("goes beyond"));
  EXPECT_THAT(cause(R"({"name": "a", "side": "top"})"), HasSubstr("no side 'top'"));
  EXPECT_THAT(cause(R"({"name": "a", "side": ["front", "back"], "grid": {"rows": 1, "columns": 2}})"),
              HasSubstr("opposite sides"));
  EXPECT_THAT(cause(R"({"name": "a", "grid": {"rows": 0, "columns": 2}})"), HasSubstr("'rows' is not a whole number"));
  EXPECT_THAT(cause(R"({"name": "a", "grid": {"rows": 1, "columns": 2, "names": ["x"]}})"),
              HasSubstr("1 names for 2 actuators"));
  EXPECT_THAT(cause(R"({"name": "a", "actuators": [{"name": "x"}]})"), HasSubstr("actuators[0]: needs either"));
  EXPECT_THAT(cause(R"({"name": "a", "radius_m": 1})"), HasSubstr("radius_m"));
  EXPECT_THAT(cause(R"({"name": "a", "part": "vest", "actuators": [{"name": "x", "height": 0, "angle": 0},
                        {"name": "x", "height": 1, "angle": 0}]})"),
              ::testing::AllOf(HasSubstr("region 'a'"), HasSubstr("the name 'x' stands twice")));
  EXPECT_THAT(cause(R"({"name": "a", "part": "vest", "height_m": [3, 4]})"),
              ::testing::AllOf(HasSubstr("actuator 'a'"), HasSubstr("no skin belongs to it")));
  EXPECT_THAT(cause(R"({"name": "a"}, {"name": "b"})"), HasSubstr("actuator 'b'"));
  EXPECT_THAT(message_of([] { parse_region_file("{\"regions\": [", "mine.json"); }),
              HasSubstr("mine.json, byte 14: is not JSON"));
  EXPECT_THAT(message_of([] { parse_region_file("[]", "mine.json"); }), HasSubstr("no list 'regions'"));
}

/// No skin of the neck hangs on a hand.
TEST(Regions, WithoutAnySkinAreRefusedOrLeftOutAsAsked) {
  const std::string nowhere = R"({"name": "nowhere", "part": "neck", "joints": ["hand_*"]})";
  const std::string sites = R"({"name": "s", "part": "neck", "joints": ["hand_*"],
      "actuators": [{"name": "site", "height": 0, "angle": 0}]})";
  const std::string head = R"({"name": "head", "part": "head"})";
  MapSettings leave_out;
  leave_out.empty = EmptyRegions::kLeaveOut;
  const std::string all = R"({"regions": [)" + nowhere + "," + sites + "," + head + "]}";
  const MadeMap map = make(mannequin(), all, leave_out);
  ASSERT_THAT(map.actuators, SizeIs(1));
  EXPECT_EQ(map.actuators[0].name, "head");
  EXPECT_THAT(map.left_out, ElementsAre("nowhere", "site"));
  EXPECT_THAT(message_of([&] { make(mannequin(), all); }), HasSubstr("actuator 'nowhere': no skin belongs to it"));
  EXPECT_THAT(message_of([&] { make(mannequin(), R"({"regions": [)" + nowhere + "]}", leave_out); }),
              HasSubstr("no skin of this avatar belongs to any"));
}

TEST(MadeMaps, PadIntoFreeTexelsOnly) {
  // Two charts with a gap of 6 texels of 64: the left one fires, the right one is black.
  Avatar avatar = flat_avatar();
  add_rectangle(avatar, {0.125F, 0.25F}, {0.375F, 0.75F});
  add_rectangle(avatar, {0.46875F, 0.25F}, {0.75F, 0.75F});
  const Body body(avatar);
  MapSettings settings;
  settings.side = 64;
  settings.padding = 20;
  const MadeMap map = make(body, R"({"regions": [{"name": "a", "side": "right", "angle": [-180, 0]}]})", settings);
  const auto at = [&](int column, int row) { return map.raster.actuator[static_cast<std::size_t>(row * 64 + column)]; };
  for (int row = 17; row < 47; ++row) {
    for (int column = 8; column < 24; ++column) EXPECT_EQ(at(column, row), 1) << column << ", " << row;
    EXPECT_EQ(at(26, row), 1) << "padding, nearer to the left chart";
    for (int column = 30; column < 48; ++column) EXPECT_EQ(at(column, row), 0) << column << ", " << row;
  }
  EXPECT_EQ(at(16, 10), 1);
}

TEST(MadeMaps, OfMoreThan240ActuatorsHaveSixteenBits) {
  MapSettings settings;
  settings.empty = EmptyRegions::kLeaveOut;
  const MadeMap map = make(
      mannequin(), R"({"regions": [{"name": "skin", "part": "vest", "grid": {"rows": 15, "columns": 20}}]})", settings);
  const ActuatorMap read_back = read(map.files);
  ASSERT_GT(read_back.actuator_count, 240U);
  EXPECT_EQ(read_back.actuator_count + map.left_out.size(), 300U);
  EXPECT_EQ(read_back.actuator, map.raster.actuator);
}

TEST(MadeMaps, SayWhenTheTextureCannotTellRegionsApart) {
  // Left and right half on the same texels.
  Avatar avatar = flat_avatar();
  add_rectangle(avatar, {0.1F, 0.1F}, {0.4F, 0.9F});
  add_rectangle(avatar, {0.5F, 0.1F}, {0.8F, 0.9F}, {-0.4F, 0.0F});
  const Body body(avatar);
  const MadeMap map = make(body, R"({"regions": [{"name": "right", "side": "right"}, {"name": "left"}]})");
  ASSERT_THAT(map.warnings, SizeIs(1));
  EXPECT_THAT(map.warnings[0], ::testing::AllOf(HasSubstr("'right' and 'left'"), HasSubstr("texels")));
  Avatar bare = test::rigid_avatar({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}});
  bare.texture_coordinate.assign(3, glm::vec2(0));
  EXPECT_THAT(message_of([&] { make(Body(bare), R"({"regions": [{"name": "a"}]})"); }),
              HasSubstr("has no texture coordinates"));
}

MapCheck check(const Avatar& avatar, const ActuatorMap& map) {
  return check_map(Body(avatar), map, "flat");
}

auto kinds_are(const char* kind) {
  return Each(Field(&MapFinding::kind, kind));
}

/// A square of skin, 0.2 … 0.8.
Avatar square() {
  Avatar avatar = flat_avatar();
  add_rectangle(avatar, {0.2F, 0.2F}, {0.8F, 0.8F});
  return avatar;
}

TEST(MapChecks, PassASoundMap) {
  const MapCheck result = check(square(), painted(128, 2, [](auto x, auto) { return x < 64 ? 1 : 2; }));
  EXPECT_TRUE(result.good());
  EXPECT_THAT(result.findings, IsEmpty());
  EXPECT_NEAR(result.actuators[0].area_m2, 0.18, 0.001);
  EXPECT_TRUE(check_map(mannequin(), test::builtin_map(), "builtin").good());
}

TEST(MapChecks, FindActuatorsThatCanNeverFire) {
  const MapCheck outside = check(square(), painted(128, 2, [](auto x, auto) { return x < 120 ? 1 : 2; }));
  ASSERT_THAT(outside.findings, SizeIs(1));
  EXPECT_EQ(outside.findings[0].kind, "never_fires");
  EXPECT_EQ(outside.findings[0].actuator, 2);
  EXPECT_FALSE(outside.good());
  // The skin's edge at 0.8 lies in column 102 of 128, which is enough to fire it.
  EXPECT_TRUE(check(square(), painted(128, 2, [](auto x, auto) { return x < 102 ? 1 : 2; })).good());
  EXPECT_FALSE(check(square(), painted(128, 2, [](auto x, auto) { return x < 103 ? 1 : 2; })).good());
  const MapCheck missing = check(square(), painted(128, 2, [](auto, auto) { return 1; }));
  ASSERT_THAT(missing.findings, SizeIs(1));
  EXPECT_THAT(missing.findings[0].cause, HasSubstr("none of its grey"));
  EXPECT_THAT(check(square(), painted(128, 0, [](auto, auto) { return 0; })).findings[0].cause, HasSubstr("black"));
}

TEST(MapChecks, FindRegionsInPieces) {
  const MapCheck result = check(square(), painted(128, 2, [](auto x, auto) { return x < 50 || x >= 80 ? 1 : 2; }));
  ASSERT_THAT(result.findings, SizeIs(1));
  EXPECT_EQ(result.findings[0].kind, "split");
  EXPECT_EQ(result.actuators[0].pieces, 2U);
  EXPECT_EQ(result.actuators[1].pieces, 1U);
}

TEST(MapChecks, TakeSkinThatASeamCutsForOnePiece) {
  // Two charts, neighbours on the body, apart in the texture.
  Avatar avatar = flat_avatar();
  add_rectangle(avatar, {0.2F, 0.2F}, {0.4F, 0.8F});
  add_rectangle(avatar, {0.4F, 0.2F}, {0.6F, 0.8F}, {0.3F, 0.0F});
  const MapCheck result = check(avatar, painted(128, 1, [](auto, auto) { return 1; }));
  EXPECT_EQ(result.actuators[0].pieces, 1U);
  EXPECT_TRUE(result.good());
}

TEST(MapChecks, FindTexelsOfTwoPlacesAndTellMirroredOnes) {
  Avatar shifted = flat_avatar();
  add_rectangle(shifted, {0.1F, 0.1F}, {0.4F, 0.4F});
  add_rectangle(shifted, {0.5F, 0.5F}, {0.8F, 0.8F}, {-0.4F, -0.4F});
  const MapCheck shared = check(shifted, painted(128, 1, [](auto, auto) { return 1; }));
  EXPECT_THAT(shared.findings, Contains(Field(&MapFinding::kind, "shared_texels")));
  EXPECT_FALSE(shared.good());
  EXPECT_NEAR(shared.actuators[0].shared_m2, 0.18, 0.01);

  // The right half shows the left one's texels, the other way round.
  Avatar mirrored = flat_avatar();
  add_rectangle(mirrored, {0.5F, 0.1F}, {0.9F, 0.9F});
  add_rectangle(mirrored, {0.1F, 0.1F}, {0.5F, 0.9F});
  for (std::size_t i = 4; i < 8; ++i) mirrored.texture_coordinate[i].x = 1 - mirrored.texture_coordinate[i].x;
  ActuatorMap map = painted(128, 1, [](auto, auto) { return 1; });
  const MapCheck both = check(mirrored, map);
  ASSERT_THAT(both.findings, SizeIs(1));
  EXPECT_EQ(both.findings[0].kind, "mirrored_texels");
  EXPECT_FALSE(both.good());
  map.position_m[0] = glm::dvec3(0.5, 0.5, 0);
  EXPECT_TRUE(check(mirrored, map).good()) << "an actuator in the middle is meant for both sides";
}

TEST(MapChecks, FindSoftEdgesAndPositionsElsewhere) {
  const MapCheck soft = check(square(), painted(128, 3, [](auto x, auto) { return x < 63 ? 1 : x == 63 ? 2 : 3; }));
  EXPECT_THAT(soft.findings, kinds_are("soft_edges"));
  EXPECT_THAT(soft.findings, SizeIs(1));
  ActuatorMap map = painted(128, 1, [](auto, auto) { return 1; });
  map.position_m[0] = glm::dvec3(0.5, 1.4, 0);
  EXPECT_THAT(check(square(), map).findings, ::testing::AllOf(SizeIs(1), kinds_are("position")));
}

TEST(MapChecks, FindTextureCoordinatesThatTile) {
  Avatar avatar = square();
  add_rectangle(avatar, {2, 2}, {5, 5});
  EXPECT_THAT(check(avatar, painted(128, 1, [](auto, auto) { return 1; })).findings,
              Contains(Field(&MapFinding::kind, "texture_coordinates")));
}

}  // namespace
}  // namespace vestige
