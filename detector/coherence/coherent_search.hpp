#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <optional>
#include <vector>

#include "detector/broad/meshlet_bounds.hpp"
#include "detector/broad/meshlets.hpp"
#include "detector/coherence/gap_kernels.hpp"
#include "detector/coherence/part_motion.hpp"
#include "detector/frame.hpp"
#include "detector/method.hpp"
#include "detector/ways/cut_ways.hpp"
#include "traces/scene/avatar.hpp"

namespace vestige {

/// A pair of meshlet and segment that the boxes could not tell apart.
struct NearPair {
  std::uint32_t meshlet = 0;
  std::uint32_t segment = 0;  ///< number in DetectorFrame::segments
  bool may_meet = false;      ///< in this frame; otherwise only a better bound is wanted
  float gap_m = 0;            ///< at least how far the segment's end is from the meshlet's triangles
  float spent_m = 0;          ///< a larger gap than this proves that the pair is apart in this frame
  std::uint32_t root = 0;     ///< for the search alone
};

/// The broad phase with temporal coherence: what was proven apart a moment ago is looked at again only when that proof
/// is spent. For each collider and each part of the skin (a node of `Meshlets`) it keeps a lower bound of the distance
/// between them, and in each frame takes away upper bounds of how far both moved.
///
/// It begins anew where a frame does not follow the one before, and at frame numbers divisible by kRestart: so what it
/// finds does not depend on where a pass over a trace begins.
class CoherentSearch {
 public:
  static constexpr std::uint64_t kRestart = 256;

  /// Keeps a reference to `meshlets`.
  CoherentSearch(const Avatar& avatar, const Meshlets& meshlets);

  /// Finds the pairs of the frame that may meet, and some that are near. A pair that is not in `pairs` with `may_meet`
  /// surely misses, bit for bit. `ways` are the frame's.
  /// Returns false, and forgets everything, where looking at everything costs less: in a frame that does not follow the
  /// one before or that begins anew, while most of it moves far, and while too much is near.
  bool find(const DetectorFrame& frame, const Ways& ways, Method method);

  /// The pairs of the last `find`. Whoever knows a larger `gap_m` writes it there, before `learn`.
  std::span<NearPair> pairs() { return pairs_; }

  /// Remembers how far the pairs are apart. `skinned` is the number of patches that had to be skinned for that.
  void learn(std::uint64_t skinned);

  /// How far the skin of a meshlet can have moved since `then`, an earlier `clock` of it, in metres.
  float moved_m(std::size_t meshlet, std::int32_t then) const { return since(meshlet / meshlets_a_part_, then); }
  std::int32_t clock(std::size_t meshlet) const { return parts_.clock[meshlet / meshlets_a_part_]; }
  /// Error of the computed skin, which a gap from it must be smaller by.
  float pad_m() const { return pad_m_; }
  std::size_t parts() const { return static_cast<std::size_t>(std::popcount(parts_.existing)); }
  /// The number of pairs of collider and part that the last `find` needed not look at.
  std::uint64_t spared() const { return spared_; }
  /// Grows whenever all that was known is forgotten, earlier clocks included.
  std::uint64_t restarts() const { return restarts_; }

 private:
  static constexpr float kFarFrames = 4;
  static constexpr float kNearFrames = 3;
  static constexpr float kStale_m = 0.004F;

  struct Node {
    NodeBoxes boxes;
    std::int32_t clock = -1;  ///< of its part, when the boxes were computed; -1: never
  };

  /// What was paid since the last restart, and what would have been paid for looking at everything.
  struct WarmCosts {
    std::uint64_t frames = 0;
    std::uint64_t cost = 0;
    std::uint64_t cost_anew = 0;
    std::uint64_t meeting_cost = 0;  ///< part of the latter that pairs cause, in each frame
  };

  struct alignas(64) DistanceBlock {
    std::array<std::int32_t, kPartBlock> units = {};
  };
  std::int32_t* distances() { return distance_.empty() ? nullptr : distance_.front().units.data(); }

  bool begin(const DetectorFrame& frame, Method method);
  void look_below(std::size_t level);
  void restart(std::size_t columns);
  void compare_costs(std::uint64_t skinned);
  void refresh(std::size_t level, std::size_t node, std::size_t part);
  float since(std::size_t part, std::int32_t then) const {
    return static_cast<float>(parts_.clock[part] - then) * (kGapUnit_m * kGapUp);
  }
  float carried_m(std::size_t part) const { return method_ == Method::kCarried ? parts_.step_m[part] : 0; }
  Node& node_of(std::size_t level, std::size_t node) { return nodes_[first_node_[level] + node]; }

  const Meshlets& meshlets_;
  MeshletBounds bounds_;
  std::size_t level_;  ///< of the parts
  std::size_t meshlets_a_part_ = 1;
  PartMotion motion_;
  Method method_ = Method::kStatic;

  std::uint64_t restarts_ = 0;
  std::uint64_t spared_ = 0;
  std::size_t colliders_ = 0;        ///< in the last frame
  std::uint64_t boxes_meeting_ = 0;  ///< pairs of meshlet and segment that the boxes could not tell apart, likewise
  bool is_fast_ = false;             ///< too much moved; until a frame number divisible by kTryAgain
  bool is_dense_ = false;            ///< so much is near that remembering costs more than it saves; until kRestart
  WarmCosts warm_;
  std::optional<std::uint64_t> last_index_;
  std::vector<SkinMatrix> palette_;  ///< of the last frame
  float pad_m_ = 0;
  float reserve_m_ = 0;  ///< what every proof of this frame must leave over: errors of the skin

  PartList parts_;
  std::vector<std::size_t> first_node_;  ///< of each level, in nodes_
  std::vector<Node> nodes_;
  std::vector<Follower> followers_;  ///< by column
  std::vector<Due> due_;
  std::vector<GapQuery> queries_;        ///< of those that are due
  std::vector<NodePair> roots_;          ///< pairs of collider and part that are near
  std::vector<float> least_m_;           ///< of each of them: the least distance found so far
  std::vector<NodePair> level_pairs_;    ///< of the level that `find` is at
  std::vector<NodePair> below_;          ///< of the next one
  std::vector<const NodeBoxes*> boxes_;  ///< of those
  std::vector<float> near_m_;            ///< likewise
  std::vector<NearChild> children_;
  std::vector<NearPair> pairs_;
  std::vector<DistanceBlock> distance_;  ///< Known::distances
};

}  // namespace vestige
