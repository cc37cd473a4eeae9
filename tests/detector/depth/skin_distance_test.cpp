#include "detector/depth/skin_distance.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <limits>
#include <map>
#include <random>
#include <utility>
#include <vector>

#include "detector/depth/depth_detector.hpp"
#include "detector/detectors/make_detectors.hpp"
#include "detector/nearest_in_triangle.hpp"
#include "tests/support/builtin_avatar.hpp"
#include "tests/support/builtin_map.hpp"
#include "tests/support/scene_run.hpp"
#include "tests/support/small_avatar.hpp"

namespace vestige {
namespace {

using test::builtin_avatar;
using test::builtin_map;

struct Mesh {
  std::vector<glm::vec3> vertices;
  std::vector<glm::uvec3> triangles;

  Avatar avatar() const { return test::rigid_avatar(vertices, triangles); }
};

/// A cube from -1 to 1. Each face has corners of its own, as at the seams of a texture.
Mesh cube() {
  Mesh mesh;
  for (int axis = 0; axis < 3; ++axis) {
    for (const float side : {-1.0F, 1.0F}) {
      const auto first = static_cast<unsigned>(mesh.vertices.size());
      for (const auto& [u, v] : {std::pair{-1.0F, -1.0F}, {1.0F, -1.0F}, {1.0F, 1.0F}, {-1.0F, 1.0F}}) {
        glm::vec3 corner;
        corner[axis] = side;
        corner[(axis + 1) % 3] = u;
        corner[(axis + 2) % 3] = v;
        mesh.vertices.push_back(corner);
      }
      if (side > 0) {
        mesh.triangles.insert(mesh.triangles.end(), {{first, first + 1, first + 2}, {first, first + 2, first + 3}});
      } else {
        mesh.triangles.insert(mesh.triangles.end(), {{first, first + 2, first + 1}, {first, first + 3, first + 2}});
      }
    }
  }
  return mesh;
}

double signed_m(const Avatar& avatar, const glm::dvec3& point) {
  SkinDistance distance(avatar);
  const DetectorFrame frame = test::frame_of(avatar, {});
  distance.begin(frame);
  return distance.signed_m(point);
}

TEST(SkinDistance, OfACubeIsNegativeInside) {
  const Avatar avatar = cube().avatar();
  EXPECT_EQ(signed_m(avatar, {1.25, 0, 0}), 0.25);
  EXPECT_EQ(signed_m(avatar, {0.75, 0, 0}), -0.25);
  EXPECT_EQ(signed_m(avatar, {0, 0, 0}), -1);
  EXPECT_EQ(signed_m(avatar, {0.5, 0.5, 0.875}), -0.125) << "under a diagonal";
  EXPECT_EQ(signed_m(avatar, {4, 5, 0}), 5) << "over an edge";
  EXPECT_EQ(signed_m(avatar, {3, 3, 2}), 3) << "over a corner";
  EXPECT_EQ(signed_m(avatar, {1, 0, 0}), 0);
}

TEST(SkinDistance, PassesOverTrianglesWithoutArea) {
  Mesh mesh = cube();
  mesh.triangles.insert(mesh.triangles.begin(), {{0, 0, 1}, {2, 2, 2}, {20, 21, 20}});
  EXPECT_EQ(signed_m(mesh.avatar(), {4, 5, 0}), 5);
  EXPECT_EQ(signed_m(mesh.avatar(), {-0.75, 0.5, 0.125}), -0.25);
  EXPECT_EQ(signed_m(mesh.avatar(), {3, 3, 2}), 3);
}

/// A sharp edge from P to Q. The face above it ends there in one piece, that below in two, which meet between at M. The
/// triangle P, M, Q without area closes the gap of no width.
Mesh wedge(float middle) {
  enum : unsigned { kP, kQ, kM, kAboveP, kAboveQ, kBelowP, kBelowQ };
  return {{{0, -1, 0}, {0, 1, 0}, {0, middle, 0}, {-2, -1, 0.3F}, {-2, 1, 0.3F}, {-2, -1, -0.3F}, {-2, 1, -0.3F}},
          {{kP, kQ, kAboveQ},
           {kP, kAboveQ, kAboveP},
           {kP, kM, kQ},
           {kM, kP, kBelowP},
           {kM, kBelowP, kBelowQ},
           {kQ, kM, kBelowQ},
           {kQ, kBelowQ, kAboveQ},
           {kP, kAboveP, kBelowP},
           {kAboveP, kAboveQ, kBelowQ},
           {kAboveP, kBelowQ, kBelowP}}};
}

TEST(SkinDistance, SeesTheNextTriangleBeyondOneWithoutArea) {
  std::mt19937 random(4);
  std::normal_distribution<float> any(0, 1);
  for (int turn = 0; turn < 40; ++turn) {
    // Turned and moved, the triangle without area gets one of rounding errors.
    const glm::quat rotation = turn == 0
                                   ? glm::quat(1, 0, 0, 0)
                                   : glm::normalize(glm::quat(any(random), any(random), any(random), any(random)));
    const glm::vec3 moved = turn == 0 ? glm::vec3(0) : glm::vec3(any(random), any(random), any(random));
    Mesh mesh = wedge(turn == 0 ? 0 : 0.137F);
    for (glm::vec3& vertex : mesh.vertices) vertex = rotation * vertex + moved;
    const Avatar avatar = mesh.avatar();
    const auto place = [&](const glm::dvec3& point) { return glm::dquat(rotation) * point + glm::dvec3(moved); };
    for (const double y : {-0.6, -0.2, 0.2, 0.6}) {
      for (const double z : {-0.1, 0.1})
        EXPECT_NEAR(signed_m(avatar, place({0.1, y, z})), std::sqrt(0.02), 1e-5)
            << "in front of the edge, behind one of the faces; turn " << turn;
      EXPECT_LT(signed_m(avatar, place({-0.1, y, 0.001})), 0) << turn;
    }
  }
}

/// A limb that is hidden has all its vertices in one place. Here it is the tip of a pyramid.
TEST(SkinDistance, SeesTheTrianglesAroundAHiddenPart) {
  constexpr unsigned kSides = 4;
  constexpr unsigned kMiddle = 2 * kSides;  // of the hidden part, after its border
  for (const bool is_first : {false, true}) {
    for (const bool is_inside_out : {false, true}) {
      Mesh mesh = {{{-1, 0, -1}, {1, 0, -1}, {1, 0, 1}, {-1, 0, 1}}, {{0, 1, 2}, {0, 2, 3}}};
      for (unsigned i = 0; i < kSides; ++i) mesh.vertices.push_back(mesh.vertices[i] * 0.5F + glm::vec3(0, 1, 0));
      mesh.vertices.emplace_back(0, 2, 0);
      std::vector<glm::uvec3> hidden;
      for (unsigned i = 0; i < kSides; ++i) {
        const unsigned next = (i + 1) % kSides;
        mesh.triangles.insert(mesh.triangles.end(), {{i, kSides + i, kSides + next}, {i, kSides + next, next}});
        hidden.emplace_back(kMiddle, kSides + next, kSides + i);
      }
      mesh.triangles.insert(is_first ? mesh.triangles.begin() : mesh.triangles.end(), hidden.begin(), hidden.end());
      if (is_inside_out)
        for (glm::uvec3& triangle : mesh.triangles) std::swap(triangle.y, triangle.z);
      Avatar avatar = mesh.avatar();
      for (std::size_t i = kSides; i <= kMiddle; ++i) avatar.influences[i].palette[0] = 1;
      DetectorFrame frame = test::frame_of(avatar, {});
      frame.palette.push_back({{glm::vec4(0), glm::vec4(0), glm::vec4(0), glm::vec4(0, 1, 0, 1)}});
      avatar.palette.resize(2);
      SkinDistance distance(avatar);
      distance.begin(frame);
      EXPECT_EQ(distance.signed_m({0, 1.5, 0}), is_inside_out ? -0.5 : 0.5) << is_first;
      EXPECT_EQ(distance.signed_m({0, 0.25, 0}), is_inside_out ? 0.25 : -0.25) << is_first;
    }
  }
}

TEST(SkinDistance, IsPositiveAtABorderThatIsThereTwice) {
  const Avatar sheet = test::rigid_avatar({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}, {0, 1, 2}});
  EXPECT_EQ(signed_m(sheet, {0.25, 0.25, -2}), -2) << "behind it";
  EXPECT_EQ(signed_m(sheet, {-4, 0.5, -3}), 5) << "beside it";
}

TEST(SkinDistance, IsPositiveAtTheBorderOfAnOpenSkin) {
  const Avatar sheet = test::rigid_avatar({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}});
  EXPECT_EQ(signed_m(sheet, {0.25, 0.25, 2}), 2);
  EXPECT_EQ(signed_m(sheet, {0.25, 0.25, -2}), -2) << "behind it";
  EXPECT_EQ(signed_m(sheet, {-4, 0.5, -3}), 5) << "beside it";
}

