#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <stdexcept>
#include <vector>

#include "analysis/stress/stress_families.hpp"
#include "detector/algebra/winding_number.hpp"
#include "detector/skinning.hpp"

namespace vestige {

namespace {

constexpr std::size_t kSegmentsAtOnce = 1024;
constexpr std::size_t kInsidePoints = 256;
constexpr std::size_t kMostTries = 100'000;

enum class Aim { kVertex, kEdge };
/// Where the offset is applied: to the doubles of pose and colliders, from which `FrameBuilder` subtracts it again, or
/// to the fp32 values.
enum class Where { kDoubleOrigin, kFloat };

/// The skin of the resting avatar, in the coordinates that detectors get, and points inside of it.
class ClosedSkin {
 public:
  ClosedSkin(const Avatar& avatar, std::span<const SkinMatrix> palette, Random& random) : avatar_(avatar) {
    skin_vertices(avatar, palette, vertices_);
    low_ = high_ = vertices_.front();
    for (const glm::vec3& vertex : vertices_) {
      low_ = glm::min(low_, vertex);
      high_ = glm::max(high_, vertex);
    }
    inside_.reserve(kInsidePoints);
    for (std::size_t i = 0; i < kMostTries && inside_.size() < kInsidePoints; ++i) {
      glm::vec3 point;
      for (int axis = 0; axis < 3; ++axis) point[axis] = static_cast<float>(random.uniform(low_[axis], high_[axis]));
      if (winding_number(vertices_, avatar.triangles, point).value_or(0) != 0) inside_.push_back(point);
    }
    if (inside_.empty()) throw std::logic_error("the avatar has no inside");
  }

  /// Returns a segment from a point inside to a point outside, through a corner of the skin or the middle of an edge,
  /// as near as fp32 allows.
  Segment segment(std::uint32_t column, Aim aim, Random& random) const {
    const glm::uvec3& triangle = avatar_.triangles[random.index(avatar_.triangles.size())];
    const auto corner = static_cast<int>(random.index(3));
    glm::dvec3 target(vertices_[triangle[corner]]);
    if (aim == Aim::kEdge) target = (target + glm::dvec3(vertices_[triangle[(corner + 1) % 3]])) / 2.0;
    for (;;) {
      const glm::vec3 start = inside_[random.index(inside_.size())];
      const glm::dvec3 way = target - glm::dvec3(start);
      if (glm::length(way) < kLeastWay_m) continue;
      // Scaled by powers of two, so that the target stays on the way if fp32 has room for it.
      for (double reach = 2; reach < kMostReach; reach *= 2) {
        const glm::vec3 end(glm::dvec3(start) + reach * way);
        if (is_outside(end)) return {column, start, end};
      }
    }
  }

 private:
  static constexpr double kLeastWay_m = 1e-3;
  static constexpr double kMostReach = 65536;

  bool is_outside(const glm::vec3& point) const {
    for (int axis = 0; axis < 3; ++axis)
      if (point[axis] < low_[axis] || point[axis] > high_[axis]) return true;
    return false;
  }

  const Avatar& avatar_;
  std::vector<glm::vec3> vertices_;
  glm::vec3 low_ = glm::vec3(0);
  glm::vec3 high_ = glm::vec3(0);
  std::vector<glm::vec3> inside_;
};

std::vector<Segment> segments_of(const ClosedSkin& skin, std::size_t count, Aim aim, Random& random) {
  std::vector<Segment> segments;
  segments.reserve(count);
  for (std::uint32_t column = 0; column < count; ++column) segments.push_back(skin.segment(column, aim, random));
  return segments;
}

/// Frames through `FrameBuilder`: the avatar and the colliders stand far out in the world.
void add_world_frames(const StressOrder& order, Aim aim, Random& random, std::vector<DetectorFrame>& frames) {
  const Avatar& avatar = order.subject->avatar;
  TraceFrame before;
  before.poses.front() = rest_pose(avatar);
  before.poses.front().origin_m = glm::dvec3(order.magnitude);
  const DetectorFrame first = FrameBuilder(avatar, {}, Method::kStatic).next(before);
  const ClosedSkin skin(avatar, first.palette, random);
  for (std::size_t done = 0; done < order.cases; done += kSegmentsAtOnce) {
    const std::size_t count = std::min(kSegmentsAtOnce, order.cases - done);
    before.colliders.clear();
    TraceFrame now = before;
    now.index = 1;
    now.time_ns = 10'000'000;
    for (const Segment& segment : segments_of(skin, count, aim, random)) {
      before.colliders.push_back({segment.column, first.origin_m + glm::dvec3(segment.start)});
      now.colliders.push_back({segment.column, first.origin_m + glm::dvec3(segment.end)});
    }
    frames.push_back(frame_after(before, now, avatar, count, order.method));
  }
}

/// Frames whose fp32 coordinates are themselves far from the origin. The skin is coarser there, but still closed.
void add_float_frames(const StressOrder& order, Aim aim, Random& random, std::vector<DetectorFrame>& frames) {
  const Avatar& avatar = order.subject->avatar;
  DetectorFrame frame;
  frame.index = 1;
  frame.time_s = frame.duration_s = 0.01;
  std::vector<glm::dmat4> world;
  world_matrices(avatar, rest_pose(avatar), world);
  build_palette(avatar, world, glm::dvec3(order.magnitude), frame.palette);
  frame.palette_before = frame.palette;
  const ClosedSkin skin(avatar, frame.palette, random);
  for (std::size_t done = 0; done < order.cases; done += kSegmentsAtOnce) {
    frame.columns = std::min(kSegmentsAtOnce, order.cases - done);
    frame.segments = segments_of(skin, frame.columns, aim, random);
    frames.push_back(frame);
  }
}

template <Aim kAim, Where kWhere>
StressScene watertight(StressOrder order) {
  StressScene scene;
  scene.judge = StressJudge::kMustHit;
  scene.frames.reserve(order.cases / kSegmentsAtOnce + 1);
  Random random = order.random;
  if (kWhere == Where::kDoubleOrigin) {
    add_world_frames(order, kAim, random, scene.frames);
  } else {
    add_float_frames(order, kAim, random, scene.frames);
  }
  return scene;
}

constexpr std::array kWorld_m = {0.0, 10.0, 1000.0, 1e5, 1e7};
constexpr std::array kFloat_m = {10.0, 1000.0};

constexpr const char* kMeaning =
    "Segments from inside the avatar in rest pose (the exact winding number is not 0) to outside: each must hit.";
constexpr const char* kInDouble = "metres from the origin, of avatar and colliders in double coordinates";
constexpr const char* kInFloat = "metres from the origin, as fp32 coordinates";

constexpr std::array<StressFamily, 4> kWatertightFamilies = {{
    {"watertight", "vertex", kMeaning, kInDouble, kWorld_m, StressBody::kMannequin,
     watertight<Aim::kVertex, Where::kDoubleOrigin>},
    {"watertight", "edge", kMeaning, kInDouble, kWorld_m, StressBody::kMannequin,
     watertight<Aim::kEdge, Where::kDoubleOrigin>},
    {"watertight", "vertex, raw fp32", kMeaning, kInFloat, kFloat_m, StressBody::kMannequin,
     watertight<Aim::kVertex, Where::kFloat>},
    {"watertight", "edge, raw fp32", kMeaning, kInFloat, kFloat_m, StressBody::kMannequin,
     watertight<Aim::kEdge, Where::kFloat>},
}};

}  // namespace

std::span<const StressFamily> watertight_families() {
  return kWatertightFamilies;
}

}  // namespace vestige
