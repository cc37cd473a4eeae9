#include "detector/actuators/actuator_layout.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>

#include "tests/support/builtin_avatar.hpp"
#include "tests/support/builtin_map.hpp"
#include "tests/support/flat_body.hpp"

namespace vestige {
namespace {

using ::testing::Each;
using ::testing::ElementsAre;
using ::testing::UnorderedElementsAre;

TEST(ActuatorLayout, KnowsPlacesAreasAndDistancesOnAFlatBody) {
  // Four actuators in a square; the map is black within the right tenth.
  ActuatorMap map = test::nearest_map({{0.25, 0.25}, {0.75, 0.25}, {0.25, 0.75}, {0.75, 0.75}}, 200);
  for (std::uint32_t row = 0; row < 200; ++row)
    for (std::uint32_t column = 180; column < 200; ++column) map.actuator[row * 200 + column] = 0;
  map.position_m[3]->z = 0.3;  // above the skin
  const ActuatorLayout layout(test::flat_body(10), map);
  EXPECT_NEAR(layout.skin_area_m2(), 1, 1e-6);
  EXPECT_NEAR(layout.mapped_area_m2(), 0.9, 1e-3);
  EXPECT_NEAR(layout.area_m2(0), 0.25, 1e-3);
  EXPECT_NEAR(layout.area_m2(1), 0.2, 1e-3);
  EXPECT_NEAR(glm::distance(layout.position_m(3), glm::dvec3(0.75, 0.75, 0)), 0, 1e-7);
  EXPECT_NEAR(layout.between_m(0, 3), std::sqrt(0.5), 1e-6);
  EXPECT_EQ(layout.between_m(2, 2), 0);
  EXPECT_NEAR(layout.spacing_m(), 0.5, 1e-6);
  EXPECT_THAT(layout.beside(0), ::testing::IsSupersetOf({1, 2}));
  EXPECT_EQ(layout.ambiguous_share(), 0);

  LocatedContact located;
  layout.locate(test::contact_at(0.3, 0.35, 10), located);
  EXPECT_EQ(located.actuator, 1);
  EXPECT_NEAR(static_cast<double>(located.distance_m()[0]), std::hypot(0.05, 0.1), 1e-6);
  EXPECT_NEAR(static_cast<double>(located.distance_m()[3]), std::hypot(0.45, 0.4), 1e-6);
  EXPECT_NEAR(glm::length(layout.towards_m(located, 3)), std::hypot(0.45, 0.4), 1e-6);
  // Ways to actuators add up as on paper: the middle of 0 and 3, seen from the contact.
  const glm::dvec2 middle = 0.5 * (layout.towards_m(located, 0) + layout.towards_m(located, 3));
  EXPECT_NEAR(glm::length(middle), std::hypot(0.2, 0.15), 1e-6);
  layout.locate(test::contact_at(0.95, 0.5, 10), located);
  EXPECT_EQ(located.actuator, 0);
}

TEST(ActuatorLayout, FindsTheMiddleOfARegionWithinTheRegion) {
  // A frame around the square: its middle lies in the hole.
  ActuatorMap map = test::nearest_map({{0.5, 0.5}}, 100);
  map.position_m[0].reset();
  for (std::uint32_t row = 20; row < 80; ++row)
    for (std::uint32_t column = 10; column < 80; ++column) map.actuator[row * 100 + column] = 0;
  const ActuatorLayout layout(test::flat_body(10), map);
  LocatedContact located;
  const glm::dvec3& at = layout.position_m(0);
  EXPECT_EQ(map.at({at.x, at.y}), 1) << at.x << ' ' << at.y;
  EXPECT_NEAR(at.x, 0.805, 1e-6);  // the side that is nearest to the middle, which lies a little to the right
  EXPECT_EQ(layout.spacing_m(), std::numeric_limits<double>::infinity());
}

TEST(ActuatorLayout, TakesActuatorsThatCannotFireAndMapsWithoutAny) {
  ActuatorMap map = test::nearest_map({{0.25, 0.5}, {0.75, 0.5}}, 50);
  map.actuator_count = 3;
  map.names.emplace_back("nowhere");
  map.position_m.emplace_back();
  const ActuatorLayout layout(test::flat_body(4), map);
  EXPECT_FALSE(layout.place(2));
  EXPECT_EQ(layout.area_m2(2), 0);
  EXPECT_EQ(layout.between_m(0, 2), std::numeric_limits<double>::infinity());
  EXPECT_NEAR(layout.spacing_m(), 0.5, 1e-6);
  EXPECT_THAT(layout.beside(0), ElementsAre(1));

  const ActuatorLayout none(test::flat_body(4), ActuatorMap());
  EXPECT_EQ(none.actuator_count(), 0U);
  EXPECT_EQ(none.mapped_area_m2(), 0);
}

TEST(ActuatorLayout, PlacesRegionsThatAreTouchedWithoutHoldingATexelsCentre) {
  Avatar body = test::flat_body(1);
  for (glm::vec2& at : body.texture_coordinate) at = 0.45F + 0.1F * at;  // around where four texels meet
  ActuatorMap map = test::nearest_map({{0.25, 0.25}, {0.75, 0.25}, {0.25, 0.75}, {0.75, 0.75}}, 2);
  map.position_m.clear();
  const ActuatorLayout layout(body, map);
  for (std::size_t i = 0; i < 4; ++i) EXPECT_TRUE(layout.place(i)) << i;
}

TEST(ActuatorLayout, GoesNotThroughATextureAgainAndAgain) {
  Avatar body = test::flat_body(1);
  for (glm::vec2& at : body.texture_coordinate) at *= 1e6F;
  const ActuatorLayout layout(body, test::nearest_map({{0.25, 0.5}, {0.75, 0.5}}, 64));
  EXPECT_NEAR(layout.mapped_area_m2(), 1, 1e-6);
}

TEST(ActuatorLayout, SeesNeighboursThreeByThreeWithinASingleTriangleToo) {
  const ActuatorLayout layout(test::flat_body(1), test::nearest_map({{0.2, 0.2}, {0.8, 0.25}, {0.45, 0.8}}, 64));
  EXPECT_THAT(layout.neighbours(), ElementsAre(ElementsAre(0, 1, 2)));
  EXPECT_THAT(layout.neighbours_of(1), ElementsAre(0));
  EXPECT_THAT(layout.beside(2), ElementsAre(0, 1));
}

TEST(ActuatorLayout, SaysHowMuchOfTheMapIsSharedBySkinFarApart) {
  // A second square a metre behind, a quarter of which has texels of the first.
  Avatar avatar = test::flat_body(8);
  const std::size_t count = avatar.position_bind.size();
  const std::size_t triangles = avatar.triangles.size();
  for (std::size_t i = 0; i < count; ++i) {
    avatar.position_bind.push_back(avatar.position_bind[i] + glm::vec3(0, 0, -1));
    avatar.texture_coordinate.push_back(avatar.texture_coordinate[i] * 0.25F);
    avatar.influences.push_back(avatar.influences[i]);
  }
  for (std::size_t i = 0; i < triangles; ++i)
    avatar.triangles.push_back(avatar.triangles[i] + static_cast<unsigned>(count));
  for (std::size_t i = 0; i < count; ++i) avatar.texture_coordinate[i] = 0.5F * avatar.texture_coordinate[i];
  const ActuatorLayout layout(avatar, test::nearest_map({{0.5, 0.5}}, 256));
  // All of the second square, and the quarter of the first whose texels it has.
  EXPECT_NEAR(layout.ambiguous_share(), 1.25 / 2, 1e-3);
}

TEST(ActuatorLayout, MeasuresAroundTheBuiltInBodyAndNotThroughIt) {
  const ActuatorLayout layout(test::builtin_avatar(), test::builtin_map());
  EXPECT_GT(layout.skin_area_m2(), 1.4);
  EXPECT_LT(layout.skin_area_m2(), 2.2);
  EXPECT_EQ(layout.ambiguous_share(), 0);
  for (std::size_t a = 0; a < 6; ++a) {
    EXPECT_GT(layout.area_m2(a), 0.02);
    for (std::size_t b = 0; b < 6; ++b)
      EXPECT_GE(layout.between_m(a, b) * (1 + 1e-6), glm::distance(layout.position_m(a), layout.position_m(b)));
  }
  // What is interpolated between vertices is what a march from the point itself finds.
  LocatedContact located;
  for (const std::uint32_t triangle : {100U, 1500U, 3000U}) {
    const SkinPoint point = {triangle, {0.3, 0.3, 0.4}};
    layout.locate(point, located);
    for (std::size_t i = 0; i < 6; ++i) {
      const double marched_m = layout.distance_m(point, *layout.place(i));
      EXPECT_NEAR(static_cast<double>(located.distance_m()[i]), marched_m, 0.002 + 0.01 * marched_m);
    }
  }
}

}  // namespace
}  // namespace vestige
