#include "detector/broad/meshlet_candidates.hpp"

#include <algorithm>
#include <array>

namespace vestige {

static_assert(kMeshletFanout <= SegmentBoxes::kMostTested);

MeshletCandidates::MeshletCandidates(const Avatar& avatar, const Meshlets& meshlets)
    : meshlets_(meshlets), bounds_(avatar, meshlets), segments_of_level_(meshlets.levels() + 1) {}

void MeshletCandidates::find(const DetectorFrame& frame, const Ways& ways, Method method) {
  touched_.clear();
  segments_.clear();
  const std::size_t levels = meshlets_.levels();
  if (levels == 0 || ways.segments.empty()) return;
  bounds_.begin(frame, method);
  for (SegmentBoxes& segments : segments_of_level_) segments.reset(ways.segments.size(), !ways.are_cut.empty());
  SegmentBoxes& all = segments_of_level_[levels];
  for (std::uint32_t i = 0; i < ways.segments.size(); ++i) {
    if (ways.is_cut(i)) {
      all.add_cut(ways.segments[i], i);
    } else {
      all.add(ways.segments[i], i);
    }
  }
  descend(levels, 0);
}

/// Tests the children of a node of `level`. The node above the tree has the whole avatar as its only child.
void MeshletCandidates::descend(std::size_t level, std::size_t node) {
  const std::size_t below = level - 1;
  const std::size_t first = node * kMeshletFanout;
  const std::size_t count = std::min(kMeshletFanout, meshlets_.nodes(below) - first);
  std::array<SkinBox, kMeshletFanout> boxes;
  bounds_.boxes(below, first, std::span(boxes).first(count));
  SegmentBoxes& segments = segments_of_level_[level];
  segments.test(std::span(boxes).first(count));
  for (std::size_t i = 0; i < count; ++i) {
    if (below > 0) {
      if (segments_of_level_[below].take_met(segments, i)) descend(below, first + i);
      continue;
    }
    const std::size_t first_segment = segments_.size();
    segments.append_met(i, segments_);
    if (segments_.size() == first_segment) continue;
    touched_.push_back({static_cast<std::uint32_t>(first + i), static_cast<std::uint32_t>(first_segment),
                        static_cast<std::uint32_t>(segments_.size() - first_segment)});
  }
}

}  // namespace vestige
