#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <numbers>
#include <vector>

#include "analysis/stress/stress_families.hpp"
#include "analysis/stress/triangle_scene.hpp"

namespace vestige {

namespace {

StressScene vertex(StressOrder order) {
  TriangleScene scene(order, {1, order.magnitude});
  return scene.build([&] { return scene.any_fan(); },
                     [&](const Fan& fan) { return scene.through(scene.any_corner(fan)); });
}

StressScene edge(StressOrder order) {
  TriangleScene scene(order, {1, order.magnitude});
  return scene.build([&] { return scene.any_fan(); },
                     [&](const Fan& fan) { return scene.through(scene.any_edge(fan)); });
}

StressScene coplanar(StressOrder order) {
  TriangleScene scene(order, {1, order.magnitude});
  LatticePlane plane = {};
  const auto make_fan = [&] {
    plane = lattice_plane(scene.random());
    return scene.flat_fan(plane);
  };
  return scene.build(make_fan, [&](const Fan& fan) { return scene.line_in(plane, scene.any_corner(fan)); });
}

StressScene grazing(StressOrder order) {
  TriangleScene scene(order);
  const double slope = std::tan(order.magnitude * std::numbers::pi / 180);
  return scene.build([&] { return scene.any_fan(); },
                     [&](const Fan& fan) {
                       const auto [a, b, c] = corners_of_fan(scene.random().index(kFanTriangles));
                       const Target target = TriangleScene::mixed(fan, a, b, c, 0.3, 0.3);
                       const glm::dvec3 across = glm::normalize(fan.now[b] - fan.now[a]);
                       const glm::dvec3 normal = glm::normalize(glm::cross(across, fan.now[c] - fan.now[a]));
                       return scene.through(target, scene.random().uniform(0.05, 1) * (across + slope * normal));
                     });
}

/// Needles share the corner at their thin end. Caps have that corner almost on the edge that faces it.
StressScene needle(StressOrder order) {
  TriangleScene scene(order);
  const auto make_fan = [&] {
    FanCorners corners = {};
    const bool cap = scene.random().index(2) == 0;
    const glm::dvec3 along = 0.5 * scene.random().direction();
    const glm::dvec3 aside = glm::normalize(glm::cross(along, glm::dvec3(0.6, -0.48, 0.64)));
    for (std::size_t i = 1; i < corners.size(); ++i) {
      const double step = static_cast<double>(i) - 1;
      const double side = cap && i % 2 == 0 ? -1 : 1;
      corners[i] = side * along + order.magnitude * step * aside;
    }
    return scene.placed(corners, reach(scene.random(), 0, 0.2), 0.01 * order.magnitude);
  };
  return scene.build(make_fan, [&](const Fan& fan) { return scene.through(scene.any_target(fan)); });
}

StressScene zero_length(StressOrder order) {
  TriangleScene scene(order);
  const auto make_line = [&](const Fan& fan) {
    const glm::dvec3 place = scene.nudged(as_floats(scene.place_of(scene.any_target(fan))), order.magnitude);
    return Line{place, place};
  };
  return scene.build([&] { return scene.any_fan(); }, make_line);
}

StressScene endpoint(StressOrder order) {
  TriangleScene scene(order, {1, order.magnitude});
  return scene.build([&] { return scene.any_fan(); },
                     [&](const Fan& fan) { return scene.ending_at(scene.any_target(fan)); });
}

StressScene ulp(StressOrder order) {
  TriangleScene scene(order);
  LatticePlane plane = {};
  bool flat = false;
  const auto make_fan = [&] {
    flat = scene.random().index(2) == 0;
    plane = lattice_plane(scene.random());
    return flat ? scene.flat_fan(plane) : scene.any_fan();
  };
  const auto make_line = [&](const Fan& fan) {
    Line line = flat ? scene.line_in(plane, scene.any_corner(fan)) : scene.mixture(fan);
    glm::dvec3& end = scene.random().index(2) == 0 ? line.start : line.end;
    end = scene.nudged(end, order.magnitude);
    return line;
  };
  return scene.build(make_fan, make_line);
}

StressScene offset(StressOrder order) {
  TriangleScene scene(order, {1, order.magnitude});
  return scene.build([&] { return scene.any_fan(); }, [&](const Fan& fan) { return scene.mixture(fan); });
}

StressScene scale(StressOrder order) {
  TriangleScene scene(order, {order.magnitude, 0});
  return scene.build([&] { return scene.any_fan(); }, [&](const Fan& fan) { return scene.mixture(fan); });
}

StressScene degenerate(StressOrder order) {
  TriangleScene scene(order);
  const auto make_fan = [&] {
    Fan fan = scene.flat_fan({{1, 0, 0}, {0, 1, 0}});
    flatten(fan.before, order.magnitude);
    flatten(fan.now, order.magnitude);
    return fan;
  };
  return scene.build(make_fan, [&](const Fan& fan) { return scene.mixture(fan); });
}

/// Aims exactly at the borders between texels, which are lines within each triangle, or at places a few ulps beside
/// them.
StressScene texel_border(StressOrder order) {
  TriangleScene scene(order);
  const auto make_line = [&](const Fan& fan) {
    const auto [a, b, c] = corners_of_fan(scene.random().index(kFanTriangles));
    const std::size_t u = scene.random().index(kTexels);
    const std::size_t v = scene.random().index(kTexels - u);
    const auto part = [](std::size_t texel) { return static_cast<double>(texel) / kTexels; };
    const Target target = TriangleScene::mixed(fan, a, b, c, part(u), part(v));
    Line line = scene.through(target, {0, 0, 0.25});
    line.start = scene.nudged(line.start, order.magnitude);
    return line;
  };
  return scene.build([&] { return scene.flat_fan({{1, 0, 0}, {0, 1, 0}}); }, make_line);
}

constexpr std::array kOffsets_m = {0.0, 10.0, 1000.0};
constexpr std::array kFarOffsets_m = {0.0, 10.0, 1000.0, 1e5, 1e7};
constexpr std::array kAnglesInDegrees = {1.0, 0.1, 0.01, 0.001};
constexpr std::array kWidths = {1e-2, 1e-4, 1e-6};
constexpr std::array kUlps = {0.0, 1.0};
constexpr std::array kMoreUlps = {1.0, 2.0, 4.0};
constexpr std::array kScales_m = {1e-6, 1e-3, 1.0, 1e3, 1e6};
constexpr std::array kDimensions = {0.0, 1.0};
constexpr std::array kDenormal_m = {1e-38, 1e-40, 1e-43};

constexpr const char* kFromOrigin = "metres from the origin, as fp32 coordinates";
constexpr const char* kNudge = "units in the last place by which one coordinate is moved";

constexpr StressBody kLoose = StressBody::kLoose;
constexpr std::array<StressFamily, 13> kTriangleFamilies = {{
    {"vertex", "", "Segments through a corner that several triangles share.", kFromOrigin, kOffsets_m, kLoose, vertex},
    {"edge", "", "Segments through an edge that two triangles share.", kFromOrigin, kOffsets_m, kLoose, edge},
    {"coplanar", "", "Segments in the plane of the triangles.", kFromOrigin, kOffsets_m, kLoose, coplanar},
    {"grazing", "", "Segments that cross a triangle at a small angle.", "degrees", kAnglesInDegrees, kLoose, grazing},
    {"needle", "", "Segments at long thin triangles and at flat caps.", "width, metres, of triangles about 1 m long",
     kWidths, kLoose, needle},
    {"zero_length", "", "Colliders that rest on the surface.", kNudge, kUlps, kLoose, zero_length},
    {"endpoint", "", "Segments that begin or end on the surface.", kFromOrigin, kOffsets_m, kLoose, endpoint},
    {"ulp", "", "Segments aimed as above, with one end moved slightly.", kNudge, kMoreUlps, kLoose, ulp},
    {"offset", "", "Segments at corners, edges and faces far from the origin.", kFromOrigin, kFarOffsets_m, kLoose,
     offset},
    {"scale", "", "The same cases at other sizes.", "size of the triangles, metres", kScales_m, kLoose, scale},
    {"degenerate", "", "Triangles without area.", "0: all corners in one point, 1: on one line", kDimensions, kLoose,
     degenerate},
    {"denormal", "", "The same cases among the smallest numbers of fp32.", "size of the triangles, metres", kDenormal_m,
     kLoose, scale},
    {"texel_border", "", "Contacts on the border between two texels of different actuators.", kNudge, kUlps, kLoose,
     texel_border},
}};

}  // namespace

std::span<const StressFamily> triangle_families() {
  return kTriangleFamilies;
}

}  // namespace vestige
