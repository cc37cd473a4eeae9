#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "detector/broad/meshlet_bounds.hpp"
#include "detector/broad/meshlets.hpp"
#include "detector/broad/segment_boxes.hpp"
#include "detector/frame.hpp"
#include "detector/method.hpp"
#include "detector/ways/cut_ways.hpp"
#include "traces/scene/avatar.hpp"

namespace vestige {

/// A meshlet that some segments may meet. They are the numbers `first` and following of MeshletCandidates::segments().
struct TouchedMeshlet {
  std::uint32_t meshlet = 0;
  std::uint32_t first = 0;
  std::uint32_t count = 0;
};

/// The broad phase: finds which segments may meet which meshlets. A pair that is not listed surely misses, bit for bit,
/// so no contact is lost.
class MeshletCandidates {
 public:
  /// Keeps a reference to `meshlets`.
  MeshletCandidates(const Avatar& avatar, const Meshlets& meshlets);

  /// `ways` are the frame's, all of its segments.
  void find(const DetectorFrame& frame, const Ways& ways, Method method);

  /// The meshlets of the last `find`, in ascending order. Each has at least one segment.
  std::span<const TouchedMeshlet> touched() const { return touched_; }

  /// Those of all touched meshlets, one after another.
  std::span<const std::uint32_t> segments() const { return segments_; }
  /// Numbers in DetectorFrame::segments, ascending.
  std::span<const std::uint32_t> segments(const TouchedMeshlet& touched) const {
    return std::span(segments_).subspan(touched.first, touched.count);
  }

 private:
  void descend(std::size_t level, std::size_t node);

  const Meshlets& meshlets_;
  MeshletBounds bounds_;
  std::vector<SegmentBoxes>
      segments_of_level_;  ///< for each level: the segments that may meet the node that `descend` is in
  std::vector<TouchedMeshlet> touched_;
  std::vector<std::uint32_t> segments_;
};

}  // namespace vestige
