#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "detector/frame.hpp"

namespace vestige {

/// What the broad phase tests in place of a frame's segments: a long segment is cut to where the skin can be. A cut
/// segment is a capsule around that part of the way, whose radius covers all errors. It proves misses and nothing else,
/// and for it a triangle covers all places that it has within the frame.
struct Ways {
  std::span<const Segment> segments;      ///< one for each of the frame's
  std::span<const std::uint8_t> are_cut;  ///< likewise; empty if none is

  bool is_cut(std::size_t number) const { return !are_cut.empty() && are_cut[number] != 0; }
};

/// Cuts the long segments of a frame.
class WayCutter {
 public:
  /// Returns the frame's own segments if none of them is long. Valid until the next call, and while the frame's are.
  Ways cut(const DetectorFrame& frame);

 private:
  std::vector<Segment> segments_;
  std::vector<std::uint8_t> are_cut_;
};

/// A cut segment across the axes of space. A box misses it if one of three directions separates them: those across the
/// segment and one of the axes. `way` is roughly from start to end; way x e_i is the i-th direction, along which all
/// points of the capsule lie within `spare` of `moment`. Zeros separate nothing.
struct CrossAxes {
  glm::vec3 way = glm::vec3(0);
  glm::vec3 moment = glm::vec3(0);
  glm::vec3 spare = glm::vec3(0);
};
CrossAxes cross_axes(const Segment& cut_segment);

}  // namespace vestige
