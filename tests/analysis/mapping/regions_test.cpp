// Maps made from regions, on the built-in avatar and on small ones made for it.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "analysis/mapping/map_maker.hpp"
#include "tests/analysis/mapping/map_fixture.hpp"
#include "tests/support/message_of.hpp"
#include "traces/base/error.hpp"

namespace vestige {
namespace {

using test::add_rectangle;
using test::flat_avatar;
using test::mannequin;
using test::message_of;
using test::read;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::SizeIs;

MadeMap make(const Body& body, const std::string& regions, MapSettings settings = {}) {
  const RegionPlan plan(body, parse_region_file(regions, "mine.json"), "mine.json");
  return make_map(body, plan, settings, "mine.json", "man.glb");
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
  EXPECT_THAT(cause(R"({"name": "a", "height": [0, 2]})"), HasSubstr("is not within 0 and 1"));
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
              ::testing::AllOf(HasSubstr("region 'a'"), HasSubstr("two of its actuators have the name 'x'")));
  EXPECT_THAT(cause(R"({"name": "a", "part": "vest", "height_m": [3, 4]})"),
              ::testing::AllOf(HasSubstr("actuator 'a'"), HasSubstr("no skin belongs to it")));
  EXPECT_THAT(cause(R"({"name": "a"}, {"name": "b"})"), HasSubstr("actuator 'b'"));
  EXPECT_THAT(message_of([] { parse_region_file("{\"regions\": [", "mine.json"); }),
              HasSubstr("mine.json, byte 14: is not JSON"));
  EXPECT_THAT(message_of([] { parse_region_file(R"({"regions": [], "regions": []})", "mine.json"); }),
              HasSubstr("an object has 'regions' twice"));
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
    EXPECT_EQ(at(63, row), 1) << "also where the texture repeats";
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

}  // namespace
}  // namespace vestige
