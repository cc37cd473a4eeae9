#include "detector/actuators/surface_distance.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <numbers>
#include <queue>
#include <random>

#include "tests/support/builtin_avatar.hpp"
#include "tests/support/flat_body.hpp"

namespace vestige {
namespace {

using Gaps = SurfaceDistance::Gaps;
constexpr double kInfinity = std::numeric_limits<double>::infinity();

std::vector<glm::dvec3> positions_of(const Avatar& avatar) {
  return {avatar.position_bind.begin(), avatar.position_bind.end()};
}

/// The shortest ways along edges, by the book.
std::vector<double> along_edges(const SurfaceDistance& surface, const SkinPoint& source) {
  const auto& position = surface.position_m();
  std::vector<std::vector<std::uint32_t>> beside(position.size());
  for (const glm::uvec3& triangle : surface.triangles())
    for (int i = 0; i < 3; ++i)
      for (int k = 1; k < 3; ++k) beside[triangle[i]].push_back(triangle[(i + k) % 3]);
  std::vector<double> distance(position.size(), kInfinity);
  std::priority_queue<std::pair<double, std::uint32_t>> front;
  const glm::uvec3& first = surface.triangles()[source.triangle];
  for (int i = 0; i < 3; ++i) {
    distance[first[i]] = glm::distance(surface.position_of(source), position[first[i]]);
    front.emplace(-distance[first[i]], first[i]);
  }
  while (!front.empty()) {
    const auto [here_m, here] = front.top();
    front.pop();
    if (-here_m > distance[here]) continue;
    for (const std::uint32_t next : beside[here]) {
      const double next_m = -here_m + glm::distance(position[here], position[next]);
      if (next_m >= distance[next]) continue;
      distance[next] = next_m;
      front.emplace(-next_m, next);
    }
  }
  return distance;
}

/// A sphere of radius 1: `rings` between the poles.
SurfaceDistance sphere(int rings) {
  std::vector<glm::dvec3> position = {{0, 1, 0}};
  std::vector<glm::uvec3> triangles;
  const int around = 2 * rings;
  for (int r = 1; r <= rings; ++r) {
    for (int k = 0; k < around; ++k) {
      const double polar = std::numbers::pi * r / (rings + 1);
      const double angle = 2 * std::numbers::pi * (k + 0.5 * (r % 2)) / around;
      position.emplace_back(std::sin(polar) * std::cos(angle), std::cos(polar), std::sin(polar) * std::sin(angle));
    }
  }
  position.emplace_back(0, -1, 0);
  const auto at = [&](int r, int k) { return static_cast<unsigned>(1 + (r - 1) * around + (k + around) % around); };
  for (int k = 0; k < around; ++k) {
    triangles.emplace_back(0U, at(1, k), at(1, k + 1));
    triangles.emplace_back(static_cast<unsigned>(position.size() - 1), at(rings, k), at(rings, k + 1));
    for (int r = 1; r < rings; ++r) {
      const int shift = r % 2;
      triangles.emplace_back(at(r, k), at(r, k + 1), at(r + 1, k + shift));
      triangles.emplace_back(at(r + 1, k + shift), at(r + 1, k + shift - 1), at(r, k));
    }
  }
  return {position, triangles, Gaps::kOpen};
}

double largest_error(const SurfaceDistance& surface, const SkinPoint& source, const auto& truth) {
  const std::vector<double> distance = surface.from(source);
  double largest = 0;
  for (std::size_t i = 0; i < distance.size(); ++i)
    largest = std::max(largest, std::abs(distance[i] - truth(surface.position_m()[i])));
  return largest;
}

TEST(SurfaceDistance, IsExactOnAPlaneHoweverItIsCut) {
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> anywhere(-0.03, 0.03);
  Avatar plane = test::flat_body(12);
  // Obtuse triangles and needles too.
  for (glm::vec3& p : plane.position_bind)
    p += glm::vec3(static_cast<float>(anywhere(random)), static_cast<float>(anywhere(random)), 0.0F);
  const SurfaceDistance surface(positions_of(plane), plane.triangles, Gaps::kOpen);
  const SkinPoint source = {150, {0.2, 0.5, 0.3}};
  const glm::dvec3 from = surface.position_of(source);
  // Beyond the ragged border some straight lines leave the surface.
  const std::vector<double> distance = surface.from(source);
  double largest = 0;
  for (std::size_t i = 0; i < distance.size(); ++i)
    if (const glm::dvec3& p = surface.position_m()[i]; p.x > 0.1 && p.x < 0.9 && p.y > 0.1 && p.y < 0.9)
      largest = std::max(largest, std::abs(distance[i] - glm::distance(from, p)));
  EXPECT_LT(largest, 1e-9);
}

TEST(SurfaceDistance, ErrsOnASphereByAPercentAndLessOnAFinerOne) {
  const auto truth = [](const glm::dvec3& p) { return std::acos(std::clamp(p.y, -1.0, 1.0)); };
  const SkinPoint pole = {0, {1, 0, 0}};
  const double coarse = largest_error(sphere(15), pole, truth);
  const double fine = largest_error(sphere(60), pole, truth);
  RecordProperty("coarse", std::to_string(coarse));
  RecordProperty("fine", std::to_string(fine));
  // Of half a turn; steps of 0.2 radii, and of 0.05.
  EXPECT_LT(coarse, 0.015 * std::numbers::pi);
  EXPECT_LT(fine, 0.003 * std::numbers::pi);
}

TEST(SurfaceDistance, GoesAroundACylinderAndNotThroughIt) {
  constexpr int kAround = 64;
  constexpr int kRows = 40;
  constexpr double kRadius = 0.15;
  std::vector<glm::dvec3> position;
  std::vector<glm::uvec3> triangles;
  for (int r = 0; r <= kRows; ++r)
    for (int k = 0; k < kAround; ++k)
      position.emplace_back(kRadius * std::cos(2 * std::numbers::pi * k / kAround), 0.01 * r,
                            kRadius * std::sin(2 * std::numbers::pi * k / kAround));
  const auto at = [](int r, int k) { return static_cast<unsigned>(r * kAround + k % kAround); };
  for (int r = 0; r < kRows; ++r)
    for (int k = 0; k < kAround; ++k) {
      triangles.emplace_back(at(r, k), at(r, k + 1), at(r + 1, k));
      triangles.emplace_back(at(r, k + 1), at(r + 1, k + 1), at(r + 1, k));
    }
  const SurfaceDistance surface(position, triangles, Gaps::kOpen);
  const double error = largest_error(surface, {0, {1, 0, 0}}, [&](const glm::dvec3& p) {
    const double angle = std::abs(std::atan2(p.z, p.x));
    return std::sqrt(kRadius * kRadius * angle * angle + p.y * p.y);
  });
  RecordProperty("error_mm", std::to_string(1e3 * error));
  EXPECT_LT(error, 0.0005);  // of 470 mm half around
}

TEST(SurfaceDistance, LiesBetweenTheStraightLineAndTheWayAlongEdges) {
  const Avatar& avatar = test::builtin_avatar();
  // Welded by hand, so that the ways along edges know of seams too.
  std::vector<glm::uvec3> triangles = avatar.triangles;
  std::map<std::array<float, 3>, std::uint32_t> first;
  for (glm::uvec3& triangle : triangles)
    for (int i = 0; i < 3; ++i) {
      const glm::vec3& p = avatar.position_bind[triangle[i]];
      triangle[i] = first.try_emplace({p.x, p.y, p.z}, triangle[i]).first->second;
    }
  const SurfaceDistance surface(positions_of(avatar), triangles, Gaps::kOpen);
  EXPECT_EQ(surface.parts(), 1U);
  for (const std::uint32_t triangle : {0U, 1234U, 4000U}) {
    const SkinPoint source = {triangle, {0.5, 0.25, 0.25}};
    const std::vector<double> distance = surface.from(source);
    const std::vector<double> edges = along_edges(surface, source);
    for (const glm::uvec3& corners : triangles)
      for (int i = 0; i < 3; ++i) {
        const std::uint32_t vertex = corners[i];
        EXPECT_LE(distance[vertex], edges[vertex] * (1 + 1e-9));
        EXPECT_GE(distance[vertex] * (1 + 1e-12),
                  glm::distance(surface.position_of(source), surface.position_m()[vertex]));
      }
  }
}

TEST(SurfaceDistance, CrossesSeamsTrianglesWithoutAreaAndEdgesOfThreeTriangles) {
  // Two squares side by side whose common corners are split, a needle along their seam, and a fin that stands on it.
  const std::vector<glm::dvec3> position = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0},   {1, 0, -0.0},
                                            {2, 0, 0}, {2, 1, 0}, {1, 1, 0}, {1, 0.5, 0}, {1, 0.5, 1}};
  const std::vector<glm::uvec3> triangles = {{0, 1, 2}, {0, 2, 3}, {4, 5, 6}, {4, 6, 7},
                                             {1, 8, 2}, {1, 2, 9}, {5, 5, 5}};
  const SurfaceDistance surface(position, triangles, Gaps::kOpen);
  const std::vector<double> distance = surface.from({1, {0, 0, 1}});  // (0, 1)
  EXPECT_DOUBLE_EQ(distance[6], 2);
  EXPECT_NEAR(distance[5], std::sqrt(5), 1e-12);
  EXPECT_DOUBLE_EQ(distance[2], distance[7]);
  EXPECT_TRUE(std::isfinite(distance[9]));
  EXPECT_EQ(surface.parts(), 1U);
}

