#include "detector/ways/cut_ways.hpp"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

// Where a segment is cut. Let x(t) = s + t (e - s) be the segment, h the largest places of the skin along an axis,
// grown by the radius of a sphere. At a contact, |x(t)| <= h along each axis, with one exception below. So t lies
// between the times at which the segment enters and leaves that box.
//
// Times. A time (h - s) / (e - s) meets two subtractions and a division in fp64. Each errs by at most 2^-53 of its
// result, so the time errs by less than 2^-50 of itself. The times are moved outwards by 2^-49 of themselves.
//
// Places. s + t (e - s) meets three operations on at most |s| + |e - s|, so it errs by less than 2^-50 of that along
// each axis; rounding to fp32 adds at most 2^-24 of the place, or 2^-150. What is true of the places at both times is
// true of all between, as both segments are straight: the true part lies within that error of the computed one. The
// radius grows by twice that (an error along three axes is at most 1.8 times that along one), of which there is four
// times too much for |s| + |e - s| and twice for the place.
//
// `carried`. A start is moved by m and rounded, to s + m + r. Rounding is monotonic and keeps s, which is a number of
// both formats: rounding s + m to fp64 moves it by at most |m|, as s is as near, so to within 2 |m| of s. Rounding that
// to fp32 moves it by at most 2 |m|, likewise. So |r| <= 3 |m|, however far away the start is. The bounds of nodes and
// triangles have room for (1 - t) m. For (1 - t) r, the box and the radius grow by 3 |m|.
//
// Directions. Along n = d x e_i, the capsule's points lie between n . start and n . end, or at most radius |n| beyond;
// |n| is at most the sum of its numbers. Products of two fp32 numbers are exact in fp64; 2^-20 of all magnitudes covers
// the sums and the rounding of `moment` and `spare`.
namespace vestige {

namespace {

constexpr double kTimeError = 0x1p-49;
constexpr double kPlaceError = 0x1p-48;
constexpr double kRoundedError = 0x1p-23;
constexpr float kTiny = 0x1p-120F;

/// Segments are cut only if the error is less than this share of the box: longer ones stay whole.
constexpr double kLargestError = 0x1p-6;
/// With larger skins, no segment is cut: then no product below overflows.
constexpr float kLargestReach_m = 0x1p30F;
/// Where a segment goes that cannot meet the skin.
constexpr float kNowhere_m = 0x1p100F;

double largest(const glm::dvec3& v) {
  return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
}

/// Times of a segment.
struct Span {
  double first = 0;
  double last = 1;
};

/// When the segment is within the box from -half to half, or a little before and after. `first` is above `last` if it
/// never is.
Span span_within(const glm::dvec3& half, const glm::dvec3& start, const glm::dvec3& way) {
  Span span;
  for (int axis = 0; axis < 3; ++axis) {
    if (way[axis] == 0) {
      if (std::abs(start[axis]) > half[axis]) return {1, 0};
      continue;
    }
    const double one = (-half[axis] - start[axis]) / way[axis];
    const double other = (half[axis] - start[axis]) / way[axis];
    span.first = std::max(span.first, std::min(one, other));
    span.last = std::min(span.last, std::max(one, other));
  }
  return {span.first * (1 - kTimeError), std::min(span.last * (1 + kTimeError), 1.0)};
}

/// Where the skin is in a frame.
struct SkinPlace {
  glm::dvec3 half_m;  ///< it lies within +- this
  double spare_m;     ///< what carries a start farther than bounds of the skin have room for
};

/// Replaces the segment by the part that is near the skin. Returns false, and leaves it, if it is too long for that.
bool cut(const SkinPlace& skin, Segment& segment) {
  const double radius_m = double{bounding_radius_m(segment)};
  const glm::dvec3 start(segment.start);
  const glm::dvec3 way = glm::dvec3(segment.end) - start;
  const glm::dvec3 half_m = skin.half_m + radius_m;
  const double error_m = kPlaceError * (largest(start) + largest(way));
  if (!(error_m < kLargestError * largest(half_m))) return false;
  const Span span = span_within(half_m, start, way);
  if (span.first > span.last) {
    segment.start = segment.end = glm::vec3(kNowhere_m);
    return true;
  }
  const glm::dvec3 first = start + span.first * way;
  const glm::dvec3 last = start + span.last * way;
  const double rounded_m = kRoundedError * std::max(largest(first), largest(last));
  segment.start = glm::vec3(first);
  segment.end = glm::vec3(last);
  segment.radius_m = static_cast<float>(radius_m + error_m + rounded_m + skin.spare_m) + kTiny;
  return true;
}

}  // namespace

Ways WayCutter::cut(const DetectorFrame& frame) {
  const glm::dvec3 spare_m = 3.0 * glm::dvec3(frame.carried_m);
  const SkinPlace skin = {glm::dvec3(frame.reach_m) + spare_m, glm::length(spare_m)};
  if (frame.long_segments == 0 || !(largest(skin.half_m) < kLargestReach_m)) return {frame.segments, {}};
  segments_.assign(frame.segments.begin(), frame.segments.end());
  are_cut_.assign(segments_.size(), 0);
  const float long_m = long_way_m(frame.reach_m);
  for (std::size_t i = 0; i < segments_.size(); ++i) {
    const glm::vec3 way = glm::abs(segments_[i].end - segments_[i].start);
    if (std::max({way.x, way.y, way.z}) > long_m) are_cut_[i] = vestige::cut(skin, segments_[i]) ? 1 : 0;
  }
  return {segments_, are_cut_};
}

CrossAxes cross_axes(const Segment& cut_segment) {
  CrossAxes axes;
  axes.way = cut_segment.end - cut_segment.start;
  const glm::dvec3 way(axes.way);
  const glm::dvec3 start(cut_segment.start);
  const glm::dvec3 end(cut_segment.end);
  for (int axis = 0; axis < 3; ++axis) {
    const int j = (axis + 1) % 3;
    const int k = (axis + 2) % 3;
    const double of_start = start[j] * way[k] - start[k] * way[j];
    const double of_end = end[j] * way[k] - end[k] * way[j];
    const double size = std::max(std::abs(start[j]), std::abs(end[j])) * std::abs(way[k]) +
                        std::max(std::abs(start[k]), std::abs(end[k])) * std::abs(way[j]);
    const double radius = double{bounding_radius_m(cut_segment)} * (std::abs(way[j]) + std::abs(way[k]));
    axes.moment[axis] = static_cast<float>((of_start + of_end) / 2);
    axes.spare[axis] = static_cast<float>(std::abs(of_end - of_start) / 2 + radius + 0x1p-20 * (size + radius)) + kTiny;
  }
  return axes;
}

}  // namespace vestige
