#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "detector/broad/skin_motion.hpp"
#include "detector/frame.hpp"
#include "detector/method.hpp"
#include "traces/scene/avatar.hpp"

namespace vestige {

/// Boxes around the region that each triangle covers within a frame. They reject most pairs at the cost of a
/// comparison. A box never proves a contact. A segment that meets no box is proven to miss, exactly: all rounding is
/// outwards.
class TriangleBoxes {
 public:
  /// For `kCarried`, a box grows by the displacement that may move a segment's start.
  void build(const Avatar& avatar, const SkinMotion& skin, Method method);

  /// Calls `found(triangle)` for every triangle whose box meets the segment's, in ascending order.
  template <typename Found>
  void meet(const Segment& segment, Found&& found) const {
    std::array<float, 3> low = {};
    std::array<float, 3> high = {};
    const SegmentBox box = box_of(segment);
    for (int axis = 0; axis < 3; ++axis) {
      low[static_cast<std::size_t>(axis)] = box.low[axis];
      high[static_cast<std::size_t>(axis)] = box.high[axis];
    }
    for (std::size_t first = 0; first < count_; first += kBlock) {
      std::array<std::uint32_t, kBlock> meets;
      if (!block_meets(first, low, high, meets)) continue;
      for (std::size_t i = 0; i < kBlock; ++i)
        if (meets[i] != 0) found(static_cast<std::uint32_t>(first + i));
    }
  }

 private:
  static constexpr std::size_t kBlock = 64;

  bool block_meets(std::size_t first, const std::array<float, 3>& low, const std::array<float, 3>& high,
                   std::array<std::uint32_t, kBlock>& meets) const;

  std::size_t count_ = 0;
  std::array<std::vector<float>, 3> low_;  ///< by axis, padded to whole blocks with boxes that meet nothing
  std::array<std::vector<float>, 3> high_;
};

}  // namespace vestige
