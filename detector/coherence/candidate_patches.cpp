#include "detector/coherence/candidate_patches.hpp"

#include <algorithm>
#include <cassert>
#include <numeric>

namespace vestige {

CandidatePatches::CandidatePatches(const Avatar& avatar, const Meshlets& meshlets, Method method)
    : meshlets_(meshlets),
      method_(method),
      meshlet_skin_(avatar, meshlets),
      anew_(avatar, meshlets),
      search_(avatar, meshlets),
      when_(meshlets.size()),
      triangles_(meshlets.size()) {}

void CandidatePatches::find(const DetectorFrame& frame, StageClock* clock) {
  enter_stage(clock, Stage::kCandidates);
  ++calls_;
  begin();
  ways_ = cutter_.cut(frame);
  is_anew_ = !search_.find(frame, ways_, method_);
  if (is_anew_) {
    anew_.find(frame, ways_, method_);
    found_.touched.assign(anew_.touched().begin(), anew_.touched().end());
    found_.numbers.assign(anew_.segments().begin(), anew_.segments().end());
    work_.meshlets_skinned = touched().size();
  } else {
    look_closer(frame, clock);
    search_.learn(work_.meshlets_skinned);
    list_touched();
  }
  count_work(frame);
}

void CandidatePatches::take_all(const DetectorFrame& frame, StageClock* clock) {
  enter_stage(clock, Stage::kSkinning);
  ways_ = {frame.segments, {}};
  is_anew_ = false;
  begin();
  found_.numbers.resize(frame.segments.size());
  std::iota(found_.numbers.begin(), found_.numbers.end(), 0U);
  for (std::uint32_t meshlet = 0; meshlet < meshlets_.size(); ++meshlet)
    found_.touched.push_back({meshlet, 0, static_cast<std::uint32_t>(found_.numbers.size())});
  count_pairs();
}

void CandidatePatches::begin() {
  work_ = DetectorWork();
  found_.touched.clear();
  found_.numbers.clear();
  found_.places.clear();
  skinned_ = 0;
}

void CandidatePatches::count_work(const DetectorFrame& frame) {
  work_.part_pairs = frame.segments.size() * search_.parts();
  if (!is_anew_) work_.pairs_spared = search_.spared();
  work_.frames_skipped = touched().empty() ? 1 : 0;
  count_pairs();
}

void CandidatePatches::count_pairs() {
  for (const TouchedMeshlet& one : touched()) {
    const std::size_t triangles = meshlets_.triangles(one.meshlet).size();
    work_.triangles_tested += triangles;
    work_.pairs_tested += triangles * one.count;
  }
}

void CandidatePatches::skin_touched(const DetectorFrame& frame, std::size_t i) {
  assert(i <= found_.places.size());
  if (i == found_.places.size()) found_.places.push_back(skin(frame, touched()[i].meshlet));
}

void CandidatePatches::look_closer(const DetectorFrame& frame, StageClock* clock) {
  const std::span<NearPair> pairs = search_.pairs();
  ask_.clear();
  for (std::uint32_t i = 0; i < pairs.size(); ++i)
    if (when_[pairs[i].meshlet].restart == search_.restarts()) ask_.push_back(i);
  bound_gaps(frame);
  ask_.clear();
  enter_stage(clock, Stage::kSkinning);
  for (std::uint32_t i = 0; i < pairs.size(); ++i) {
    if (!pairs[i].may_meet) continue;
    const std::size_t meshlet = pairs[i].meshlet;
    if (when_[meshlet].call != calls_) {
      const std::uint32_t place = skin(frame, meshlet);
      const MeshletCorners& now = found_.now[place];
      triangles_[meshlet].bound(now, method_ == Method::kStatic ? now : found_.before[place], method_);
      ++work_.meshlets_skinned;
      when_[meshlet] = {calls_, search_.restarts(), search_.clock(meshlet), place};
    }
    ask_.push_back(i);
  }
  enter_stage(clock, Stage::kCandidates);
  bound_gaps(frame);
}

/// Asks the triangles of the pairs in `ask_` how far they are away, as they were skinned last.
void CandidatePatches::bound_gaps(const DetectorFrame& frame) {
  const std::span<NearPair> pairs = search_.pairs();
  gaps_.resize(ask_.size());
  for (std::size_t k = 0; k < ask_.size(); ++k) {
    const NearPair& pair = pairs[ask_[k]];
    gaps_[k].bounds = &triangles_[pair.meshlet].bounds();
    gaps_[k].point = frame.segments[pair.segment].end;
  }
  find_triangle_gaps(gaps_);
  for (std::size_t k = 0; k < ask_.size(); ++k) {
    NearPair& pair = pairs[ask_[k]];
    const float moved_m = search_.moved_m(pair.meshlet, when_[pair.meshlet].clock) + search_.pad_m();
    pair.gap_m = std::max(pair.gap_m, gaps_[k].gap_m - moved_m);
    pair.may_meet = pair.may_meet && pair.gap_m <= pair.spent_m;
  }
}

/// Returns the place of the meshlet's corners.
std::uint32_t CandidatePatches::skin(const DetectorFrame& frame, std::size_t meshlet) {
  const std::uint32_t place = skinned_++;
  if (place == found_.now.size()) {
    found_.now.emplace_back();
    if (method_ != Method::kStatic) found_.before.emplace_back();
  }
  meshlet_skin_.skin(meshlet, frame.palette, found_.now[place]);
  if (method_ != Method::kStatic) meshlet_skin_.skin(meshlet, frame.palette_before, found_.before[place]);
  return place;
}

void CandidatePatches::list_touched() {
  order_.clear();
  for (const NearPair& pair : search_.pairs())
    if (pair.may_meet) order_.push_back(std::uint64_t{pair.meshlet} << 32U | pair.segment);
  std::ranges::sort(order_);
  for (const std::uint64_t pair : order_) {
    const auto meshlet = static_cast<std::uint32_t>(pair >> 32U);
    if (found_.touched.empty() || found_.touched.back().meshlet != meshlet) {
      found_.touched.push_back({meshlet, static_cast<std::uint32_t>(found_.numbers.size()), 0});
      found_.places.push_back(when_[meshlet].place);
    }
    ++found_.touched.back().count;
    found_.numbers.push_back(static_cast<std::uint32_t>(pair));
  }
}

const MeshletTriangles& CandidatePatches::triangles(std::size_t i) {
  if (!is_anew_) return triangles_[touched()[i].meshlet];
  bounded_.bound(now(i), before(i), method_);
  return bounded_;
}

}  // namespace vestige