/// A closed surface around the origin: a cube's, each face cut into squares, with corners at random distances. Some
/// triangles are there twice.
Mesh star(std::mt19937& random) {
  constexpr int kCells = 4;
  std::uniform_real_distribution<float> radius(0.4F, 1.6F);
  std::map<std::array<int, 3>, float> radius_of;
  Mesh mesh;
  for (int axis = 0; axis < 3; ++axis) {
    for (const int side : {-kCells, kCells}) {
      const auto vertex = [&](int u, int v) {
        std::array<int, 3> place = {};
        place[static_cast<std::size_t>(axis)] = side;
        place[static_cast<std::size_t>((axis + 1) % 3)] = 2 * u - kCells;
        place[static_cast<std::size_t>((axis + 2) % 3)] = 2 * v - kCells;
        const auto entry = radius_of.try_emplace(place, 0.0F).first;
        if (entry->second == 0) entry->second = radius(random);
        mesh.vertices.push_back(entry->second * glm::normalize(glm::vec3(place[0], place[1], place[2])));
        return static_cast<unsigned>(mesh.vertices.size() - 1);
      };
      for (int u = 0; u < kCells; ++u) {
        for (int v = 0; v < kCells; ++v) {
          const unsigned a = vertex(u, v);
          const unsigned b = vertex(u + 1, v);
          const unsigned c = vertex(u + 1, v + 1);
          const unsigned d = vertex(u, v + 1);
          const std::array<glm::uvec3, 2> halves = {glm::uvec3(a, b, c), glm::uvec3(a, c, d)};
          for (const glm::uvec3& half : halves) {
            const glm::uvec3 triangle = side > 0 ? half : glm::uvec3(half.x, half.z, half.y);
            mesh.triangles.push_back(triangle);
            if (random() % 8 == 0) mesh.triangles.push_back(triangle);
          }
        }
      }
    }
  }
  return mesh;
}

