#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "detector/collider_moves.hpp"
#include "detector/frame.hpp"

namespace vestige {

/// Where a person stands, and what can touch them.
struct SegmentPlace {
  glm::dvec3 origin_m;       ///< of the frame, in the world
  glm::vec3 reach_m;         ///< segments that stay beyond it along an axis are left out; infinite: none
  std::uint16_t left_owner;  ///< whose colliders are left out, too
  float long_m;              ///< segments that are longer along an axis are counted
};

/// How many moves became no segment, and how many a long one.
struct SegmentCounts {
  std::size_t out_of_reach = 0;
  std::size_t out_of_range = 0;  ///< an end that is not finite, or close to the end of fp32's range
  std::size_t long_segments = 0;
};

/// Makes segments of moves, relative to the origin and rounded once, in their order.
SegmentCounts build_segments(std::span<const ColliderMove> moves, const SegmentPlace& place, std::vector<Segment>& out);

}  // namespace vestige
