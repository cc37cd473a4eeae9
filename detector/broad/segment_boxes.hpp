#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "detector/broad/meet_boxes.hpp"
#include "detector/frame.hpp"

namespace vestige {

/// The boxes of some of a frame's segments, stored axis by axis, so that `test` compares many with many other boxes at
/// once.
class SegmentBoxes {
 public:
  /// Largest number of boxes that `test` takes at once.
  static constexpr std::size_t kMostTested = 8;

  /// Removes all segments, and makes room for `capacity` of them. With `are_some_cut`, `add_cut` may follow, and each
  /// test costs more.
  void reset(std::size_t capacity, bool are_some_cut = false);

  void add(const Segment& segment, std::uint32_t number);
  /// Adds a segment that a WayCutter cut: it meets only boxes that it passes through, as far as its CrossAxes tell.
  void add_cut(const Segment& segment, std::uint32_t number);

  /// Tests all segments against up to kMostTested boxes. The methods below return the results, until the next `add` or
  /// `test`.
  void test(std::span<const SkinBox> boxes);

  /// Calls visit(i) for each segment that met the box, in the order in which they were added.
  template <typename Visit>
  void visit_met(std::size_t box, Visit&& visit) const {
    for (std::size_t block = 0; block < meets_.size(); ++block)
      for (std::uint32_t bits = meets_[block][box]; bits != 0; bits &= bits - 1)
        visit(block * kBoxBlock + static_cast<std::size_t>(std::countr_zero(bits)));
  }

  /// Appends the numbers of the segments that met the box.
  void append_met(std::size_t box, std::vector<std::uint32_t>& numbers) const {
    visit_met(box, [&](std::size_t i) { numbers.push_back(number_[i]); });
  }

  /// Replaces the contents by the segments of `from` that met the box. Returns false if there are none. The capacity
  /// must suffice for all of `from`.
  bool take_met(const SegmentBoxes& from, std::size_t box);

 private:
  static constexpr std::size_t kPlanes = 6;      ///< low x, y, z, high x, y, z
  static constexpr std::size_t kCutPlanes = 15;  ///< and the numbers of CrossAxes

  template <std::size_t kCount>  // of planes
  void take(const SegmentBoxes& from, std::size_t i);

  std::size_t count_ = 0;
  std::size_t stride_ = 0;
  std::size_t planes_ = kPlanes;
  std::vector<float> ends_;                                    ///< `planes_` planes of `stride_` values
  std::vector<std::uint32_t> number_;                          ///< number in the frame
  std::vector<std::array<std::uint32_t, kMostTested>> meets_;  ///< for each block of segments: the bits for each box
};

}  // namespace vestige