TEST(SurfaceDistance, LeavesPartsApartOrBridgesThem) {
  // A square, another 5 mm above it, and a third far away.
  Avatar avatar = test::flat_body(4);
  std::vector<glm::dvec3> position = positions_of(avatar);
  std::vector<glm::uvec3> triangles = avatar.triangles;
  const auto count = static_cast<unsigned>(position.size());
  for (const glm::dvec3& away : {glm::dvec3(0, 0, 0.005), glm::dvec3(3, 0, 0)}) {
    const auto base = static_cast<unsigned>(position.size());
    for (unsigned i = 0; i < count; ++i) position.push_back(position[i] + away);
    for (const glm::uvec3& triangle : avatar.triangles) triangles.push_back(triangle + base);
  }
  position.emplace_back(0.5, 0.5, 0.5);  // no triangle has it
  const SurfaceDistance open(position, triangles, Gaps::kOpen);
  const SurfaceDistance bridged(position, triangles, Gaps::kBridged);
  EXPECT_EQ(open.parts(), 3U);
  const SkinPoint corner = {0, {1, 0, 0}};
  EXPECT_EQ(open.from(corner)[count], kInfinity);
  const std::vector<double> distance = bridged.from(corner);
  EXPECT_DOUBLE_EQ(distance[count], 0.005);  // straight up
  EXPECT_NEAR(distance[2 * count - 1], std::sqrt(2.0) + 0.005, 2e-3);
  EXPECT_DOUBLE_EQ(distance[2 * count], 1 + 2);  // along the border and over the gap
  EXPECT_EQ(distance.back(), kInfinity);
}

TEST(SurfaceDistance, PassesByVerticesThatAreNotFinite) {
  Avatar avatar = test::flat_body(4);
  std::vector<glm::dvec3> position = positions_of(avatar);
  position[12].x = std::numeric_limits<double>::quiet_NaN();  // the middle
  const SurfaceDistance surface(position, avatar.triangles, Gaps::kBridged);
  const std::vector<double> distance = surface.from({0, {1, 0, 0}});
  EXPECT_EQ(distance[12], kInfinity);
  EXPECT_TRUE(std::isfinite(distance[24]));
}

}  // namespace
}  // namespace vestige
