#include "detector/broad/segment_boxes.hpp"

#include <algorithm>

namespace vestige {

void SegmentBoxes::reset(std::size_t capacity) {
  count_ = 0;
  const std::size_t stride = (capacity + kBoxBlock - 1) / kBoxBlock * kBoxBlock;
  if (stride <= stride_) return;
  stride_ = stride;
  ends_.assign(6 * stride, 0.0F);
  number_.resize(stride);
  meets_.reserve(stride / kBoxBlock);
}

void SegmentBoxes::add(const Segment& segment, std::uint32_t number) {
  const SegmentBox box = box_of(segment);
  for (int axis = 0; axis < 3; ++axis) {
    float* low = &ends_[static_cast<std::size_t>(axis) * stride_ + count_];
    low[0] = box.low[axis];
    low[3 * stride_] = box.high[axis];
  }
  number_[count_++] = number;
}

void SegmentBoxes::test(std::span<const SkinBox> boxes) {
  meets_.resize((count_ + kBoxBlock - 1) / kBoxBlock);
  for (std::size_t block = 0; block < meets_.size(); ++block) {
    const std::size_t first = block * kBoxBlock;
    meet_boxes(boxes, &ends_[first], stride_, std::min(kBoxBlock, count_ - first), meets_[block].data());
  }
}

bool SegmentBoxes::take_met(const SegmentBoxes& from, std::size_t box) {
  count_ = 0;
  from.visit_met(box, [&](std::size_t i) {
    for (std::size_t plane = 0; plane < 6; ++plane)
      ends_[plane * stride_ + count_] = from.ends_[plane * from.stride_ + i];
    number_[count_++] = from.number_[i];
  });
  return count_ > 0;
}

}  // namespace vestige
