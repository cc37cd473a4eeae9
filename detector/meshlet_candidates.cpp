#include "detector/meshlet_candidates.hpp"

#include <algorithm>
#include <array>
#include <bit>

#include "detector/meet_boxes.hpp"

namespace vestige {

void SegmentBoxes::resize(std::size_t capacity) {
  const std::size_t stride = (capacity + kBoxBlock - 1) / kBoxBlock * kBoxBlock;
  if (stride <= stride_) return;
  stride_ = stride;
  ends_.assign(6 * stride, 0.0F);
  number_.resize(stride);
}

void SegmentBoxes::add(const Segment& segment, std::uint32_t number) {
  for (int axis = 0; axis < 3; ++axis) {
    const auto plane = static_cast<std::size_t>(axis) * stride_;
    ends_[plane + count_] = std::min(segment.start[axis], segment.end[axis]);
    ends_[plane + 3 * stride_ + count_] = std::max(segment.start[axis], segment.end[axis]);
  }
  number_[count_++] = number;
}

void SegmentBoxes::meet(const SkinBox& box, SegmentBoxes& out) const {
  std::size_t found = 0;
  for (std::size_t first = 0; first < count_; first += kBoxBlock) {
    std::uint32_t meets = meet_boxes(box, &ends_[first], stride_, std::min(kBoxBlock, count_ - first));
    for (; meets != 0; meets &= meets - 1) {
      const std::size_t i = first + static_cast<std::size_t>(std::countr_zero(meets));
      for (std::size_t plane = 0; plane < 6; ++plane)
        out.ends_[plane * out.stride_ + found] = ends_[plane * stride_ + i];
      out.number_[found++] = number_[i];
    }
  }
  out.count_ = found;
}

MeshletCandidates::MeshletCandidates(const Avatar& avatar, const Meshlets& meshlets)
    : meshlets_(meshlets), bounds_(avatar, meshlets), of_level_(meshlets.levels() + 1) {}

void MeshletCandidates::find(const Frame& frame, Method method) {
  touched_.clear();
  segments_.clear();
  const std::size_t levels = meshlets_.levels();
  if (levels == 0 || frame.segments.empty()) return;
  bounds_.begin(frame, method);
  for (SegmentBoxes& boxes : of_level_) boxes.resize(frame.segments.size());
  SegmentBoxes& all = of_level_[levels];
  all.clear();
  for (std::size_t i = 0; i < frame.segments.size(); ++i) all.add(frame.segments[i], static_cast<std::uint32_t>(i));
  descend(levels, 0);
}

/// Looks into the children of a node of `level`; that above the tree has the whole avatar as its one child.
void MeshletCandidates::descend(std::size_t level, std::size_t node) {
  const std::size_t below = level - 1;
  const std::size_t first = node * kMeshletFanout;
  std::array<SkinBox, kMeshletFanout> boxes;
  const std::size_t count = std::min(kMeshletFanout, meshlets_.nodes(below) - first);
  bounds_.boxes(below, first, std::span(boxes).first(count));
  SegmentBoxes& met = of_level_[below];
  for (std::size_t i = 0; i < count; ++i) {
    of_level_[level].meet(boxes[i], met);
    if (met.size() == 0) continue;
    if (below > 0) {
      descend(below, first + i);
      continue;
    }
    touched_.push_back({static_cast<std::uint32_t>(first + i), static_cast<std::uint32_t>(segments_.size()),
                        static_cast<std::uint32_t>(met.size())});
    segments_.insert(segments_.end(), met.numbers().begin(), met.numbers().end());
  }
}

}  // namespace vestige
