// What is wrong with maps, on the built-in avatar and on small ones made for it.

#include "analysis/mapping/map_check.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>

#include "tests/analysis/mapping/map_fixture.hpp"
#include "tests/support/builtin_map.hpp"

namespace vestige {
namespace {

using test::add_rectangle;
using test::flat_avatar;
using test::mannequin;
using test::read;
using ::testing::Contains;
using ::testing::Each;
using ::testing::Field;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

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
  EXPECT_THAT(missing.findings[0].cause, HasSubstr("no texel of its grey"));
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

TEST(MapChecks, LookAtTrianglesWhereTheMapIsOfThem) {
  Avatar avatar = flat_avatar();
  add_rectangle(avatar, {0, 0}, {0.5F, 1});
  add_rectangle(avatar, {2, 0}, {2.5F, 1}, {-2, 0});  // the same texels
  ActuatorMap map = painted(2, 2, [](auto column, auto row) { return row == 0 ? 1 : column == 0 ? 2 : 0; });
  map.triangle_count = 4;
  EXPECT_THAT(check(avatar, map).findings, IsEmpty());
  EXPECT_NEAR(check(avatar, map).actuators[1].area_m2, 0.25, 1e-6);
  map.actuator = {1, 2, 1, 2};
  EXPECT_THAT(check(avatar, map).findings, Each(Field(&MapFinding::kind, "split")));
  EXPECT_EQ(check(avatar, map).findings.size(), 2U);
  map.actuator = {1, 1, 0, 0};
  EXPECT_THAT(check(avatar, map).findings, Contains(Field(&MapFinding::kind, "never_fires")));
}

}  // namespace
}  // namespace vestige
