#include "detector/frame.hpp"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <limits>
#include <utility>

#include "detector/build_segments.hpp"

namespace vestige {

namespace {

/// The origin follows the avatar only if the avatar is more than this far away from it (detector/CONTRACT.md, 2).
constexpr double kOriginReach_m = 2.0;

/// Within this limit, a skinned vertex stays in fp32's range.
constexpr double kLargestSkin_m = std::numeric_limits<float>::max() / 8;

}  // namespace

SegmentBox grown_by(SegmentBox box, float radius_m) {
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
  own_colliders_.next(trace_frame);
  return next(trace_frame, own_colliders_);
}

const DetectorFrame& FrameBuilder::next(const TraceFrame& trace_frame, const ColliderMoves& colliders) {
  frame_.columns = colliders.columns();
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
  const std::optional<glm::dvec3> reach_m = palette_reach_m(frame_.palette, bind_extent_m_, kLargestSkin_m);
  const std::optional<glm::dvec3> reach_before_m =
      method_ == Method::kStatic ? reach_m : palette_reach_m(frame_.palette_before, bind_extent_m_, kLargestSkin_m);
  const bool in_reach = reach_m.has_value();
  const bool before_in_reach = method_ == Method::kStatic || reach_before_m.has_value();
  constexpr double kRounding = 1.001;  // of vertices, and of what starts are carried by: less than 2^-20 of the reach
  glm::dvec3 all_m = glm::max(reach_m.value_or(glm::dvec3(0)), reach_before_m.value_or(glm::dvec3(0)));
  const glm::dvec3 moved_m = method_ == Method::kCarried ? carried_m() : glm::dvec3(0);
  frame_.carried_m = method_ == Method::kCarried ? glm::vec3(moved_m * kRounding + all_m * 0x1p-19) : glm::vec3(0);
  frame_.reach_m = glm::vec3((all_m + moved_m) * kRounding);
  take_segments(colliders.moves());
  if (!in_reach || (!before_in_reach && before_was_in_reach_)) {
    ++non_finite_frames_;
    note_non_finite();
  }
  if (!in_reach || !before_in_reach) {
    frame_.segments.clear();
    frame_.out_of_reach = 0;
    frame_.long_segments = 0;
  }
  before_was_in_reach_ = in_reach;
  return frame_;
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

void FrameBuilder::take_segments(std::span<const ColliderMove> moves) {
  const glm::vec3 reach_m = skip_ == Skip::kOn ? frame_.reach_m : glm::vec3(std::numeric_limits<float>::infinity());
  const auto owner = static_cast<std::uint16_t>(person_ + 1);
  const SegmentCounts counts =
      build_segments(moves, {frame_.origin_m, reach_m, owner, long_way_m(frame_.reach_m)}, frame_.segments);
  frame_.out_of_reach = counts.out_of_reach;
  frame_.long_segments = counts.long_segments;
  non_finite_segments_ += counts.out_of_range;
  if (counts.out_of_range > 0) note_non_finite();
}

}  // namespace vestige
