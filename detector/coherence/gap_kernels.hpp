#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <limits>
#include <span>
#include <vector>

#include "detector/broad/meshlets.hpp"
#include "detector/frame.hpp"

namespace vestige {

/// Most parts that are looked at together, a bit each.
inline constexpr std::size_t kMostParts = 64;
/// Their arrays are filled up to a multiple of this.
inline constexpr std::size_t kPartBlock = 16;

/// Boxes, axis by axis. Those of what is not there are nowhere.
template <std::size_t kCount>
struct alignas(64) BoxList {
  std::array<std::array<float, kCount>, 3> low;
  std::array<std::array<float, kCount>, 3> high;

  void put_nowhere() {
    for (auto& axis : low) axis.fill(std::numeric_limits<float>::infinity());
    for (auto& axis : high) axis.fill(-std::numeric_limits<float>::infinity());
  }
};

/// What the parts of a skin do in a frame. Distances and clocks are in units of kGapUnit_m.
struct alignas(64) PartList {
  std::size_t count = 0;                       ///< a multiple of kPartBlock; parts beyond the last one are nowhere
  std::uint64_t existing = 0;                  ///< a bit for each part
  BoxList<kMostParts> boxes;                   ///< around each part, some time ago
  std::array<float, kMostParts> grown_m;       ///< what each box must grow by to hold the part in all of this frame
  std::array<float, kMostParts> step_m;        ///< how far each part moved in this frame
  std::array<std::int32_t, kMostParts> clock;  ///< how far it moved since the restart
};
inline constexpr float kGapUnit_m = 0x1p-20F;
/// Makes a computed length at least the true one: 16 u, where u = 2^-24.
inline constexpr float kGapUp = 1 + 0x1p-20F;
/// Returns at least `m` in units. Multiplying by a power of two is exact.
inline std::int32_t units_up(float m) {
  return static_cast<std::int32_t>(m * (1 / kGapUnit_m)) + 1;
}
/// Whoever moves farther in a frame is not followed: clocks of a restart then stay far below 2^31 units.
inline constexpr float kFarthest_m = 2;
/// The largest gap that is remembered, likewise.
inline constexpr float kLargestGap_m = 400;

/// A collider in a frame.
struct GapQuery {
  glm::vec3 end;           ///< of its segment, in metres
  SegmentBox box;          ///< of its segment
  float reach_m;           ///< what must be left of a distance, without the part's step, to prove a pair apart
  std::int32_t own_clock;  ///< how far it moved since the restart, in units
  std::uint32_t column;
};

/// What is known of a collider.
struct Follower {
  glm::vec3 end = glm::vec3(0);  ///< of its latest segment
  std::int32_t own_clock = 0;
  std::uint64_t seen = 0;  ///< 1 + index of the frame that had it last
};

/// What is known of all colliders.
struct Known {
  Follower* followers;      ///< by column
  std::int32_t* distances;  ///< by column and part, in units, plus both clocks when it was found
};

/// A collider some of whose distances are spent.
struct Due {
  std::uint32_t segment = 0;  ///< number in the frame
  float way_m = 0;
  std::uint64_t parts = 0;  ///< bits of those to which the distance is spent
};

/// Lets the followers of `segments` take their ways, and writes those of whom distances are spent to `out`; returns how
/// many. A follower that did not end where its segment starts knows no distances. `reserve_m` must be left of each
/// distance, beside the radius.
std::size_t follow_segments(const PartList& parts, std::span<const Segment> segments, std::uint64_t index,
                            float reserve_m, const Known& known, Due* out);

/// A collider and a node of the tree that it is near.
struct NodePair {
  std::uint32_t due = 0;   ///< number of the collider in the list of those that are due
  std::uint32_t node = 0;  ///< of its level
  std::uint32_t root = 0;  ///< number of the pair of collider and part that this one comes from
};

/// Bounds the distances of the colliders that are due to all parts by their boxes; where that is more than `distances`
/// say, it replaces them. Writes the pairs whose distance was spent and that are near: that may meet, or that may in
/// `frames` such frames.
void find_near_parts(const PartList& parts, std::span<const Due> due, std::span<const GapQuery> queries, float frames,
                     std::int32_t* distances, std::vector<NodePair>& out);

/// The boxes of a node's children, and what they must grow by to hold them in all of this frame.
struct NodeBoxes {
  BoxList<kMeshletFanout> children;
  float grown_m = 0;
  std::uint32_t existing = 0;  ///< a bit for each child
};

/// A child that a collider is near.
struct NearChild {
  std::uint32_t pair = 0;   ///< number in the list of pairs
  std::uint32_t child = 0;  ///< number of the node, or of the meshlet
  bool may_meet = false;    ///< in this frame
  float gap_m = 0;          ///< at least how far the collider's end is from it
};

/// Compares the colliders of pairs with the boxes of the children. `boxes[i]` and `near_m[i]` are those of pair i.
/// Writes those that its segment may meet, or that are closer than `near_m`; `least_m[root]` becomes the least distance
/// from all others, if that is less.
void find_near_children(std::span<const NodePair> pairs, const NodeBoxes* const* boxes,
                        std::span<const GapQuery> queries, const float* near_m, float* least_m,
                        std::vector<NearChild>& out);

}  // namespace vestige
