#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "detector/broad/meshlet_candidates.hpp"
#include "detector/broad/meshlet_skin.hpp"
#include "detector/broad/meshlet_triangles.hpp"
#include "detector/broad/meshlets.hpp"
#include "detector/coherence/coherent_search.hpp"
#include "detector/coherence/found_patches.hpp"
#include "detector/detector.hpp"
#include "detector/frame.hpp"
#include "detector/method.hpp"
#include "detector/stages.hpp"
#include "detector/ways/cut_ways.hpp"
#include "traces/scene/avatar.hpp"

namespace vestige {

/// The broad phase of detectors that skip: finds which segments may meet which meshlets, and skins those. A pair that
/// is not listed surely misses, bit for bit.
///
/// Where it costs less, the search remembers what it proved, and the skin of an earlier frame proves much of this one.
/// Elsewhere the tree is searched from the top.
class CandidatePatches {
 public:
  /// Keeps references to `avatar` and `meshlets`.
  CandidatePatches(const Avatar& avatar, const Meshlets& meshlets, Method method);

  /// Charges its time to the stages of `clock`, which may be null.
  void find(const DetectorFrame& frame, StageClock* clock);

  /// Takes every segment and every meshlet for candidates. For detectors that do not skip.
  void take_all(const DetectorFrame& frame, StageClock* clock);

  /// What was tested in place of the frame's segments. Valid while the frame is.
  const Ways& ways() const { return ways_; }
  /// The meshlets of the last `find`, in ascending order. Each has at least one segment.
  std::span<const TouchedMeshlet> touched() const { return found_.touched; }
  /// Numbers in DetectorFrame::segments, ascending.
  std::span<const std::uint32_t> segments(const TouchedMeshlet& touched) const { return found_.segments(touched); }
  /// Skins the meshlet of touched()[i], unless the search did. Before `now`, `before` or `triangles` of it, in order.
  void skin_touched(const DetectorFrame& frame, std::size_t i);
  /// Where the meshlet of touched()[i] is, in this frame and in the one before. With kStatic both are the same.
  const MeshletCorners& now(std::size_t i) const { return found_.now_of(i); }
  const MeshletCorners& before(std::size_t i) const { return found_.before_of(i); }
  /// Bounds of its triangles, valid until the next call.
  const MeshletTriangles& triangles(std::size_t i);

  /// The work of the last `find`, and that of testing what it found.
  const DetectorWork& work() const { return work_; }

  /// Gives away what the last `find` found, for as long as the caller keeps it, and takes memory for the next `find`.
  void swap_found(FoundPatches& found) { std::swap(found_, found); }

 private:
  /// When a meshlet was skinned last.
  struct SkinnedWhen {
    std::uint64_t call = 0;     ///< from 1 on
    std::uint64_t restart = 0;  ///< of the search: earlier ones say nothing
    std::int32_t clock = 0;     ///< of its part
    std::uint32_t place = 0;    ///< of its corners
  };

  void begin();
  void look_closer(const DetectorFrame& frame, StageClock* clock);
  void bound_gaps(const DetectorFrame& frame);
  std::uint32_t skin(const DetectorFrame& frame, std::size_t meshlet);
  void list_touched();
  void count_work(const DetectorFrame& frame);
  void count_pairs();

  const Meshlets& meshlets_;
  Method method_;
  MeshletSkin meshlet_skin_;
  MeshletCandidates anew_;
  CoherentSearch search_;
  WayCutter cutter_;
  Ways ways_;
  bool is_anew_ = false;  ///< the last `find`

  std::uint64_t calls_ = 0;
  DetectorWork work_;
  FoundPatches found_;
  std::uint32_t skinned_ = 0;  ///< places of `found_` that are taken
  std::vector<SkinnedWhen> when_;
  std::vector<MeshletTriangles> triangles_;
  MeshletTriangles bounded_;        ///< if anew
  std::vector<std::uint32_t> ask_;  ///< numbers of the search's pairs
  std::vector<TriangleGap> gaps_;
  std::vector<std::uint64_t> order_;  ///< of the pairs: meshlet, then segment
};

}  // namespace vestige
