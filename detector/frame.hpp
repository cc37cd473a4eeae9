#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <glm/common.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <optional>
#include <span>
#include <vector>

#include "detector/collider_moves.hpp"
#include "detector/method.hpp"
#include "detector/skinning.hpp"
#include "traces/scene/avatar.hpp"
#include "traces/scene/trace.hpp"

namespace vestige {

/// The motion of one collider from the previous frame to this frame. Metres, relative to the frame's origin.
struct Segment {
  std::uint32_t column = 0;  ///< of the collision texture
  glm::vec3 start = glm::vec3(0);
  glm::vec3 end = glm::vec3(0);
  float radius_m = 0;  ///< of the sphere whose centre moves along the segment; 0: a point

  bool is_sphere() const { return radius_m > 0; }
};

/// The box around everything that a collider covers while it moves along a segment. For a sphere it is rounded
/// outwards, with room for a start that is carried with the skin and rounded once more.
struct SegmentBox {
  glm::vec3 low;
  glm::vec3 high;
};

/// Returns the radius with room for the rounding of bounds in fp32: 2^-20 larger. 0 for a point.
inline float bounding_radius_m(float radius_m) {
  return radius_m * (1 + 0x1p-20F);
}
inline float bounding_radius_m(const Segment& segment) {
  return bounding_radius_m(segment.radius_m);
}

/// Returns the box with room for a sphere of this bounding radius at each of its places.
SegmentBox grown_by(SegmentBox box, float radius_m);

inline SegmentBox box_of(const Segment& segment) {
  const SegmentBox box = {glm::min(segment.start, segment.end), glm::max(segment.start, segment.end)};
  return segment.is_sphere() ? grown_by(box, bounding_radius_m(segment)) : box;
}

/// The input of a detector: detector/CONTRACT.md, 1 to 3. All positions are relative to `origin_m`.
struct DetectorFrame {
  std::uint64_t index = 0;
  double time_s = 0;
  double duration_s = 0;  ///< since the previous frame; 0 in the first frame
  glm::dvec3 origin_m = glm::dvec3(0);
  std::size_t columns = 0;  ///< of the collision texture
  std::vector<SkinMatrix> palette;
  std::vector<SkinMatrix> palette_before;  ///< of the previous frame, relative to this frame's origin
  std::vector<Segment> segments;           ///< by ascending columns, at most one for each column
  std::size_t out_of_reach = 0;            ///< segments that were left out, as they cannot meet the skin
  std::size_t long_segments = 0;           ///< segments that are longer than `long_way_m` along an axis
  glm::vec3 reach_m = glm::vec3(0);        ///< no contact is farther from the origin along an axis
  glm::vec3 carried_m = glm::vec3(0);      ///< kCarried: no start is carried farther along an axis
};

/// Longer ways are worth to be cut to where the skin can be: they are long against its parts.
inline float long_way_m(const glm::vec3& reach_m) {
  return std::max({reach_m.x, reach_m.y, reach_m.z}) * 0x1p-4F;
}

/// Converts the frames of a trace to the input of a detector: the segments between consecutive frames, and a palette.
/// Both are relative to a whole-metre origin that follows the avatar. A trace of several people needs one for each.
class FrameBuilder {
 public:
  /// `collider_ids` as in `ColliderMoves`; none are needed for the second `next`. `person` counts from 0: the avatar
  /// takes that pose of each frame, and this person's own colliders test nothing. A frame whose pose is missing or not
  /// finite is empty. With a method that uses the previous frame, the next frame is empty, too. With Skip::kOn,
  /// segments out of the skin's reach are left out.
  FrameBuilder(const Avatar& avatar, std::span<const std::uint32_t> collider_ids, Method method = Method::kStatic,
               std::size_t person = 0, Skip skip = Skip::kOff);

  /// Takes the next frame of the trace. If the indices leave a gap (a damaged trace), the frame tests nothing. The
  /// reference is valid until the next call.
  const DetectorFrame& next(const TraceFrame& trace_frame);
  /// As above, with colliders that have taken this frame: people share them.
  const DetectorFrame& next(const TraceFrame& trace_frame, const ColliderMoves& colliders);

  /// Number of frames whose pose is missing, not finite or close to the end of fp32's range. They test nothing.
  std::uint64_t non_finite_frames() const { return non_finite_frames_; }
  /// Number of segments with an end that is not finite or is close to the end of fp32's range. They test nothing.
  std::uint64_t non_finite_segments() const { return non_finite_segments_; }
  /// Index of the first frame that such a pose or such a segment is in.
  std::optional<std::uint64_t> first_non_finite() const { return first_non_finite_; }
  std::uint64_t origin_changes() const { return origin_changes_; }

 private:
  void place(const Pose& pose);
  void follow_origin(const Pose& pose);
  void take_segments(std::span<const ColliderMove> moves);
  glm::dvec3 carried_m() const;
  void note_non_finite();

  const Avatar& avatar_;
  ColliderMoves own_colliders_;
  Method method_;
  std::size_t person_;
  Skip skip_;
  std::vector<glm::dmat4> world_;
  std::vector<glm::dmat4> world_before_;
  glm::dvec3 pose_origin_before_m_ = glm::dvec3(0);
  glm::dvec3 bind_extent_m_;
  DetectorFrame frame_;
  bool started_ = false;
  bool before_was_in_reach_ = true;
  std::uint64_t non_finite_frames_ = 0;
  std::uint64_t non_finite_segments_ = 0;
  std::uint64_t origin_changes_ = 0;
  std::optional<std::uint64_t> first_non_finite_;
};

}  // namespace vestige
