#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <random>
#include <sstream>
#include <vector>

#include "detector/decision.hpp"
#include "detector/truth/truth.hpp"
#include "tests/support/test_data.hpp"

namespace vestige {
namespace {

std::optional<FirstContact> segment_triangle(const glm::dvec3& p, const glm::dvec3& q, const glm::dvec3& a,
                                             const glm::dvec3& b, const glm::dvec3& c) {
  return decide_static({p, q}, {a, b, c}).contact;
}

const glm::dvec3 kA(0, 0, 0);
const glm::dvec3 kB(1, 0, 0);
const glm::dvec3 kC(0, 1, 0);

TEST(DecideStatic, FindsWhenAndFromWhichSideASegmentCrosses) {
  const auto entering = segment_triangle({0.25, 0.25, 1}, {0.25, 0.25, -3}, kA, kB, kC);
  ASSERT_TRUE(entering);
  EXPECT_EQ(entering->t, 0.25);
  EXPECT_EQ(entering->side, 1);
  const auto leaving = segment_triangle({0.25, 0.25, -1}, {0.25, 0.25, 1}, kA, kB, kC);
  ASSERT_TRUE(leaving);
  EXPECT_EQ(leaving->t, 0.5);
  EXPECT_EQ(leaving->side, -1);
}

TEST(DecideStatic, CountsTouchingAtEndsEdgesAndCornersAsContact) {
  EXPECT_EQ(segment_triangle({0.25, 0.25, 1}, {0.25, 0.25, 0}, kA, kB, kC)->t, 1);
  EXPECT_EQ(segment_triangle({0.25, 0.25, 0}, {0.25, 0.25, 5}, kA, kB, kC)->t, 0);
  EXPECT_TRUE(segment_triangle({0.5, 0.5, 1}, {0.5, 0.5, -1}, kA, kB, kC));
  EXPECT_TRUE(segment_triangle({0, 0, 1}, {0, 0, -1}, kA, kB, kC));
  EXPECT_FALSE(segment_triangle({0.25, 0.25, 1}, {0.25, 0.25, 1e-300}, kA, kB, kC));
  EXPECT_FALSE(segment_triangle({-1e-12, 0.5, 1}, {-1e-12, 0.5, -1}, kA, kB, kC));
}

TEST(DecideStatic, FindsTheFirstInstantOfOverlapInThePlane) {
  EXPECT_EQ(segment_triangle({-1, 0.25, 0}, {1, 0.25, 0}, kA, kB, kC)->t, 0.5);
  EXPECT_EQ(segment_triangle({0.25, 0.25, 0}, {5, 5, 0}, kA, kB, kC)->t, 0);
  EXPECT_EQ(segment_triangle({-1, 0, 0}, {3, 0, 0}, kA, kB, kC)->t, 0.25);  // along an edge
  EXPECT_EQ(segment_triangle({-1, 0.25, 0}, {1, 0.25, 0}, kA, kB, kC)->side, 0);
  EXPECT_FALSE(segment_triangle({-1, 2, 0}, {1, 2, 0}, kA, kB, kC));
  EXPECT_FALSE(segment_triangle({-2, 0, 0}, {-1, 0, 0}, kA, kB, kC));
}

TEST(DecideStatic, FindsOverlapInPlanesThatLieObliquely) {
  // Corners and ends on the plane x + 2 y + 4 z = 1, exactly.
  const auto on_plane = [](double y, double z) { return glm::dvec3(1 - 2 * y - 4 * z, y, z); };
  std::mt19937 random(3);
  const auto coordinate = [&] { return std::ldexp(static_cast<double>(random() % 4096), -11) - 1; };
  int hits = 0;
  for (int i = 0; i < 2000; ++i) {
    std::array<glm::dvec3, 5> x = {};
    for (glm::dvec3& point : x) point = on_plane(coordinate(), coordinate());
    const auto found = segment_triangle(x[0], x[1], x[2], x[3], x[4]);
    ASSERT_EQ(found, exact::static_contact({x[0], x[1]}, {x[2], x[3], x[4]})) << i;
    if (!found) continue;
    ++hits;
    EXPECT_EQ(found->side, 0) << i;
  }
  EXPECT_GT(hits, 300);
}

TEST(DecideStatic, TreatsARestingColliderAsAPoint) {
  EXPECT_EQ(segment_triangle({0.25, 0.25, 0}, {0.25, 0.25, 0}, kA, kB, kC)->t, 0);
  EXPECT_TRUE(segment_triangle({0.5, 0, 0}, {0.5, 0, 0}, kA, kB, kC));
  EXPECT_FALSE(segment_triangle({0.25, 0.25, 1e-9}, {0.25, 0.25, 1e-9}, kA, kB, kC));
  EXPECT_FALSE(segment_triangle({0.75, 0.75, 0}, {0.75, 0.75, 0}, kA, kB, kC));
}

TEST(DecideStatic, TreatsATriangleWithoutAreaAsTheHullOfItsCorners) {
  const glm::dvec3 far(2, 0, 0);
  EXPECT_EQ(segment_triangle({1.5, 1, 0}, {1.5, -1, 0}, kA, kB, far)->t, 0.5);
  EXPECT_FALSE(segment_triangle({2.5, 1, 0}, {2.5, -1, 0}, kA, kB, far));
  EXPECT_FALSE(segment_triangle({1.5, 1, 1e-9}, {1.5, -1, 1e-9}, kA, kB, far));
  EXPECT_EQ(segment_triangle({0, 1, 0}, {0, -1, 0}, kA, kA, kA)->t, 0.5);
  EXPECT_FALSE(segment_triangle({1, 1, 0}, {1, -1, 0}, kA, kA, kA));
  EXPECT_TRUE(segment_triangle(kA, kA, kA, kA, kA));
}

/// Random fp32 coordinates, and segments aimed at corners and edges, which is where a test goes wrong.
TEST(DecideStatic, AgreesWithRationalArithmetic) {
  std::mt19937 random(7);
  const auto coordinate = [&] { return static_cast<double>(static_cast<float>(random()) / 4294967296.0F - 0.5F); };
  const auto point = [&] { return glm::dvec3(coordinate(), coordinate(), coordinate()); };
  int hits = 0;
  for (int i = 0; i < 20000; ++i) {
    const glm::dvec3 a = point();
    const glm::dvec3 b = point();
    const glm::dvec3 c = point();
    const glm::dvec3 p = point();
    glm::dvec3 q = point();
    if (i % 4 == 1) q = glm::dvec3(glm::vec3(2.0 * a - p));        // through a corner, nearly
    if (i % 4 == 2) q = glm::dvec3(glm::vec3(a + b - p));          // through an edge, nearly
    if (i % 4 == 3) q = glm::dvec3(glm::vec3((a + b + c) / 3.0));  // ending on the surface, nearly
    const auto found = segment_triangle(p, q, a, b, c);
    ASSERT_EQ(found, exact::static_contact({p, q}, {a, b, c})) << "case " << i;
    if (found) ++hits;
  }
  EXPECT_GT(hits, 2000);
}

TEST(DecideStatic, AnswersThePublicStaticQueriesRightly) {
  const auto path = test::data("ccd/static_segment_triangle.csv");
  VESTIGE_REQUIRE_DATA(path);
  std::ifstream file(path);
  std::string line;
  std::getline(file, line);
  std::vector<std::string> names;
  for (std::istringstream header(line); std::getline(header, line, ',');) names.push_back(line);
  const auto first = static_cast<std::size_t>(std::ranges::find(names, "px") - names.begin());
  const auto truth = static_cast<std::size_t>(std::ranges::find(names, "gt") - names.begin());
  int queries = 0;
  int wrong = 0;
  while (std::getline(file, line)) {
    std::vector<std::string> fields;
    std::istringstream row(line);
    for (std::string field; std::getline(row, field, ',');) fields.push_back(field);
    std::array<glm::dvec3, 5> points = {};
    for (std::size_t i = 0; i < 15; ++i)
      points[i / 3][static_cast<int>(i % 3)] = std::strtod(fields.at(first + i).c_str(), nullptr);
    const bool hit = segment_triangle(points[0], points[1], points[2], points[3], points[4]).has_value();
    if (hit != (fields.at(truth) == "1")) ++wrong;
    ++queries;
  }
  EXPECT_EQ(queries, 550);
  EXPECT_EQ(wrong, 0);
}

}  // namespace
}  // namespace vestige
