#include "detector/detectors/sphere_finder.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <utility>

#include "detector/nearest_in_triangle.hpp"

namespace vestige {

namespace {

/// Some 50 MB of pairs.
constexpr std::size_t kMostWaiting = std::size_t{1} << 18;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// With fewer triangles of a meshlet, bounds for all of them cost more than they save.
constexpr int kFewPairs = 3;

/// For the squares of lengths, whose few roundings err by less.
constexpr double kRoundedDown = 1 - 0x1p-40;

double squared_distance_to_corners(const glm::dvec3& point, const Corners& triangle) {
  const auto squared = [&](const glm::dvec3& corner) { return glm::dot(corner - point, corner - point); };
  return std::min({squared(triangle.a), squared(triangle.b), squared(triangle.c)});
}

double squared_distance_to_box_of(const glm::dvec3& point, const Corners& triangle) {
  return squared_distance_to_box(point, glm::min(glm::min(triangle.a, triangle.b), triangle.c),
                                 glm::max(glm::max(triangle.a, triangle.b), triangle.c));
}

}  // namespace

bool SphereFinder::touches_at_start(const StartDistance& distance, double radius) {
  bool exact_arithmetic = false;
  const bool touches = StartDistance::compare(distance, radius, exact_arithmetic) <= 0;
  if (exact_arithmetic) ++counts_.unsure;
  return touches;
}

/// Compares by t, then by the exact squared distance at the exact first time, then by the triangle's number.
bool SphereFinder::is_better(const Best& candidate, const Best& best) {
  if (candidate.touch.t != best.touch.t) return candidate.touch.t < best.touch.t;
  int order = 0;  // both at the radius
  bool exact_arithmetic = false;
  const double radius = candidate.pair.sphere.radius;
  if (candidate.start && best.start)
    order = StartDistance::compare(*candidate.start, *best.start, exact_arithmetic);
  else if (candidate.start)
    order = StartDistance::compare(*candidate.start, radius, exact_arithmetic);
  else if (best.start)
    order = -StartDistance::compare(*best.start, radius, exact_arithmetic);
  if (exact_arithmetic) ++counts_.unsure;
  return order != 0 ? order < 0 : candidate.pair.triangle < best.pair.triangle;
}

bool SphereFinder::is_on_surface(const DetectorFrame& frame, const SpherePair& pair, const FirstTouch& touch) const {
  return surface_ == Surface::kAll || describe_touch(avatar_, map_, pair, touch, frame.duration_s).actuator != 0;
}

std::optional<SphereFinder::Best>& SphereFinder::best_of(std::uint32_t column) {
  if (best_.size() <= column) best_.resize(column + 1);
  return best_[column];
}

/// Returns whether no later touch can win any more. A distance below the radius cannot tie with one either, whose t may
/// be rounded to 0.
bool SphereFinder::surely_touches_at_start(std::uint32_t column) {
  const std::optional<Best>& best = best_of(column);
  return best && best->start && best->start->range().high < best->pair.sphere.radius;
}

void SphereFinder::take(const DetectorFrame& frame, std::uint32_t column, const Best& candidate) {
  std::optional<Best>& best = best_of(column);
  if (best && !is_better(candidate, *best)) return;
  if (!is_on_surface(frame, candidate.pair, candidate.touch)) return;
  if (!best) columns_.push_back(column);
  best = candidate;
}

/// Returns at most how far the best triangle so far is at the start; infinity if none touches there.
double SphereFinder::best_at_most(std::uint32_t column) {
  const std::optional<Best>& best = best_of(column);
  return best && best->start ? best->start->range().high : kInfinity;
}

/// Returns whether a pair cannot win, because its triangle is farther from the centre at the start than the best one so
/// far. The bounds are of squared distances at the start, to the triangle and to its nearest corner. Leaves doubtful
/// pairs to the caller. Counts the pair if it touches at the start.
bool SphereFinder::surely_loses(double best_at_most, double radius, double at_least, double to_a_corner_at_most) {
  if (at_least <= best_at_most * best_at_most) return false;
  if (to_a_corner_at_most <= radius * radius) {
    ++counts_.meeting;
    return true;
  }
  return at_least > radius * radius && best_at_most < radius;
}

void SphereFinder::offer(const DetectorFrame& frame, const MeshletPlaces& meshlet, const Segment& segment,
                         std::uint32_t bits) {
  if (method_ == Method::kCarried || std::popcount(bits) < kFewPairs) {
    for (; bits != 0; bits &= bits - 1) {
      const auto i = static_cast<std::size_t>(std::countr_zero(bits));
      offer(frame, meshlet.at(i), segment, meshlet.triangles[i]);
    }
    return;
  }
  bounds_.find(meshlet.before, segment.start);
  const std::uint32_t apart = bounds_.compare(kInfinity, segment.radius_m).apart;
  // The nearest first: then most others surely lose.
  for (bits = rest_of(segment, bits); bits != 0; bits = rest_of(segment, bits)) {
    const std::size_t i = bounds_.nearest(bits);
    bits &= ~(1U << i);
    const SpherePair pair = sphere_pair(segment, meshlet.at(i), meshlet.triangles[i], method_);
    if (((apart >> i) & 1) != 0)
      wait(frame, segment.column, pair);
    else
      offer(frame, segment.column, pair);
  }
}

/// Returns the triangles of `bounds_` that may still win, and counts those of the others that touch at the start.
std::uint32_t SphereFinder::rest_of(const Segment& segment, std::uint32_t bits) {
  const double limit = best_at_most(segment.column);
  if (std::isinf(limit) || bits == 0) return bits;
  const StartMasks masks = bounds_.compare(limit, segment.radius_m);
  const std::uint32_t touching = bits & masks.farther & masks.corner_within;
  counts_.meeting += static_cast<std::uint64_t>(std::popcount(touching));
  bits &= ~touching;
  return limit < segment.radius_m ? bits & ~(masks.farther & masks.apart) : bits;
}

void SphereFinder::offer(const DetectorFrame& frame, const MovingCorners& corners, const Segment& segment,
                         std::uint32_t triangle) {
  const SpherePair pair = sphere_pair(segment, corners, triangle, method_);
  const glm::dvec3& centre = pair.sphere.centre.start;
  const double limit = best_at_most(segment.column);
  if (std::isfinite(limit) &&
      surely_loses(limit, pair.sphere.radius, kRoundedDown * squared_distance_to_box_of(centre, pair.before),
                   squared_distance_to_corners(centre, pair.before) / kRoundedDown))
    return;
  offer(frame, segment.column, pair);
}

void SphereFinder::offer(const DetectorFrame& frame, std::uint32_t column, const SpherePair& pair) {
  const StartDistance distance(pair.sphere.centre.start, pair.before);
  if (!touches_at_start(distance, pair.sphere.radius)) {
    wait(frame, column, pair);
    return;
  }
  ++counts_.meeting;
  // The side is found later, for the winner only.
  take(frame, column, {pair, {0, 0, true}, distance});
}

/// Keeps a pair that does not touch at the start, unless that rules it out.
void SphereFinder::wait(const DetectorFrame& frame, std::uint32_t column, const SpherePair& pair) {
  if (surely_touches_at_start(column)) return;
  if (waiting_.size() == kMostWaiting) make_room(frame);
  waiting_.push_back({column, pair});
}

/// Forgets the pairs that no longer matter. If most still do, decides them.
void SphereFinder::make_room(const DetectorFrame& frame) {
  std::erase_if(waiting_, [this](const Waiting& waiting) { return surely_touches_at_start(waiting.column); });
  if (waiting_.size() > kMostWaiting / 2) decide_waiting(frame);
}

void SphereFinder::decide_waiting(const DetectorFrame& frame) {
  for (const Waiting& waiting : waiting_) {
    if (surely_touches_at_start(waiting.column)) continue;
    const SphereDecision decision = decide_sphere(waiting.pair.sphere, waiting.pair.before, waiting.pair.now);
    if (decision.exact_arithmetic) ++counts_.unsure;
    if (!decision.touch) continue;
    ++counts_.meeting;
    take(frame, waiting.column, {waiting.pair, *decision.touch, {}});
  }
  waiting_.clear();
}

SphereCounts SphereFinder::finish(const DetectorFrame& frame, ContactRow& row) {
  decide_waiting(frame);
  for (const std::uint32_t column : columns_) {
    std::optional<Best>& best = best_[column];
    if (best->start) {
      const SphereDecision decision = decide_sphere(best->pair.sphere, best->pair.before, best->pair.now);
      if (decision.exact_arithmetic) ++counts_.unsure;
      best->touch = *decision.touch;
    }
    row[column] = describe_touch(avatar_, map_, best->pair, best->touch, frame.duration_s);
    best.reset();
  }
  columns_.clear();
  return std::exchange(counts_, {});
}

}  // namespace vestige
