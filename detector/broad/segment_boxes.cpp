#include "detector/broad/segment_boxes.hpp"

#include <algorithm>

#include "detector/ways/cut_ways.hpp"

namespace vestige {

void SegmentBoxes::reset(std::size_t capacity, bool are_some_cut) {
  count_ = 0;
  planes_ = are_some_cut ? kCutPlanes : kPlanes;
  const std::size_t stride = (capacity + kBoxBlock - 1) / kBoxBlock * kBoxBlock;
  if (stride <= stride_ && planes_ * stride_ <= ends_.size()) return;
  stride_ = std::max(stride, stride_);
  ends_.assign(planes_ * stride_, 0.0F);
  number_.resize(stride_);
  meets_.reserve(stride_ / kBoxBlock);
}

void SegmentBoxes::add(const Segment& segment, std::uint32_t number) {
  const SegmentBox box = box_of(segment);
  for (int axis = 0; axis < 3; ++axis) {
    float* low = &ends_[static_cast<std::size_t>(axis) * stride_ + count_];
    low[0] = box.low[axis];
    low[3 * stride_] = box.high[axis];
  }
  for (std::size_t plane = kPlanes; plane < planes_; ++plane) ends_[plane * stride_ + count_] = 0;
  number_[count_++] = number;
}

void SegmentBoxes::add_cut(const Segment& segment, std::uint32_t number) {
  add(segment, number);
  const CrossAxes axes = cross_axes(segment);
  float* out = &ends_[kPlanes * stride_ + count_ - 1];
  for (const glm::vec3& three : {axes.way, axes.moment, axes.spare})
    for (int axis = 0; axis < 3; ++axis, out += stride_) *out = three[axis];
}

void SegmentBoxes::test(std::span<const SkinBox> boxes) {
  meets_.resize((count_ + kBoxBlock - 1) / kBoxBlock);
  for (std::size_t block = 0; block < meets_.size(); ++block) {
    const std::size_t first = block * kBoxBlock;
    const std::size_t count = std::min(kBoxBlock, count_ - first);
    meet_boxes(boxes, &ends_[first], stride_, count, meets_[block].data());
    if (planes_ == kCutPlanes)
      meet_cut_segments(boxes, &ends_[kPlanes * stride_ + first], stride_, count, meets_[block].data());
  }
}

template <std::size_t kCount>
void SegmentBoxes::take(const SegmentBoxes& from, std::size_t i) {
  for (std::size_t plane = 0; plane < kCount; ++plane)
    ends_[plane * stride_ + count_] = from.ends_[plane * from.stride_ + i];
  number_[count_++] = from.number_[i];
}

bool SegmentBoxes::take_met(const SegmentBoxes& from, std::size_t box) {
  count_ = 0;
  if (planes_ == kPlanes) {
    from.visit_met(box, [&](std::size_t i) { take<kPlanes>(from, i); });
  } else {
    from.visit_met(box, [&](std::size_t i) { take<kCutPlanes>(from, i); });
  }
  return count_ > 0;
}

}  // namespace vestige
