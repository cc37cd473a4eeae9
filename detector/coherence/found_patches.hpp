#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "detector/broad/meshlet_candidates.hpp"
#include "detector/broad/meshlet_skin.hpp"

namespace vestige {

/// The meshlets that segments of one frame may meet, and where they are.
struct FoundPatches {
  std::vector<TouchedMeshlet> touched;  ///< in ascending order; each has at least one segment
  std::vector<std::uint32_t> numbers;   ///< in DetectorFrame::segments, ascending for each meshlet
  std::vector<std::uint32_t> places;    ///< for each of `touched`: where its corners are in `now` and `before`
  std::vector<MeshletCorners> now;
  std::vector<MeshletCorners> before;  ///< in the previous frame; empty with kStatic

  std::span<const std::uint32_t> segments(const TouchedMeshlet& one) const {
    return std::span(numbers).subspan(one.first, one.count);
  }
  const MeshletCorners& now_of(std::size_t i) const { return now[places[i]]; }
  const MeshletCorners& before_of(std::size_t i) const { return before.empty() ? now_of(i) : before[places[i]]; }
};

}  // namespace vestige