Corners corners_of(const Mesh& mesh, const glm::uvec3& triangle) {
  return {glm::dvec3(mesh.vertices[triangle.x]), glm::dvec3(mesh.vertices[triangle.y]),
          glm::dvec3(mesh.vertices[triangle.z])};
}

/// Whether the ray from the origin to a point meets the surface of a star before the point.
bool is_outside(const Mesh& star, const glm::dvec3& point) {
  for (const glm::uvec3& number : star.triangles) {
    const Corners triangle = corners_of(star, number);
    const double whole = glm::dot(triangle.a, glm::cross(triangle.b, triangle.c));
    const double a = glm::dot(point, glm::cross(triangle.b, triangle.c)) / whole;
    const double b = glm::dot(triangle.a, glm::cross(point, triangle.c)) / whole;
    const double c = glm::dot(triangle.a, glm::cross(triangle.b, point)) / whole;
    if (a >= 0 && b >= 0 && c >= 0) return a + b + c > 1;
  }
  ADD_FAILURE() << "the star has a hole";
  return false;
}

double distance_m(const Mesh& mesh, const glm::dvec3& point) {
  double least_m = std::numeric_limits<double>::infinity();
  for (const glm::uvec3& number : mesh.triangles) {
    const Corners triangle = corners_of(mesh, number);
    least_m = std::min(least_m, glm::distance(point, weighed(nearest_in_triangle(point, triangle), triangle)));
  }
  return least_m;
}

