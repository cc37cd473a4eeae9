#include <array>
#include <cmath>
#include <glm/geometric.hpp>

#include "analysis/stress/stress_families.hpp"
#include "analysis/stress/triangle_scene.hpp"

namespace vestige {

namespace {

/// A direction across another one.
glm::dvec3 across(Random& random, const glm::dvec3& direction) {
  for (;;) {
    const glm::dvec3 sideways = glm::cross(direction, random.direction());
    if (const double length = glm::length(sideways); length > 0.1) return sideways / length;
  }
}

/// Spheres that pass a corner, an edge or a face at the distance of their radius, as nearly as floats can.
StressScene sphere_tangent(StressOrder order) {
  TriangleScene scene(order);
  return scene.build([&] { return scene.any_fan(); },
                     [&](const Fan& fan) {
                       const double radius = scene.random().uniform(0.02, 0.5);
                       const Target target = scene.any_target(fan);
                       const glm::dvec3 from = scene.random().direction();
                       const glm::dvec3 middle = scene.nudged(scene.place_of(target) + radius * from, order.magnitude);
                       const glm::dvec3 half = scene.random().uniform(0.05, 1) * across(scene.random(), from);
                       return Line{middle - half, middle + half, radius};
                     });
}

/// Spheres at rest, which touch or do not.
StressScene sphere_rest(StressOrder order) {
  TriangleScene scene(order);
  return scene.build([&] { return scene.any_fan(); },
                     [&](const Fan& fan) {
                       const double distance = order.magnitude * scene.random().uniform(0, 1.2);
                       const Target target = scene.any_target(fan);
                       const glm::dvec3 place = scene.place_of(target) + distance * scene.random().direction();
                       return Line{place, place, order.magnitude};
                     });
}

/// Spheres at rest that are equally far from several triangles: above the corner or the edge that these share.
StressScene sphere_tie(StressOrder order) {
  TriangleScene scene(order);
  return scene.build(
      [&] {
        return scene.flat_fan({{1, 0, 0}, {0, 1, 0}});
      },
      [&](const Fan& fan) {
        const Target target = scene.random().index(2) == 0 ? TriangleScene::corner(fan, 0) : scene.any_edge(fan);
        const glm::dvec3 above(0, 0, scene.random().uniform(-0.25, 0.25));
        const glm::dvec3 place = scene.nudged(as_floats(target.now + above), order.magnitude);
        return Line{place, place, 0.25};
      });
}

Line with_radius(Line line, double radius) {
  line.radius = radius;
  return line;
}

/// Ways through corners, edges and faces, and ones that end there, of spheres with a radius from `low` to `high`.
StressScene sphere_mixture(const StressOrder& order, const StressStage& stage, double low, double high) {
  TriangleScene scene(order, stage);
  return scene.build([&] { return scene.any_fan(); },
                     [&](const Fan& fan) {
                       const Line line = scene.mixture(fan);
                       return with_radius(line, scene.random().uniform(low, high));
                     });
}

StressScene sphere_size(StressOrder order) {
  return sphere_mixture(order, {}, order.magnitude, order.magnitude);
}

StressScene sphere_offset(StressOrder order) {
  return sphere_mixture(order, {1, order.magnitude}, 0, 0.5);
}

StressScene sphere_degenerate(StressOrder order) {
  TriangleScene scene(order);
  const auto make_fan = [&] {
    Fan fan = scene.flat_fan({{1, 0, 0}, {0, 1, 0}});
    // Of moving triangles, some lose their area only on the way.
    for (FanCorners* corners : {&fan.before, &fan.now})
      if (!scene.is_ccd() || scene.random().index(2) != 0) flatten(*corners, order.magnitude);
    return fan;
  };
  return scene.build(make_fan, [&](const Fan& fan) {
    return with_radius(scene.through(scene.any_target(fan)), scene.random().uniform(0.02, 0.5));
  });
}

constexpr std::array kNudges = {0.0, 1.0};
constexpr std::array kRadii_m = {1e-3, 0.1, 10.0};
/// From the smallest number of fp32 to far larger than the triangles.
constexpr std::array kSizes_m = {1e-45, 1e-38, 1e-10, 1e-3, 10.0};
constexpr std::array kFar_m = {0.0, 10.0, 1000.0, 1e5};
constexpr std::array kShapes = {0.0, 1.0};

constexpr const char* kMoved = "units in the last place by which one coordinate is moved";
constexpr const char* kRadius = "radius, metres, of triangles about 1 m large";

constexpr StressBody kFans = StressBody::kLoose;
constexpr std::array<StressFamily, 6> kSphereFamilies = {{
    {"sphere_tangent", "", "Spheres that pass a corner, an edge or a face at the distance of their radius.", kMoved,
     kNudges, kFans, sphere_tangent, true},
    {"sphere_rest", "", "Spheres that rest on the surface or just above it.", kRadius, kRadii_m, kFans, sphere_rest,
     true},
    {"sphere_tie", "", "Spheres that rest equally near to several triangles.", kMoved, kNudges, kFans, sphere_tie,
     true},
    {"sphere_size", "", "Spheres on their way through corners, edges and faces.", kRadius, kSizes_m, kFans, sphere_size,
     true},
    {"sphere_offset", "", "Spheres of any size up to the triangles' on such ways, far from the origin.",
     "metres from the origin, as fp32 coordinates", kFar_m, kFans, sphere_offset, true},
    {"sphere_degenerate", "", "Spheres at triangles without area.", "0: all corners in one point, 1: on one line",
     kShapes, kFans, sphere_degenerate, true},
}};

}  // namespace

std::span<const StressFamily> sphere_families() {
  return kSphereFamilies;
}

}  // namespace vestige
