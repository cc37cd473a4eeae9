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

/// The boxes of some of a frame's segments, axis by axis, so that many are tested against many others at once.
class SegmentBoxes {
 public:
  /// Boxes that `test` takes at once.
  static constexpr std::size_t kMostTested = 8;

  /// Forgets all segments, and has room for `capacity`.
  void reset(std::size_t capacity);

  void add(const Segment& segment, std::uint32_t number);

  /// Which segments meet which of up to kMostTested boxes: what the others answer, until the next `add` or `test`.
  void test(std::span<const SkinBox> boxes);

  /// Calls visit(i) for each segment that met the box, in the order in which they were added.
  template <typename Visit>
  void visit_met(std::size_t box, Visit&& visit) const {
    for (std::size_t block = 0; block < meets_.size(); ++block)
      for (std::uint32_t bits = meets_[block][box]; bits != 0; bits &= bits - 1)
        visit(block * kBoxBlock + static_cast<std::size_t>(std::countr_zero(bits)));
  }

  /// Appends the numbers of those that met the box.
  void append_met(std::size_t box, std::vector<std::uint32_t>& numbers) const {
    visit_met(box, [&](std::size_t i) { numbers.push_back(number_[i]); });
  }

  /// Makes these the ones of `from` that met the box; false where there are none. There is room for all of `from`.
  bool take_met(const SegmentBoxes& from, std::size_t box);

 private:
  std::size_t count_ = 0;
  std::size_t stride_ = 0;
  std::vector<float> ends_;                                    ///< low x, y, z, high x, y, z: stride_ each
  std::vector<std::uint32_t> number_;                          ///< in the frame
  std::vector<std::array<std::uint32_t, kMostTested>> meets_;  ///< of each block of segments: bits, for each box
};

}  // namespace vestige