TEST(SkinDistance, HasTheRightSignAroundAnyClosedSkin) {
  std::mt19937 random(24);
  std::uniform_real_distribution<double> anywhere(-2, 2);
  std::size_t inside = 0;
  for (int i = 0; i < 12; ++i) {
    const Mesh mesh = star(random);
    const Avatar avatar = mesh.avatar();
    SkinDistance distance(avatar);
    const DetectorFrame frame = test::frame_of(avatar, {});
    distance.begin(frame);
    for (int k = 0; k < 500; ++k) {
      const glm::dvec3 point(anywhere(random), anywhere(random), anywhere(random));
      const bool outside = is_outside(mesh, point);
      inside += outside ? 0 : 1;
      EXPECT_NEAR(distance.signed_m(point), outside ? distance_m(mesh, point) : -distance_m(mesh, point), 1e-12)
          << i << ": " << point.x << ", " << point.y << ", " << point.z;
    }
  }
  EXPECT_GT(inside, 300U);
}

TEST(Depth, IsHowFarASphereReachesIntoTheBodyAtTheEndOfTheFrame) {
  const Avatar avatar = cube().avatar();
  const ActuatorMap map;
  const auto detector =
      with_depth(make_cpu_detector(avatar, map, {Surface::kAll, Plane::kDepth, Method::kStatic, Skip::kOn}), avatar);
  const auto depth_m = [&](const glm::vec3& start, const glm::vec3& end, float radius_m) {
    ContactRow row;
    detector->detect(test::frame_of(avatar, {{0, start, end, radius_m}}), row);
    EXPECT_TRUE(row[0].hit());
    return row[0].depth_m;
  };
  EXPECT_EQ(depth_m({0, 1.25F, 0}, {1.25F, 0, 0}, 0.5F), 0.25) << "it touched on top, and ends at the side";
  EXPECT_EQ(depth_m({0, 1.25F, 0}, {0, 1, 0}, 0.5F), 0.5);
  EXPECT_EQ(depth_m({0, 1.25F, 0}, {0, 0.75F, 0}, 0.5F), 0.75);
  EXPECT_EQ(depth_m({0, 1.25F, 0}, {0, 0.25F, 0}, 0.5F), 1) << "wholly inside, it is as deep as it can be";
  EXPECT_EQ(depth_m({0, 1.25F, 0}, {0, 9, 0}, 0.5F), 0) << "it is away again";
  EXPECT_EQ(depth_m({0, 2, 0}, {0, -2, 0}, 0), 0) << "a point";
}

/// The builder's frames of a scenario with spheres.
std::vector<DetectorFrame> frames_of(std::string_view scenario, std::uint32_t colliders, Method method) {
  std::vector<DetectorFrame> frames;
  FrameBuilder builder = test::frame_builder(builtin_avatar(), colliders, method);
  for (const TraceFrame& frame : test::scene(scenario, builtin_avatar(), colliders, 40, 30))
    frames.push_back(builder.next(frame));
  return frames;
}

TEST(Depth, OfAHandThatIsLaidOnTheBodyIsWhatTheScenarioSays) {
  const auto detector = with_depth(
      make_cpu_detector(builtin_avatar(), builtin_map(), {Surface::kAll, Plane::kDepth, Method::kCcd, Skip::kOn}),
      builtin_avatar());
  double deepest_m = 0;
  std::size_t contacts = 0;
  for (const DetectorFrame& frame : frames_of("brush", 1, Method::kCcd)) {
    ContactRow row;
    detector->detect(frame, row);
    if (!row[0].hit()) continue;
    ++contacts;
    deepest_m = std::max(deepest_m, row[0].depth_m);
    EXPECT_GE(row[0].depth_m, 0);
  }
  EXPECT_GT(contacts, 10U);
  EXPECT_GT(deepest_m, 0.004);
  EXPECT_LT(deepest_m, 0.012);
}

}  // namespace
}  // namespace vestige
