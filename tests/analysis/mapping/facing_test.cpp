// Left is left and front is front, whichever way an avatar faces.

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cctype>
#include <glm/geometric.hpp>

#include "analysis/mapping/layouts.hpp"
#include "analysis/mapping/map_check.hpp"
#include "detector/detectors/make_detectors.hpp"
#include "tests/support/long.hpp"
#include "tests/support/made/made_avatars.hpp"
#include "tests/support/scene_run.hpp"
#include "tests/support/test_data.hpp"
#include "traces/gltf/avatar_gltf.hpp"

namespace vestige {
namespace {

using ::testing::Contains;
using ::testing::Each;
using ::testing::Field;
using ::testing::HasSubstr;
using ::testing::Not;

/// The names of the actuators that fire when a collider goes 2 % of the body's height through the middle of each of
/// the triangles; empty where none fires.
std::vector<std::string> touch(const Avatar& avatar, const ActuatorMap& map,
                               const std::vector<std::uint32_t>& triangles) {
  const BodySurface surface(avatar);
  std::vector<TraceFrame> frames(2);
  frames[1].index = 1;
  frames[1].time_ns = 10'000'000;
  for (TraceFrame& frame : frames) frame.poses.front() = rest_pose(avatar);
  for (std::uint32_t i = 0; i < triangles.size(); ++i) {
    const auto corner = surface.corners_m(triangles[i]);
    const glm::dvec3 middle = (corner[0] + corner[1] + corner[2]) / 3.0;
    const glm::dvec3 through =
        0.01 * surface.height_m() * glm::normalize(glm::cross(corner[1] - corner[0], corner[2] - corner[0]));
    frames[0].colliders.push_back({i, middle + through});
    frames[1].colliders.push_back({i, middle - through});
  }
  const auto count = static_cast<std::uint32_t>(triangles.size());
  const auto detector = make_cpu_detector(avatar, map, {});
  const test::SceneRun run = test::run_scene(frames, avatar, count, *detector);
  std::vector<std::string> names(count);
  for (std::uint32_t i = 0; i < count; ++i)
    if (const Contact& contact = run.rows[1][i]; contact.hit() && contact.actuator != 0)
      names[i] = map.names[contact.actuator - 1U];
  return names;
}

/// The triangle that follows a node most; among several the largest.
std::optional<std::uint32_t> triangle_of(const Avatar& avatar, std::size_t node) {
  const BodySurface surface(avatar);
  std::optional<std::uint32_t> best;
  double most = 0;
  for (std::uint32_t i = 0; i < avatar.triangles.size(); ++i) {
    double weight = 1;
    for (int corner = 0; corner < 3; ++corner) {
      double here = 0;
      const Influences& influences = avatar.influences[avatar.triangles[i][corner]];
      for (std::size_t k = 0; k < kMaxInfluences; ++k)
        if (influences.weight[k] > 0 && avatar.palette[influences.palette[k]].node == static_cast<int>(node))
          here += double{influences.weight[k]};
      weight = std::min(weight, here);
    }
    const double value = weight > 0.5 ? surface.area_m2(i) : 0;
    if (value > most) {
      most = value;
      best = i;
    }
  }
  return best;
}

/// The layout `body`; by triangle, which takes a tenth of the time, unless the test is long.
ActuatorMapFiles body_map(const Avatar& avatar) {
  if (test::is_long()) return make_layout(avatar, "body");
  const Body body(avatar);
  const RegionPlan plan(body, parse_region_file(layout_regions_json("body"), "body"), "body");
  MapSettings settings;
  settings.empty = EmptyRegions::kLeaveOut;
  settings.per_triangle = true;
  return make_map(body, plan, settings, "body", "avatar").files;
}

void expect_its_sides(const std::vector<std::byte>& glb, const std::string& what) {
  SCOPED_TRACE(what);
  const Avatar avatar = parse_avatar_glb(glb, what);
  const ActuatorMap map = parse_actuator_map(body_map(avatar), avatar, "body");
  std::vector<std::uint32_t> triangles;
  std::vector<std::string> sides;
  for (const char* side : {"Left", "Right"})
    for (const char* bone : {"UpperArm", "LowerArm", "Hand", "UpperLeg", "LowerLeg", "Foot"}) {
      const auto node = avatar.humanoid.node_of.find(std::string(side) + bone);
      if (node == avatar.humanoid.node_of.end()) continue;
      const auto triangle = triangle_of(avatar, node->second);
      if (!triangle) continue;
      triangles.push_back(*triangle);
      sides.emplace_back(side == std::string("Left") ? "left" : "right");
    }
  ASSERT_GE(triangles.size(), 4U);
  const std::vector<std::string> fired = touch(avatar, map, triangles);
  std::size_t felt = 0;
  for (std::size_t i = 0; i < fired.size(); ++i) {
    if (fired[i].empty()) continue;
    ++felt;
    EXPECT_THAT(fired[i], HasSubstr(sides[i]));
  }
  EXPECT_GE(2 * felt, fired.size());
  EXPECT_THAT(check_map(Body(avatar), map, what).findings, Not(Contains(Field(&MapFinding::kind, "wrong_side"))));
}

TEST(FacingOfMaps, FifteenMadeAvatarsInFourFacingsFeelTheirOwnSides) {
  auto avatars = test::made_avatars();
  avatars["built-in"] = builtin_avatar_glb();
  EXPECT_EQ(avatars.size(), 15U);
  for (const auto& [name, glb] : avatars)
    for (int quarters = 0; quarters < 4; ++quarters)
      expect_its_sides(test::turned_glb(glb, quarters), fmt::format("{}, {} quarters", name, quarters));
}

TEST(FacingOfMaps, FiveRealAvatarsInFourFacingsFeelTheirOwnSides) {
  VESTIGE_REQUIRE_DATA(test::data("avatars/avatars"));
  for (const char* file : {"CesiumMan.glb", "KayKit_Knight.glb", "MakeHumanBase_cc0_8inf.glb",
                           "RiggedFigure_3dsmax/RiggedFigure.gltf", "greenman.glb"})
    for (int quarters = 0; quarters < 4; ++quarters)
      expect_its_sides(test::turned_glb(read_avatar_glb(test::data("avatars/avatars") / file), quarters),
                       fmt::format("{}, {} quarters", file, quarters));
}

/// No layout knows the left or the top of a body that lies. What needs neither is drawn.
TEST(FacingOfMaps, ABodyThatDoesNotStandHasNoLayout) {
  for (const double degrees : {-90.0, 180.0}) {
    const Avatar laid = parse_avatar_glb(test::laid_glb(builtin_avatar_glb(), degrees, {1, 0, 0}), "laid.glb");
    const Body body(laid);
    const auto drawn = [&](const std::string& region) -> std::string {
      try {
        const RegionPlan plan(body, parse_region_file("{\"regions\": [{\"name\": \"r\", " + region + "}]}", "r.json"),
                              "r.json");
        return std::to_string(plan.actuator_count());
      } catch (const Error& error) {
        return error.what();
      }
    };
    const std::string refusal =
        fmt::format("r.json, region 'r': the avatar does not stand: at rest, its head lies {:.0f} degrees away from +Y",
                    std::abs(degrees));
    for (const char* region :
         {R"("part": "vest")", R"("part": ["head", "hand left"])", R"("part": "foot right")",
          R"("joints": ["head"], "side": "front")", R"("part": "torso", "height": [0, 0.5])", R"("height_m": [0, 0.5])",
          R"("part": "torso", "angle": [0, 90])", R"("grid": {"rows": 2, "columns": 2})",
          R"("part": "torso", "actuators": [{"name": "a", "height": 0.5, "angle": 0}])"})
      EXPECT_THAT(drawn(region), HasSubstr(refusal)) << region;
    for (const char* region : {R"("part": "head")", R"("joints": ["hand_left"])", R"("below": ["upper_arm_right"])",
                               R"("part": "torso", "actuators": [{"name": "a", "position_m": [0, 0, 0]}])"})
      EXPECT_EQ(drawn(region), "1") << region;
    for (const std::string& layout : layout_names()) EXPECT_THROW(make_layout(laid, layout), Error) << layout;
  }
}

/// The skin of a turned avatar is where it was, so that a map in its texture is the same, but for borders that rounding
/// moves.
TEST(FacingOfMaps, ATurnedAvatarHasTheSameMap) {
  for (const std::string layout : {"torso16", "body"}) {
    const Avatar avatar = parse_avatar_glb(builtin_avatar_glb(), "builtin");
    const ActuatorMap map = parse_actuator_map(make_layout(avatar, layout), avatar, layout);
    for (int quarters = 1; quarters < 4; ++quarters) {
      const Avatar turned = parse_avatar_glb(test::turned_glb(builtin_avatar_glb(), quarters), "turned");
      const ActuatorMap other = parse_actuator_map(make_layout(turned, layout), turned, layout);
      EXPECT_EQ(other.names, map.names);
      EXPECT_EQ(other.facing, static_cast<Facing>(quarters));
      std::size_t different = 0;
      for (std::size_t i = 0; i < map.actuator.size(); ++i) different += map.actuator[i] != other.actuator[i] ? 1U : 0U;
      EXPECT_LT(different, map.actuator.size() / 1000) << layout << ", " << quarters << " quarters";
    }
  }
}

TEST(FacingOfMaps, ALayoutForTheWrongFacingIsFoundByCheck) {
  Avatar avatar = parse_avatar_glb(test::turned_glb(builtin_avatar_glb(), 2), "turned");
  set_facing(avatar.facing, Facing::kPlusZ, AvatarFacing::By::kAsked);
  const ActuatorMap map = parse_actuator_map(make_layout(avatar, "paper6"), avatar, "paper6");
  const MapCheck check = check_map(Body(avatar), map, "turned");
  EXPECT_FALSE(check.good());
  ASSERT_EQ(check.findings.size(), 6U);
  EXPECT_THAT(check.findings, Each(Field(&MapFinding::kind, "wrong_side")));
  EXPECT_THAT(check.findings.front().cause, HasSubstr("'upper torso, right' lies 0.10 m to the left"));
}

TEST(FacingOfMaps, OfASidecarMustBeAnAxis) {
  const Avatar avatar = parse_avatar_glb(builtin_avatar_glb(), "builtin");
  ActuatorMapFiles files = make_layout(avatar, "paper6");
  const std::size_t at = files.json.find("\"+z\"");
  ASSERT_NE(at, std::string::npos);
  files.json.replace(at, 4, "\"up\"");
  try {
    parse_actuator_map(files, avatar, "vest.png");
    FAIL() << "was read";
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), HasSubstr("vest.png, sidecar"));
    EXPECT_THAT(error.what(), HasSubstr("'facing' is \"up\", which is no axis"));
    EXPECT_THAT(error.what(), HasSubstr("+z, +x, -z, -x"));
  }
}

}  // namespace
}  // namespace vestige
