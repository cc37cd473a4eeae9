#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <numbers>
#include <utility>
#include <vector>

#include "analysis/stress/loose_triangles.hpp"
#include "analysis/stress/stress_scene.hpp"

namespace vestige {

inline constexpr std::size_t kSegmentsPerFrame = 64;

/// A closed fan of triangles around corner 0. The other corners are its rim. In metres; all coordinates are floats.
using FanCorners = std::array<glm::dvec3, kFanTriangles + 1>;

struct Fan {
  FanCorners before = {};
  FanCorners now = {};
};

inline std::array<std::size_t, 3> corners_of_fan(std::size_t triangle) {
  return {0, 1 + triangle, 1 + (triangle + 1) % kFanTriangles};
}

/// A place on the fan, in both frames.
struct Target {
  glm::dvec3 before;
  glm::dvec3 now;
};

/// The way of a point, or of a sphere's centre.
struct Line {
  glm::dvec3 start;
  glm::dvec3 end;
  double radius = 0;
};

inline glm::dvec3 as_floats(const glm::dvec3& v) {
  return glm::dvec3(glm::vec3(v));
}

inline double on_grid(double value, double step) {
  return std::round(value / step) * step;
}

inline glm::dvec3 on_grid(const glm::dvec3& v, double step) {
  return {on_grid(v.x, step), on_grid(v.y, step), on_grid(v.z, step)};
}

/// The place and the size of the scene. Half of the fans lie on a grid so coarse that sums and halves of their
/// coordinates are floats too, so that aims are hit exactly.
struct StressStage {
  double size_m = 1;
  double offset_m = 0;

  double grid_m() const { return std::exp2(std::ceil(std::log2(offset_m + size_m)) - 20); }
};

/// Any direction, of length `low` to `high`.
inline glm::dvec3 reach(Random& random, double low, double high) {
  return random.uniform(low, high) * random.direction();
}

/// Two vectors that span a plane, with small whole coordinates.
struct LatticePlane {
  glm::dvec3 first;
  glm::dvec3 second;
};

inline LatticePlane lattice_plane(Random& random) {
  const auto whole = [&] { return static_cast<double>(random.index(7)) - 3; };
  for (;;) {
    const LatticePlane plane = {{whole(), whole(), whole()}, {whole(), whole(), whole()}};
    if (glm::cross(plane.first, plane.second) != glm::dvec3(0)) return plane;
  }
}

/// The properties of a family's bodies, and how its segments run.
class TriangleScene {
 public:
  explicit TriangleScene(StressOrder order, StressStage stage = {})
      : order_(order), random_(order_.random), stage_(stage) {}

  template <typename MakeFan, typename MakeLine>
  StressScene build(MakeFan&& make_fan, MakeLine&& make_line) {
    StressScene scene;
    scene.frames.reserve(order_.cases / kSegmentsPerFrame + 1);
    for (std::size_t done = 0; done < order_.cases;) {
      snapped_ = random_.index(2) == 0;
      const Fan fan = make_fan();
      const std::size_t count = std::min(kSegmentsPerFrame, order_.cases - done);
      std::vector<Segment> segments;
      segments.reserve(count);
      for (std::size_t i = 0; i < count; ++i) {
        const Line line = make_line(fan);
        segments.push_back({static_cast<std::uint32_t>(i), glm::vec3(line.start), glm::vec3(line.end),
                            static_cast<float>(line.radius)});
      }
      scene.frames.push_back(loose_frame(triangles(fan.before), triangles(fan.now), std::move(segments)));
      done += count;
    }
    return scene;
  }

  Random& random() { return random_; }

  /// An uneven fan about as large as the stage, in any direction, that moves and bends a little.
  Fan any_fan() {
    const glm::dvec3 normal = random_.direction();
    const glm::dvec3 first = glm::normalize(glm::cross(normal, glm::dvec3(0.6, -0.48, 0.64)));
    const glm::dvec3 second = glm::cross(normal, first);
    FanCorners corners = {};
    for (std::size_t i = 1; i < corners.size(); ++i) {
      const double angle = 2 * std::numbers::pi * (static_cast<double>(i) + random_.uniform(-0.3, 0.3)) / kFanTriangles;
      corners[i] = random_.uniform(0.2, 0.5) * (std::cos(angle) * first + std::sin(angle) * second) +
                   random_.uniform(-0.1, 0.1) * normal;
    }
    return placed(corners, reach(random_, 0, 0.2), 0.05);
  }

  /// A fan in one plane, exactly, that moves within it.
  Fan flat_fan(const LatticePlane& plane) {
    const auto in_plane = [&](double most) {
      return step_m() * (std::round(random_.uniform(-most, most)) * plane.first +
                         std::round(random_.uniform(-most, most)) * plane.second);
    };
    const glm::dvec3 middle = on_grid(glm::dvec3(stage_.offset_m) + stage_.size_m * reach(random_, 0, 0.3), step_m());
    FanCorners corners = {};
    for (std::size_t i = 1; i < corners.size(); ++i) {
      const double angle = 2 * std::numbers::pi * static_cast<double>(i) / kFanTriangles;
      const double length = kSteps * random_.uniform(0.5, 1);
      corners[i] = step_m() * (std::round(length * std::cos(angle)) * plane.first +
                               std::round(length * std::sin(angle)) * plane.second);
    }
    const glm::dvec3 moved = in_plane(kSteps / 4);
    Fan fan;
    for (std::size_t i = 0; i < corners.size(); ++i) {
      fan.now[i] = as_floats(middle + corners[i]);
      fan.before[i] = as_floats(middle + corners[i] + moved);
    }
    return fan;
  }

