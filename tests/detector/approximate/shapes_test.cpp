#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <vector>

#include "detector/approximate/capsule.hpp"
#include "detector/approximate/oriented_box.hpp"
#include "detector/approximate/union_surface.hpp"

namespace vestige {
namespace {

/// The twelve triangles of a box with these half sides, turned and then moved.
std::vector<Corners> box_skin(const glm::dvec3& half, const glm::dmat3& turn, const glm::dvec3& middle) {
  std::vector<Corners> skin;
  const auto at = [&](int axis, double out, double across, double up) {
    glm::dvec3 place(0);
    place[axis] = out * half[axis];
    place[(axis + 1) % 3] = across * half[(axis + 1) % 3];
    place[(axis + 2) % 3] = up * half[(axis + 2) % 3];
    return middle + turn * place;
  };
  for (int axis = 0; axis < 3; ++axis)
    for (const double out : {-1.0, 1.0}) {
      skin.push_back({at(axis, out, -1, -1), at(axis, out, 1, -1), at(axis, out, 1, 1)});
      skin.push_back({at(axis, out, -1, -1), at(axis, out, 1, 1), at(axis, out, -1, 1)});
    }
  return skin;
}

/// A tube of radius 1 around the x axis from -length/2 to +length/2, without ends, of `sides` flat sides.
std::vector<Corners> tube_skin(double length, int sides) {
  std::vector<Corners> skin;
  for (int i = 0; i < sides; ++i) {
    const auto at = [&](double x, int k) {
      const double angle = 2 * M_PI * k / sides;
      return glm::dvec3(x * length / 2, std::cos(angle), std::sin(angle));
    };
    skin.push_back({at(-1, i), at(1, i), at(1, i + 1)});
    skin.push_back({at(-1, i), at(1, i + 1), at(-1, i + 1)});
  }
  return skin;
}

/// A quarter of a right angle about an axis that is no main one.
const glm::dmat3 kTurn = {{0.36, 0.48, -0.8}, {-0.8, 0.6, 0}, {0.48, 0.64, 0.6}};

void expect_near(const glm::dvec3& found, const glm::dvec3& expected, double error) {
  EXPECT_LT(glm::distance(found, expected), error) << found.x << ' ' << found.y << ' ' << found.z;
}

TEST(OrientedBox, IsTheBoxThatItIsFittedTo) {
  const OrientedBox straight = OrientedBox::fit(box_skin({1, 2, 3}, glm::dmat3(1), {10, 20, 30}));
  expect_near(straight.middle, {10, 20, 30}, 1e-12);
  expect_near(straight.half, {1, 2, 3}, 1e-12);

  const OrientedBox turned = OrientedBox::fit(box_skin({1, 2, 3}, kTurn, {10, 20, 30}));
  expect_near(turned.middle, {10, 20, 30}, 1e-9);
  EXPECT_NEAR(turned.half.x * turned.half.y * turned.half.z, 6, 1e-9);  // no larger than the skin
}

TEST(OrientedBox, IsEnteredAndLeftWhereItsSidesAre) {
  const OrientedBox box = {{10, 0, 0}, glm::dmat3(1), {1, 2, 3}};
  const Chord through = box.chord({5, 1, 1}, {15, 1, 1});
  EXPECT_DOUBLE_EQ(through.enter, 0.4);
  EXPECT_DOUBLE_EQ(through.leave, 0.6);
  EXPECT_TRUE(box.chord({5, 2.5, 0}, {15, 2.5, 0}).misses());
  EXPECT_TRUE(box.chord({5, 2.5, 0}, {5, 2.5, 0}).misses());
  EXPECT_EQ(box.chord({10, 1, 1}, {10, 1, 1}).enter, -std::numeric_limits<double>::infinity());
  EXPECT_EQ(box.normal({9, 1, 1}), glm::dvec3(-1, 0, 0));
  EXPECT_EQ(box.normal({10, 0, 3}), glm::dvec3(0, 0, 1));
}

TEST(Capsule, LiesAlongATubeWithItsRadius) {
  const Capsule capsule = Capsule::fit(tube_skin(10, 64));
  EXPECT_NEAR(std::abs(capsule.axes[0].x), 1, 1e-9);
  expect_near(capsule.middle, {0, 0, 0}, 1e-9);
  EXPECT_NEAR(capsule.radius, 1, 2e-3);  // flat sides lie a little inside the circle
  EXPECT_NEAR(capsule.half_length + capsule.radius, 5, 1e-9);
}

TEST(Capsule, IsEnteredAndLeftAtItsSidesAndItsRoundEnds) {
  const Capsule capsule = {{0, 0, 0}, glm::dmat3(1), 4, 1};
  const Chord across = capsule.chord({2, -5, 0}, {2, 5, 0});
  EXPECT_DOUBLE_EQ(across.enter, 0.4);
  EXPECT_DOUBLE_EQ(across.leave, 0.6);
  const Chord along = capsule.chord({-10, 0, 0}, {10, 0, 0});
  EXPECT_DOUBLE_EQ(along.enter, 0.25);
  EXPECT_DOUBLE_EQ(along.leave, 0.75);
  EXPECT_TRUE(capsule.chord({-10, 0.9, 0.9}, {10, 0.9, 0.9}).misses());
  // Over the corner of the surrounding cylinder.
  EXPECT_TRUE(capsule.chord({4.9, 0.9, -5}, {4.9, 0.9, 5}).misses());
  EXPECT_EQ(capsule.normal({5, 0, 0}), glm::dvec3(1, 0, 0));
  EXPECT_EQ(capsule.normal({2, 0, -1}), glm::dvec3(0, 0, -1));
}

template <typename Shape>
void expect_cells_lie_on_the_surface(const Shape& shape) {
  for (std::size_t cell = 0; cell < Shape::kCells; ++cell) {
    const glm::dvec3 place = shape.middle_of_cell(cell);
    EXPECT_EQ(shape.cell(place), cell);
    const glm::dvec3 out = shape.normal(place);
    EXPECT_FALSE(shape.chord(place - 1e-6 * out, place + 1e-6 * out).misses()) << cell;
    EXPECT_NEAR(shape.chord(place - 1e-6 * out, place + 1e-6 * out).leave, 0.5, 0.01) << cell;
  }
}

TEST(Shapes, AreCutIntoCellsThatLieOnTheirSurface) {
  expect_cells_lie_on_the_surface(OrientedBox{{1, 2, 3}, kTurn, {0.1, 0.2, 0.3}});
  expect_cells_lie_on_the_surface(Capsule{{1, 2, 3}, kTurn, 0.2, 0.1});
  expect_cells_lie_on_the_surface(Capsule{{1, 2, 3}, kTurn, 0, 0.1});
}

TEST(Shapes, OfSkinWithoutThicknessAreFinite) {
  const std::vector<Corners> flat = {{{0, 0, 0}, {2, 0, 0}, {0, 0, 1}}};
  const OrientedBox box = OrientedBox::fit(flat);
  EXPECT_DOUBLE_EQ(box.half.y, 0);
  const Chord chord = box.chord({0.5, -1, 0.5}, {0.5, 1, 0.5});
  EXPECT_DOUBLE_EQ(chord.enter, 0.5);
  EXPECT_DOUBLE_EQ(chord.leave, 0.5);
  const std::vector<Corners> point = {{{1, 1, 1}, {1, 1, 1}, {1, 1, 1}}};
  EXPECT_EQ(OrientedBox::fit(point).half, glm::dvec3(0));
  EXPECT_EQ(Capsule::fit(point).radius, 0);
  EXPECT_TRUE(std::isfinite(Capsule::fit(flat).chord({0, 0, 0}, {1, 1, 1}).enter));
}

TEST(UnionSurface, IsNotCrossedWhereShapesOverlap) {
  const auto crossing = [](std::vector<Chord> chords) { return first_crossing(chords); };
  EXPECT_FALSE(crossing({}));
  EXPECT_FALSE(crossing({Chord::none()}));
  EXPECT_FALSE(crossing({{1.5, 2}}));
  EXPECT_FALSE(crossing({{-2, 0}}));  // it was left before, or at the start
  const auto entered = crossing({{0.7, 0.9}, {0.3, 2}});
  EXPECT_EQ(entered->t, 0.3);
  EXPECT_EQ(entered->chord, 1U);
  EXPECT_EQ(entered->side, 1);
  // From the first through the second into the third, which is left.
  const auto left = crossing({{-1, 0.4}, {0.3, 0.6}, {0.5, 0.8}, {0.9, 1}});
  EXPECT_EQ(left->t, 0.8);
  EXPECT_EQ(left->chord, 2U);
  EXPECT_EQ(left->side, -1);
  EXPECT_FALSE(crossing({{-1, 0.4}, {0.3, 2}}));  // still inside at the end
}

}  // namespace
}  // namespace vestige
