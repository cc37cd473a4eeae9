// Palettes and segments have the same bits whatever the instruction set: those of the plain formula.

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <random>
#include <span>
#include <vector>

#include "detector/build_segments.hpp"
#include "detector/skinning.hpp"
#include "tests/support/builtin_avatar.hpp"
#include "tests/support/simd_targets.hpp"
#include "traces/scene/pose.hpp"

namespace vestige {
namespace {

TEST(Palette, IsTheSameOnEveryInstructionSet) {
  const Avatar& avatar = test::builtin_avatar();
  std::vector<glm::dmat4> world;
  world_matrices(avatar, sample_animation(avatar, avatar.animations.front(), 0.4), world);
  const glm::dvec3 offset_m(0.3, -7.1, 1e-9);
  std::vector<SkinMatrix> expected;
  for (const PaletteEntry& entry : avatar.palette) {
    const glm::dmat4 matrix = world[static_cast<std::size_t>(entry.node)] * entry.inverse_bind;
    SkinMatrix& rounded = expected.emplace_back();
    for (int column = 0; column < 3; ++column)
      rounded.column[static_cast<std::size_t>(column)] = glm::vec4(glm::vec3(matrix[column]), 0);
    rounded.column[3] = glm::vec4(glm::vec3(glm::dvec3(matrix[3]) + offset_m), 0);
  }
  const glm::dvec3 extent_m = bind_extent_m(avatar);
  glm::dvec3 reach_m(0);
  for (const SkinMatrix& matrix : expected) {
    reach_m = glm::max(reach_m, skin_reach_m(matrix, extent_m));
    for (const glm::vec4& column : matrix.column) reach_m = glm::max(reach_m, glm::abs(glm::dvec3(column)));
  }
  test::on_every_simd_target([&](const char* target) {
    std::vector<SkinMatrix> palette;
    build_palette(avatar, world, offset_m, palette);
    ASSERT_EQ(palette.size(), expected.size());
    EXPECT_EQ(std::memcmp(palette.data(), expected.data(), palette.size() * sizeof(SkinMatrix)), 0) << target;
    EXPECT_EQ(palette_reach_m(palette, extent_m, 1e9), reach_m) << target;
    EXPECT_FALSE(palette_reach_m(palette, extent_m, reach_m.y)) << target;
    palette.back().column[1].y = std::numeric_limits<float>::quiet_NaN();
    EXPECT_FALSE(palette_reach_m(palette, extent_m, 1e9)) << target;
  });
}

TEST(Segments, AreTheSameOnEveryInstructionSet) {
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> number(-1, 1);
  const double odd[] = {
      std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(), 1e39, -3e38, 1e30, 5.0};
  const SegmentPlace place = {glm::dvec3(3, -1, 2), glm::vec3(0.5, 0.9, 0.4), 2, 1.25F};
  std::vector<ColliderMove> moves(3000);
  for (std::uint32_t i = 0; i < moves.size(); ++i) {
    ColliderMove& move = moves[i];
    move.column = i;
    move.owner = static_cast<std::uint16_t>(i % 5);
    move.radius_m = i % 3 == 0 ? 0.25 : 0;
    for (glm::dvec3* at : {&move.start_m, &move.end_m})
      *at = place.origin_m + glm::dvec3(number(random), number(random), number(random));
    if (i % 50 == 0) move.end_m[static_cast<int>(i / 50 % 3)] = odd[i / 150 % std::size(odd)];
    if (i % 70 == 0) move.start_m[static_cast<int>(i / 70 % 3)] = odd[i / 210 % std::size(odd)];
  }
  const auto expected_with = [&](const glm::vec3& reach_m, SegmentCounts& counts) {
    std::vector<Segment> segments;
    for (const ColliderMove& move : moves) {
      if (move.owner == place.left_owner) continue;
      const Segment segment = {move.column, glm::vec3(move.start_m - place.origin_m),
                               glm::vec3(move.end_m - place.origin_m), static_cast<float>(move.radius_m)};
      const float radius_m = bounding_radius_m(segment);
      bool in_range = true;
      bool is_beyond = false;
      bool is_long = false;
      for (int axis = 0; axis < 3; ++axis) {
        const float a = segment.start[axis];
        const float b = segment.end[axis];
        constexpr float kRange_m = std::numeric_limits<float>::max() / 2;
        in_range = in_range && std::abs(a) < kRange_m && std::abs(b) < kRange_m;
        is_long = is_long || std::abs(b - a) > place.long_m;
        is_beyond =
            is_beyond || std::min(a, b) > reach_m[axis] + radius_m || std::max(a, b) < -(reach_m[axis] + radius_m);
      }
      if (!in_range) {
        ++counts.out_of_range;
      } else if (is_beyond) {
        ++counts.out_of_reach;
      } else {
        counts.long_segments += is_long ? 1 : 0;
        segments.push_back(segment);
      }
    }
    return segments;
  };
  for (const glm::vec3& reach_m : {place.reach_m, glm::vec3(std::numeric_limits<float>::infinity())}) {
    SegmentCounts counts;
    const std::vector<Segment> expected = expected_with(reach_m, counts);
    EXPECT_GT(counts.out_of_range, 20U);
    EXPECT_GT(counts.long_segments, 100U);
    EXPECT_EQ(counts.out_of_reach > 100, std::isfinite(reach_m.x));
    test::on_every_simd_target([&](const char* target) {
      std::vector<Segment> segments;
      const SegmentCounts found =
          build_segments(moves, {place.origin_m, reach_m, place.left_owner, place.long_m}, segments);
      EXPECT_EQ(found.out_of_range, counts.out_of_range) << target;
      EXPECT_EQ(found.out_of_reach, counts.out_of_reach) << target;
      EXPECT_EQ(found.long_segments, counts.long_segments) << target;
      ASSERT_EQ(segments.size(), expected.size()) << target;
      const auto differ = [](const Segment& a, const Segment& b) { return std::memcmp(&a, &b, sizeof(Segment)) != 0; };
      for (std::size_t i = 0; i < segments.size(); ++i)
        ASSERT_FALSE(differ(segments[i], expected[i])) << target << ", column " << expected[i].column;
    });
  }
}

}  // namespace
}  // namespace vestige