  /// A way within the plane of a flat fan.
  Line line_in(const LatticePlane& plane, const Target& target) {
    const auto steps = [&] { return std::round(random_.uniform(-kSteps, kSteps)); };
    return through(target, step_m() * (steps() * plane.first + steps() * plane.second));
  }

  /// `shape` (size 1, around 0) on the stage; `moved` since the frame before, and each corner `bent` further.
  Fan placed(const FanCorners& shape, const glm::dvec3& moved, double bent) {
    const glm::dvec3 middle = glm::dvec3(stage_.offset_m) + stage_.size_m * reach(random_, 0, 0.3);
    Fan fan;
    for (std::size_t i = 0; i < shape.size(); ++i) {
      const glm::dvec3 now = middle + stage_.size_m * shape[i];
      fan.now[i] = snap(now);
      fan.before[i] = snap(now + stage_.size_m * (moved + reach(random_, 0, bent)));
    }
    return fan;
  }

  /// A random corner, a point on a random edge, or one within a random triangle.
  static Target corner(const Fan& fan, std::size_t number) { return {fan.before[number], fan.now[number]}; }
  Target any_corner(const Fan& fan) { return corner(fan, random_.index(2) == 0 ? 0 : random_.index(fan.now.size())); }
  Target any_edge(const Fan& fan) {
    const auto corners = corners_of_fan(random_.index(kFanTriangles));
    const std::size_t from = random_.index(3);
    const double part = random_.index(2) == 0 ? 0.5 : random_.uniform(0, 1);
    return mixed(fan, corners[from], corners[(from + 1) % 3], corners[from], part, 0);
  }
  Target any_face(const Fan& fan) {
    const auto corners = corners_of_fan(random_.index(kFanTriangles));
    const double u = random_.uniform(0, 1);
    return mixed(fan, corners[0], corners[1], corners[2], u, random_.uniform(0, 1 - u));
  }
  Target any_target(const Fan& fan) {
    const std::size_t kind = random_.index(3);
    return kind == 0 ? any_corner(fan) : (kind == 1 ? any_edge(fan) : any_face(fan));
  }

  /// The point u, v of a triangle with these corners.
  static Target mixed(const Fan& fan, std::size_t a, std::size_t b, std::size_t c, double u, double v) {
    const auto at = [&](const FanCorners& corners) {
      return corners[a] + u * (corners[b] - corners[a]) + v * (corners[c] - corners[a]);
    };
    return {at(fan.before), at(fan.now)};
  }

  glm::dvec3 place_of(const Target& target) const {
    return order_.method == Method::kCcd ? (target.before + target.now) / 2.0 : target.now;
  }

  /// Returns a way that is at the target halfway.
  Line through(const Target& target, const glm::dvec3& half_way) {
    const glm::dvec3 half = snapped_ ? on_grid(half_way, 2 * stage_.grid_m()) : half_way;
    return {place_of(target) - half, place_of(target) + half};
  }
  Line through(const Target& target) { return through(target, stage_.size_m * reach(random_, 0.05, 1)); }

  /// Returns a way that begins or ends at the target. A triangle that moves is there where it was before at the
  /// beginning.
  Line ending_at(const Target& target) {
    const glm::dvec3 way = stage_.size_m * reach(random_, 0.05, 1);
    const bool begins = random_.index(2) == 0;
    const glm::dvec3 end = as_floats(begins && is_ccd() ? target.before : target.now);
    return begins ? Line{end, end + way} : Line{end + way, end};
  }

  /// Returns a way through a corner, an edge or a face, or one that ends there.
  Line mixture(const Fan& fan) {
    const Target target = any_target(fan);
    return random_.index(4) == 0 ? ending_at(target) : through(target);
  }

  /// One coordinate moved by so many units in its last place, up or down.
  glm::dvec3 nudged(const glm::dvec3& point, double units) {
    glm::vec3 place(point);
    const auto axis = static_cast<int>(random_.index(3));
    const float towards = random_.index(2) == 0 ? -kInfinity : kInfinity;
    const int steps = static_cast<int>(units);
    for (int i = 0; i < steps; ++i) place[axis] = std::nextafter(place[axis], towards);
    return glm::dvec3(place);
  }

  bool is_ccd() const { return order_.method == Method::kCcd; }

 private:
  static constexpr float kInfinity = std::numeric_limits<float>::infinity();
  static constexpr double kSteps = 64;

  /// For lattices: flat fans stay within the numbers that are floats.
  double step_m() const { return std::max(stage_.grid_m() * 4, std::exp2(std::floor(std::log2(stage_.size_m))) / 512); }

  glm::dvec3 snap(const glm::dvec3& v) const { return as_floats(snapped_ ? on_grid(v, 4 * stage_.grid_m()) : v); }

  static std::vector<LooseTriangle> triangles(const FanCorners& corners) {
    std::vector<LooseTriangle> list;
    list.reserve(kFanTriangles);
    for (std::size_t i = 0; i < kFanTriangles; ++i) {
      const auto [a, b, c] = corners_of_fan(i);
      list.push_back({glm::vec3(corners[a]), glm::vec3(corners[b]), glm::vec3(corners[c])});
    }
    return list;
  }

  StressOrder order_;
  Random random_;
  StressStage stage_;
  bool snapped_ = false;
};

/// Moves all corners of a fan to its hub (0 dimensions), or onto a line through it (1).
inline void flatten(FanCorners& corners, double dimensions) {
  const glm::dvec3 hub = corners.front();
  for (glm::dvec3& corner : corners) corner = dimensions == 0 ? hub : glm::dvec3(corner.x, hub.y, hub.z);
}

}  // namespace vestige
