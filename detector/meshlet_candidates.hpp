#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "detector/frame.hpp"
#include "detector/meshlet_bounds.hpp"
#include "detector/meshlets.hpp"
#include "detector/method.hpp"
#include "traces/avatar.hpp"

namespace vestige {

/// Segments' boxes, axis by axis, so that several are tested at once.
class SegmentBoxes {
 public:
  void resize(std::size_t capacity);
  void clear() { count_ = 0; }
  void add(const Segment& segment, std::uint32_t number);
  std::size_t size() const { return count_; }
  std::span<const std::uint32_t> numbers() const { return std::span(number_).first(count_); }

  /// Fills `out`, which has this one's capacity, with those that meet `box`, in the same order.
  void meet(const SkinBox& box, SegmentBoxes& out) const;

 private:
  std::size_t count_ = 0;
  std::size_t stride_ = 0;
  std::vector<float> ends_;            ///< low x, y, z, high x, y, z: stride_ each
  std::vector<std::uint32_t> number_;  ///< in the frame
};

/// A meshlet that some segments may meet: numbers `first` and following of MeshletCandidates::segments().
struct TouchedMeshlet {
  std::uint32_t meshlet = 0;
  std::uint32_t first = 0;
  std::uint32_t count = 0;
};

/// Which segments may meet which meshlets. What is not listed surely misses, bit for bit: no contact is lost.
class MeshletCandidates {
 public:
  /// Keeps a reference to `meshlets`.
  MeshletCandidates(const Avatar& avatar, const Meshlets& meshlets);

  void find(const Frame& frame, Method method);

  /// Of the last `find`, by ascending meshlets; each with at least one segment.
  std::span<const TouchedMeshlet> touched() const { return touched_; }

  /// Numbers in Frame::segments, ascending.
  std::span<const std::uint32_t> segments(const TouchedMeshlet& touched) const {
    return std::span(segments_).subspan(touched.first, touched.count);
  }

 private:
  void descend(std::size_t level, std::size_t node);

  const Meshlets& meshlets_;
  MeshletBounds bounds_;
  std::vector<SegmentBoxes> of_level_;  ///< those that may meet the node of each level that is being looked into
  std::vector<TouchedMeshlet> touched_;
  std::vector<std::uint32_t> segments_;
};

}  // namespace vestige
