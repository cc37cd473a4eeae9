// Segments far longer than the body: cutting them to where the skin can be changes the work, and no bit of the result.

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <ostream>
#include <random>
#include <utility>
#include <vector>

#include "detector/detector.hpp"
#include "detector/detectors/make_detectors.hpp"
#include "tests/support/builtin_avatar.hpp"
#include "tests/support/builtin_map.hpp"
#include "tests/support/scene_run.hpp"
#include "tests/support/simd_targets.hpp"
#include "tests/support/small_avatar.hpp"

namespace vestige {
namespace {

using test::builtin_avatar;
using test::builtin_map;

/// A rugged square of 128 triangles. All coordinates are multiples of 2^-4, so that long segments can go through its
/// corners exactly.
Avatar rugged_square() {
  constexpr std::uint32_t kSide = 9;
  std::mt19937 random(3);
  std::vector<glm::vec3> vertices;
  std::vector<glm::uvec3> triangles;
  for (std::uint32_t y = 0; y < kSide; ++y)
    for (std::uint32_t x = 0; x < kSide; ++x)
      vertices.emplace_back(static_cast<float>(x) / 4 - 1, static_cast<float>(y) / 4 - 1,
                            static_cast<float>(random() % 16) / 16 - 0.5F);
  for (std::uint32_t y = 0; y + 1 < kSide; ++y)
    for (std::uint32_t x = 0; x + 1 < kSide; ++x) {
      const std::uint32_t corner = y * kSide + x;
      triangles.emplace_back(corner, corner + 1, corner + kSide + 1);
      triangles.emplace_back(corner, corner + kSide + 1, corner + kSide);
    }
  return test::rigid_avatar(vertices, triangles);
}

/// Along the axes and all diagonals, one way of each.
std::vector<glm::dvec3> directions() {
  std::vector<glm::dvec3> all;
  for (int x = -1; x <= 1; ++x)
    for (int y = -1; y <= 1; ++y)
      for (int z = -1; z <= 1; ++z)
        if (9 * x + 3 * y + z > 0) all.emplace_back(x, y, z);
  return all;
}

/// Two frames, between which a collider moves through every corner in each direction, from `way_m` before it to as far
/// behind it; through one in `one_in` corners. With `carried` and `ccd` it meets the corner half way, while the square
/// moves.
std::vector<TraceFrame> through_corners(const Avatar& square, double way_m, float radius_m, Method method,
                                        std::size_t one_in = 1) {
  const glm::dvec3 step_m(0.0625, -0.125, 0.25);
  std::vector<TraceFrame> frames(2);
  for (std::size_t k = 0; k < frames.size(); ++k) {
    TraceFrame& frame = frames[k];
    frame.index = k;
    frame.time_ns = static_cast<std::int64_t>(k) * 1000000;
    frame.poses.front() = rest_pose(square);
    frame.poses.front().nodes[0].translation = glm::vec3(k == 0 ? -step_m : glm::dvec3(0));
    const glm::dvec3 aside_m = method == Method::kStatic ? glm::dvec3(0) : -0.5 * step_m;
    for (std::size_t i = 0; i < square.position_bind.size(); i += one_in)
      for (const glm::dvec3& direction : directions()) {
        const auto id = static_cast<std::uint32_t>(frame.colliders.size());
        const glm::dvec3 off_m = glm::dvec3(radius_m, 0, 0);  // a sphere that just touches
        const double along_m = k == 0 ? -way_m : way_m;
        frame.colliders.push_back(
            {id, glm::dvec3(square.position_bind[i]) + aside_m + off_m + along_m * direction, radius_m});
      }
  }
  return frames;
}

test::SceneRun run(const std::vector<TraceFrame>& scene, const Avatar& avatar, Method method, Skip skip) {
  const DetectorOptions options = {Surface::kAll, kHashedPlanes, method, skip};
  const auto colliders = static_cast<std::uint32_t>(scene.front().colliders.size());
  return test::run_scene(scene, avatar, colliders, *make_cpu_detector(avatar, builtin_map(), options));
}

void expect_same(const test::SceneRun& found, const test::SceneRun& expected) {
  ASSERT_EQ(found.rows.size(), expected.rows.size());
  for (std::size_t k = 0; k < found.rows.size(); ++k) {
    std::size_t differ = 0;
    for (std::size_t column = 0; column < found.rows[k].size(); ++column) {
      const Contact& a = std::as_const(found.rows[k])[column];
      const Contact& b = std::as_const(expected.rows[k])[column];
      if (a.triangle != b.triangle || a.t != b.t) ++differ;
    }
    EXPECT_EQ(differ, 0U) << "of " << found.rows[k].size() << " colliders in frame " << k;
  }
  EXPECT_EQ(hash_of(found), hash_of(expected));
}

class LongWaysOfEachMethod : public ::testing::TestWithParam<Method> {};

TEST_P(LongWaysOfEachMethod, GrazeCornersWithTheSameBitsSkippingOrNot) {
  const Avatar square = rugged_square();
  for (const double way_m : {1.0, 16.0, 1024.0, 65536.0, 1048576.0}) {
    SCOPED_TRACE(way_m);
    const auto scene = through_corners(square, way_m, 0, GetParam());
    const test::SceneRun expected = run(scene, square, GetParam(), Skip::kOff);
    EXPECT_GT(expected.contacts(), 81U * 13 / 2);
    expect_same(run(scene, square, GetParam(), Skip::kOn), expected);
  }
}

TEST_P(LongWaysOfEachMethod, GrazeWithSpheresAndAcrossTheUniverseWithTheSameBitsToo) {
  const Avatar square = rugged_square();
  const std::pair<double, float> asked[] = {{16, 0.0625F}, {1024, 0.0625F}, {1e8, 0}, {1e12, 0}, {1e30, 0}};
  for (const auto& [way_m, radius_m] : asked) {
    SCOPED_TRACE(::testing::Message() << way_m << " m, radius " << radius_m << " m");
    const auto scene = through_corners(square, way_m, radius_m, GetParam(), 16);
    expect_same(run(scene, square, GetParam(), Skip::kOn), run(scene, square, GetParam(), Skip::kOff));
  }
}

TEST_P(LongWaysOfEachMethod, AreCutToTheSameBitsOnEveryInstructionSet) {
  const Avatar square = rugged_square();
  const auto scene = through_corners(square, 512, 0, GetParam());
  const test::SceneRun expected = run(scene, square, GetParam(), Skip::kOff);
  test::on_every_simd_target([&](const char* target) {
    SCOPED_TRACE(target);
    expect_same(run(scene, square, GetParam(), Skip::kOn), expected);
  });
}

/// Two frames, between which colliders move in many directions exactly through the origin, after an eighth of their
/// ways. There a triangle that moves by `step_m` along each axis arrives with a corner.
std::vector<TraceFrame> through_the_origin(const Avatar& triangle, double way_m, double step_m) {
  std::vector<TraceFrame> frames(2);
  for (std::size_t k = 0; k < frames.size(); ++k) {
    TraceFrame& frame = frames[k];
    frame.index = k;
    frame.time_ns = static_cast<std::int64_t>(k) * 1000000;
    frame.poses.front() = rest_pose(triangle);
    frame.poses.front().nodes[0].translation = glm::vec3(k == 0 ? -static_cast<float>(step_m) : 0);
    for (std::uint32_t id = 0; id < 512; ++id) {
      const glm::uvec3 length(id % 4, id / 4 % 4, id / 16 % 4);
      const glm::uvec3 sign(id / 64 % 2, id / 128 % 2, id / 256);
      const glm::dvec3 direction = (1.0 + 0.25 * glm::dvec3(length)) * (1.0 - 2.0 * glm::dvec3(sign));
      frame.colliders.push_back({id, (k == 0 ? -way_m : 7 * way_m) * direction});
    }
  }
  return frames;
}

Avatar corner_at_the_origin() {
  return test::rigid_avatar({{0, 0, 0}, {1, 0.25F, 0.5F}, {0.25F, 1, -0.5F}}, {{0, 1, 2}});
}

TEST(LongWays, MeetACornerThatDoublePrecisionMisses) {
  const Avatar triangle = corner_at_the_origin();
  for (const double way_m : {0x1p10, 0x1p30, 0x1p36, 0x1p38, 0x1p100}) {
    SCOPED_TRACE(way_m);
    const test::SceneRun found = run(through_the_origin(triangle, way_m, 0), triangle, Method::kStatic, Skip::kOn);
    EXPECT_EQ(found.contacts(), 512U);
  }
}

TEST(LongWays, AreCarriedAsFarAsRoundingCarriesThem) {
  const Avatar triangle = corner_at_the_origin();
  // From here to twice as far, fp32 has steps of 1/8 m. So a start a step before -way is carried by 3/32 m to -way.
  constexpr double kWay_m = 0x1p20;
  auto scene = through_the_origin(triangle, kWay_m, 0.09375);
  for (ColliderSample& collider : scene.front().colliders) collider.position_m -= 0.125;
  const test::SceneRun expected = run(scene, triangle, Method::kCarried, Skip::kOff);
  EXPECT_GT(expected.contacts(), 50U);
  expect_same(run(scene, triangle, Method::kCarried, Skip::kOn), expected);
}

/// The colliders of a swarm, of which some are far away in every other frame, and some nowhere.
std::vector<TraceFrame> swarm_of_jumpers(std::uint32_t one_in) {
  auto scene = test::scene("swarm", builtin_avatar(), 60, 6, 90);
  std::mt19937_64 random(11);
  std::normal_distribution<double> number(0, 1);
  for (TraceFrame& frame : scene)
    for (ColliderSample& collider : frame.colliders) {
      if (collider.id % 7 == 0) collider.radius_m = 0.03F;
      if (collider.id % one_in != 0 || (frame.index + collider.id / one_in) % 2 == 0) continue;
      const double away_m = std::pow(10, static_cast<double>(collider.id % 7 == 0 ? 2 : collider.id % 31));
      collider.position_m += away_m * glm::dvec3(number(random), number(random), number(random));
      if (collider.id % 29 == 3) collider.position_m.y = std::numeric_limits<double>::quiet_NaN();
      if (collider.id % 29 == 5) collider.position_m.z = -std::numeric_limits<double>::infinity();
    }
  return scene;
}

TEST_P(LongWaysOfEachMethod, AreFewOrAllOfASwarmWithTheSameBitsSkippingOrNot) {
  for (const std::uint32_t one_in : {1U, 3U, 20U}) {
    SCOPED_TRACE(one_in);
    const auto scene = swarm_of_jumpers(one_in);
    const test::SceneRun expected = run(scene, builtin_avatar(), GetParam(), Skip::kOff);
    EXPECT_GT(expected.contacts(), 5U);
    expect_same(run(scene, builtin_avatar(), GetParam(), Skip::kOn), expected);
  }
}

TEST_P(LongWaysOfEachMethod, AreTestedAgainstFewTriangles) {
  const auto count = [&](double away_m) {
    std::vector<TraceFrame> scene = test::scene("swarm", builtin_avatar(), 200, 2, 1000);
    std::mt19937_64 random(2);
    std::normal_distribution<double> number(0, 1);
    const DetectorOptions options = {Surface::kAll, kHashedPlanes, GetParam(), Skip::kOn};
    const auto cpu = make_cpu_detector(builtin_avatar(), builtin_map(), options);
    for (std::size_t i = 0; i < 200; ++i) {
      const glm::dvec3 way_m = away_m * glm::dvec3(number(random), number(random), number(random));
      scene[0].colliders[i].position_m = scene[1].colliders[i].position_m - way_m;
      scene[1].colliders[i].position_m += way_m;
    }
    FrameBuilder builder = test::frame_builder(builtin_avatar(), 200, GetParam());
    ContactRow row;
    cpu->detect(builder.next(scene[0]), row);
    return cpu->detect(builder.next(scene[1]), row).pairs_tested;
  };
  EXPECT_LT(count(1e6), 200 * builtin_avatar().triangles.size() / 10);
  EXPECT_LT(count(1e6), 2 * count(1e2));
}

INSTANTIATE_TEST_SUITE_P(Each, LongWaysOfEachMethod, ::testing::Values(Method::kStatic, Method::kCarried, Method::kCcd),
                         [](const auto& test) { return std::string(name_of(test.param)); });

}  // namespace
}  // namespace vestige
