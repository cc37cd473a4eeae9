#include "detector/frame.hpp"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <limits>
#include <utility>

namespace vestige {

namespace {

/// The origin follows the avatar only if the avatar is more than this far away from it (detector/CONTRACT.md, 2).
constexpr double kOriginReach_m = 2.0;

/// Within these limits, a skinned vertex (`skins_to_finite`) and a segment's end carried with the skin stay in fp32's
/// range.
constexpr double kLargestSkin_m = std::numeric_limits<float>::max() / 8;
constexpr float kLargestCollider_m = std::numeric_limits<float>::max() / 2;

bool within_reach(const glm::vec3& v) {
  const glm::vec3 size = glm::abs(v);
  return size.x < kLargestCollider_m && size.y < kLargestCollider_m && size.z < kLargestCollider_m;
}

/// Whether a segment stays farther away than `reach` along an axis.
bool is_beyond(const Segment& segment, const glm::vec3& reach) {
  const glm::vec3 reach_m = reach + bounding_radius_m(segment);
  const glm::vec3 low = glm::min(segment.start, segment.end);
  const glm::vec3 high = glm::max(segment.start, segment.end);
  // Without a branch for each axis: almost all are in reach.
  return ((low.x > reach_m.x) | (low.y > reach_m.y) | (low.z > reach_m.z) | (high.x < -reach_m.x) |
          (high.y < -reach_m.y) | (high.z < -reach_m.z)) != 0;
}

}  // namespace

SegmentBox box_of(const Segment& segment) {
  SegmentBox box = {glm::min(segment.start, segment.end), glm::max(segment.start, segment.end)};
  if (!segment.is_sphere()) return box;
  const float radius_m = bounding_radius_m(segment);
  for (int axis = 0; axis < 3; ++axis) {
    // Both sums below err by less than 2^-23 of this.
    const float size_m = std::max(std::abs(box.low[axis]), std::abs(box.high[axis])) + radius_m;
    const float reach_m = radius_m + (size_m * 0x1p-21F + std::numeric_limits<float>::denorm_min());
    box.low[axis] -= reach_m;
    box.high[axis] += reach_m;
  }
  return box;
}

FrameBuilder::FrameBuilder(const Avatar& avatar, std::span<const std::uint32_t> collider_ids, Method method,
                           std::size_t person, Skip skip)
    : avatar_(avatar),
      own_colliders_(collider_ids),
      method_(method),
      person_(person),
      skip_(skip),
      bind_extent_m_(bind_extent_m(avatar)) {}

const DetectorFrame& FrameBuilder::next(const TraceFrame& trace_frame) {
  begin(trace_frame, own_colliders_.columns());
  ascending_ = own_colliders_.visit_next(trace_frame, [this](const ColliderMove& move) { add_segment(move); });
  return finish();
}

const DetectorFrame& FrameBuilder::next(const TraceFrame& trace_frame, const ColliderMoves& colliders) {
  begin(trace_frame, colliders.columns());
  for (const ColliderMove& move : colliders.moves()) add_segment(move);
  return finish();
}

void FrameBuilder::begin(const TraceFrame& trace_frame, std::size_t columns) {
  frame_.columns = columns;
  const double time_s = trace_frame.time_s();
  frame_.duration_s = started_ ? time_s - frame_.time_s : 0;
  frame_.time_s = time_s;
  frame_.index = trace_frame.index;

  const bool has_before = started_;
  const Pose& pose = trace_frame.poses[person_];
  std::swap(world_, world_before_);
  place(pose);
  follow_origin(pose);
  started_ = true;
  build_palette(avatar_, world_, pose.origin_m - frame_.origin_m, frame_.palette);
  if (method_ != Method::kStatic) {
    if (has_before) {
      build_palette(avatar_, world_before_, pose_origin_before_m_ - frame_.origin_m, frame_.palette_before);
    } else {
      frame_.palette_before = frame_.palette;
    }
    pose_origin_before_m_ = pose.origin_m;
  }
  // A pose in reach of its own origin can be out of reach of this frame's origin. Then this frame reports it.
  const std::optional<glm::dvec3> reach_m = reach_of(frame_.palette);
  const std::optional<glm::dvec3> reach_before_m =
      method_ == Method::kStatic ? reach_m : reach_of(frame_.palette_before);
  constexpr double kRounding = 1.001;  // of vertices, and of what starts are carried by: less than 2^-20 of the reach
  glm::dvec3 all_m = glm::max(reach_m.value_or(glm::dvec3(0)), reach_before_m.value_or(glm::dvec3(0)));
  if (method_ == Method::kCarried) all_m += carried_m();
  reach_m_ = glm::vec3(all_m * kRounding);
  in_reach_ = reach_m.has_value();
  before_in_reach_ = method_ == Method::kStatic || reach_before_m.has_value();
  frame_.segments.clear();
  ascending_ = true;
  frame_.out_of_reach = 0;
}

const DetectorFrame& FrameBuilder::finish() {
  if (!ascending_) std::ranges::sort(frame_.segments, {}, &Segment::column);
  if (!in_reach_ || (!before_in_reach_ && before_was_in_reach_)) {
    ++non_finite_frames_;
    note_non_finite();
  }
  if (!in_reach_ || !before_in_reach_) {
    frame_.segments.clear();
    frame_.out_of_reach = 0;
  }
  before_was_in_reach_ = in_reach_;
  return frame_;
}

/// Returns how far a skinned vertex can be from the origin along each axis, with any influences; rounding adds a
/// little, as weights sum to 1 only almost. Returns nothing if not all sums of a vertex stay in fp32's range.
std::optional<glm::dvec3> FrameBuilder::reach_of(std::span<const SkinMatrix> palette) const {
  glm::dvec3 all(0);
  for (const SkinMatrix& matrix : palette) {
    glm::dvec3 reach = skin_reach_m(matrix, bind_extent_m_);
    // A blended column must not overflow even if the bind pose is flat: infinity times 0 is not a number.
    for (const auto& column : matrix.column) reach = glm::max(reach, glm::abs(glm::dvec3(column)));
    if (!(reach.x < kLargestSkin_m && reach.y < kLargestSkin_m && reach.z < kLargestSkin_m)) return {};
    all = glm::max(all, reach);
  }
  return all;
}

/// Returns how far a vertex can have moved along each axis since the frame before.
glm::dvec3 FrameBuilder::carried_m() const {
  glm::dvec3 all(0);
  for (std::size_t i = 0; i < frame_.palette.size(); ++i) {
    SkinMatrix moved = frame_.palette[i];
    for (std::size_t column = 0; column < moved.column.size(); ++column)
      moved.column[column] -= frame_.palette_before[i].column[column];
    all = glm::max(all, skin_reach_m(moved, bind_extent_m_));
  }
  return all;
}

void FrameBuilder::note_non_finite() {
  if (!first_non_finite_) first_non_finite_ = frame_.index;
}

void FrameBuilder::place(const Pose& pose) {
  if (pose.nodes.empty()) {  // a missing pose is one that is not finite
    world_.assign(avatar_.nodes.size(), glm::dmat4(std::numeric_limits<double>::quiet_NaN()));
  } else {
    world_matrices(avatar_, pose, world_);
  }
}

void FrameBuilder::follow_origin(const Pose& pose) {
  // Whole metres and the rest are kept apart. So a pose shifted by whole metres gets an origin shifted by the same
  // amount.
  const glm::dvec3 root(world_[static_cast<std::size_t>(avatar_.root_node)][3]);
  const glm::dvec3 whole = glm::floor(pose.origin_m);
  const glm::dvec3 rest = (pose.origin_m - whole) + root;
  const glm::dvec3 away = (whole - frame_.origin_m) + rest;
  const bool stays = started_ && std::abs(away.x) <= kOriginReach_m && std::abs(away.y) <= kOriginReach_m &&
                     std::abs(away.z) <= kOriginReach_m;
  const glm::dvec3 origin = whole + glm::round(rest);
  if (stays || !(std::isfinite(origin.x) && std::isfinite(origin.y) && std::isfinite(origin.z))) return;
  if (started_) ++origin_changes_;
  frame_.origin_m = origin;
}

void FrameBuilder::add_segment(const ColliderMove& move) {
  if (move.owner == person_ + 1) return;
  const Segment segment = {move.column, glm::vec3(move.start_m - frame_.origin_m),
                           glm::vec3(move.end_m - frame_.origin_m), move.radius_m};
  if (!within_reach(segment.start) || !within_reach(segment.end)) {
    ++non_finite_segments_;
    note_non_finite();
  } else if (skip_ == Skip::kOn && is_beyond(segment, reach_m_)) {
    ++frame_.out_of_reach;
  } else {
    frame_.segments.push_back(segment);
  }
}

}  // namespace vestige
