#include "detector/actuators/mapped_skin.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <random>
#include <set>

#include "detector/detectors/contact_description.hpp"
#include "detector/detectors/make_detectors.hpp"
#include "tests/support/builtin_avatar.hpp"
#include "tests/support/builtin_map.hpp"
#include "tests/support/gl/gl_context.hpp"
#include "tests/support/scene_run.hpp"
#include "tests/support/small_avatar.hpp"

namespace vestige {
namespace {

using test::builtin_avatar;
using test::builtin_map;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

/// 8 x 8 texels, black but for one.
ActuatorMap map_with_texel(std::uint32_t column, std::uint32_t row) {
  ActuatorMap map;
  map.width = 8;
  map.height = 8;
  map.actuator.assign(64, 0);
  map.actuator[std::size_t{row} * 8 + column] = 1;
  map.actuator_count = 1;
  map.names = {"one"};
  return map;
}

/// Triangles by their texture coordinates, in texels of an 8 x 8 map.
Avatar avatar_with(const std::vector<std::array<glm::vec2, 3>>& triangles) {
  std::vector<glm::vec3> vertices;
  std::vector<glm::uvec3> corners;
  for (const auto& triangle : triangles) {
    const auto first = static_cast<std::uint32_t>(vertices.size());
    for (const glm::vec2& corner : triangle) vertices.emplace_back(corner / 8.0F, 0);
    corners.emplace_back(first, first + 1, first + 2);
  }
  return test::rigid_avatar(vertices, corners);
}

TEST(MappedTriangles, AreThoseThatCoverAnActuatorsTexelOrLieWithinOneOfIt) {
  const Avatar avatar = avatar_with({{{{4.2F, 4.2F}, {4.8F, 4.2F}, {4.2F, 4.8F}}},    // inside the texel
                                     {{{0.5F, 0.5F}, {7.5F, 0.5F}, {0.5F, 7.5F}}},    // its slanted edge passes close
                                     {{{2.1F, 4.5F}, {2.9F, 4.5F}, {2.5F, 4.9F}}},    // one texel further left
                                     {{{3.1F, 4.5F}, {3.9F, 4.5F}, {3.5F, 4.9F}}},    // the texel beside
                                     {{{4.5F, 6.1F}, {4.9F, 6.1F}, {4.5F, 7.0F}}},    // two texels below
                                     {{{4.5F, 0.0F}, {4.5F, 8.0F}, {4.5F, 4.0F}}}});  // a line across
  EXPECT_THAT(mapped_triangles(avatar, map_with_texel(4, 4)), ElementsAre(0, 1, 3, 5));
}

TEST(MappedTriangles, WrapAroundTheMapAsTheLookupDoes) {
  const Avatar avatar = avatar_with({{{{-8.5F, 24.5F}, {-8.1F, 24.5F}, {-8.5F, 24.1F}}},  // texel (7, 0)
                                     {{{7.5F, 7.5F}, {8.5F, 7.5F}, {8.5F, 8.5F}}},        // across the seam
                                     {{{-5.5F, 3.5F}, {-5.1F, 3.5F}, {-5.5F, 3.1F}}}});   // texel (2, 3)
  EXPECT_THAT(mapped_triangles(avatar, map_with_texel(7, 0)), ElementsAre(0, 1));
  EXPECT_THAT(mapped_triangles(avatar, map_with_texel(2, 3)), ElementsAre(2));
}

TEST(MappedTriangles, KeepWhateverCannotBeTold) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const Avatar avatar = avatar_with({{{{1, 1}, {1, nan}, {1, 2}}},
                                     {{{1e9F, 1}, {1e9F, 2}, {1e9F, 3}}},
                                     {{{1, 1}, {1, 12}, {2, 1}}},
                                     {{{1, 1}, {1, 2}, {2, 1}}}});
  EXPECT_THAT(mapped_triangles(avatar, map_with_texel(6, 6)), ElementsAre(0, 1, 2));
}

TEST(MappedTriangles, AreNoneOnABlackMapAndAllOnAFullOne) {
  const Avatar avatar = avatar_with({{{{1, 1}, {1, 2}, {2, 1}}}, {{{5, 5}, {5, 6}, {6, 5}}}});
  ActuatorMap map = map_with_texel(0, 0);
  map.actuator[0] = 0;
  EXPECT_THAT(mapped_triangles(avatar, map), IsEmpty());
  map.actuator.assign(64, 1);
  EXPECT_THAT(mapped_triangles(avatar, map), ElementsAre(0, 1));
}

TEST(MappedTriangles, LeaveOutNoneThatCanFireAnywhere) {
  std::mt19937 random(1);
  std::uniform_real_distribution<float> place(-12, 12);
  std::uniform_real_distribution<float> size(-3, 3);
  std::uniform_real_distribution<double> weight(0, 1);
  std::size_t left_out = 0;
  for (int round = 0; round < 400; ++round) {
    const ActuatorMap map = map_with_texel(random() % 8, random() % 8);
    const glm::vec2 at(place(random), place(random));
    const auto corner = [&] { return at + glm::vec2(size(random), size(random)); };
    const Avatar avatar = avatar_with({{corner(), corner(), corner()}});
    if (!mapped_triangles(avatar, map).empty()) continue;
    ++left_out;
    for (int sample = 0; sample < 500; ++sample) {
      double u = weight(random);
      double v = weight(random);
      if (u + v > 1) {
        u = 1 - u;
        v = 1 - v;
      }
      const auto& uv = avatar.texture_coordinate;
      const glm::dvec2 a(uv[0]);
      ASSERT_EQ(map.at(a + u * (glm::dvec2(uv[1]) - a) + v * (glm::dvec2(uv[2]) - a)), 0);
    }
  }
  EXPECT_GT(left_out, 100U);
}

TEST(MappedTriangles, LeaveOutMostOfTheBuiltinAvatarWhoseVestCoversItsTorso) {
  const std::size_t kept = mapped_triangles(builtin_avatar(), builtin_map()).size();
  EXPECT_GT(kept, 100U);
  EXPECT_LT(kept, builtin_avatar().triangles.size() / 2);
}

struct Kind {
  const char* name;
  DetectorMaker make;
};

class MappedSkin : public ::testing::TestWithParam<Kind> {};

TEST_P(MappedSkin, GivesTheBitsOfTheWholeSkin) {
  for (const char* scenario : {"swarm", "hug"}) {
    const auto scene = test::scene(scenario, builtin_avatar(), 50, 8, 20);
    const auto whole = GetParam().make(builtin_avatar(), builtin_map());
    const auto mapped = on_mapped_skin(builtin_avatar(), builtin_map(), GetParam().make);
    EXPECT_EQ(mapped->triangles_left_out() + mapped_triangles(builtin_avatar(), builtin_map()).size(),
              builtin_avatar().triangles.size());
    EXPECT_EQ(mapped->name(), std::string(whole->name()));
    const test::SceneRun expected = test::run_scene(scene, builtin_avatar(), 50, *whole);
    EXPECT_GT(expected.contacts(), 5U);
    EXPECT_EQ(hash_of(test::run_scene(scene, builtin_avatar(), 50, *mapped)), hash_of(expected));
  }
}

/// Whatever its texture coordinates say: here they are all alike.
TEST_P(MappedSkin, FiresByTriangleWhereTheMapIsOfTriangles) {
  Avatar avatar = builtin_avatar();
  ActuatorMap map = builtin_map();
  map.triangle_count = avatar.triangles.size();
  map.width = 72;
  map.height = 70;
  map.actuator.assign(std::size_t{map.width} * map.height, 0);
  for (std::size_t i = 0; i < avatar.triangles.size(); ++i) {
    glm::dvec2 middle(0);
    for (int k = 0; k < 3; ++k) middle += glm::dvec2(avatar.texture_coordinate[avatar.triangles[i][k]]) / 3.0;
    map.actuator[i] = builtin_map().at(middle);
  }
  avatar.texture_coordinate.assign(avatar.texture_coordinate.size(), glm::vec2(0));
  const auto scene = test::scene("hug", avatar, 50, 8, 20);
  const auto mapped = on_mapped_skin(avatar, map, GetParam().make);
  EXPECT_GT(mapped->triangles_left_out(), 1000U);
  const test::SceneRun run = test::run_scene(scene, avatar, 50, *mapped);
  std::set<std::uint16_t> fired;
  for (const ContactRow& row : run.rows)
    for (const Contact& contact : row) {
      if (!contact.hit()) continue;
      EXPECT_EQ(contact.actuator, map.actuator[contact.triangle]) << contact.triangle;
      fired.insert(contact.actuator);
    }
  EXPECT_GT(fired.size(), 3U);
  EXPECT_EQ(hash_of(run), hash_of(test::run_scene(scene, avatar, 50, *GetParam().make(avatar, map))));
}

INSTANTIATE_TEST_SUITE_P(
    Each, MappedSkin,
    ::testing::Values(
        Kind{"cpu",
             [](const Avatar& avatar, const ActuatorMap& map) {
               return make_cpu_detector(avatar, map, {Surface::kMapped, kHashedPlanes});
             }},
        Kind{"cpu_skipping",
             [](const Avatar& avatar, const ActuatorMap& map) {
               return make_cpu_detector(avatar, map, {Surface::kMapped, kHashedPlanes, Method::kStatic, Skip::kOn});
             }},
        Kind{"cpu_ccd",
             [](const Avatar& avatar, const ActuatorMap& map) {
               return make_cpu_detector(avatar, map, {Surface::kMapped, kHashedPlanes, Method::kCcd});
             }},
        Kind{"paper",
             [](const Avatar& avatar, const ActuatorMap& map) {
               return make_paper_detector(test::make_context(), avatar, map, {Surface::kMapped, kHashedPlanes});
             }},
        Kind{"geometry",
             [](const Avatar& avatar, const ActuatorMap& map) {
               return make_geometry_detector(test::make_context(), avatar, map, {Surface::kMapped, kHashedPlanes});
             }}),
    [](const auto& test) { return std::string(test.param.name); });

TEST(MappedSkin, GivesTheBitsOfTheSlowTruthOnTheWholeSkin) {
  const auto scene = test::scene("swarm", builtin_avatar(), 50, 6, 20);
  const DetectorOptions options = {Surface::kMapped, kHashedPlanes};
  const auto cpu = on_mapped_skin(builtin_avatar(), builtin_map(), [&](const Avatar& avatar, const ActuatorMap& map) {
    return make_cpu_detector(avatar, map, options);
  });
  const auto exact = make_exact_detector(builtin_avatar(), builtin_map(), options);
  EXPECT_EQ(hash_of(test::run_scene(scene, builtin_avatar(), 50, *cpu)),
            hash_of(test::run_scene(scene, builtin_avatar(), 50, *exact)));
}

TEST(MappedSkin, FiresNothingUnderABlackMap) {
  ActuatorMap black = builtin_map();
  black.actuator.assign(black.actuator.size(), 0);
  const auto scene = test::scene("swarm", builtin_avatar(), 20, 4, 20);
  const auto cpu = on_mapped_skin(builtin_avatar(), black, [&](const Avatar& avatar, const ActuatorMap& map) {
    return make_cpu_detector(avatar, map, {Surface::kMapped, kHashedPlanes});
  });
  EXPECT_EQ(test::run_scene(scene, builtin_avatar(), 20, *cpu).contacts(), 0U);
}

}  // namespace
}  // namespace vestige
