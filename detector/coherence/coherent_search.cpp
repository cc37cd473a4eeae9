#include "detector/coherence/coherent_search.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <glm/geometric.hpp>
#include <limits>
#include <span>

namespace vestige {

namespace {

/// If most colliders and the parts of the skin move more than that together, proofs are spent too soon.
constexpr float kFast_m = 0.005F;
/// Then frames are searched anew until a number divisible by this.
constexpr std::uint64_t kTryAgain = 64;
/// What a search that remembers pays for each collider, each one that is due, each pair that is near, and each patch
/// that has to be skinned. In nanoseconds, measured with the built-in avatar on an AMD EPYC, as below.
constexpr std::uint64_t kFollowedCost = 8;
constexpr std::uint64_t kDueCost = 130;
constexpr std::uint64_t kNearCost = 60;
constexpr std::uint64_t kSkinnedCost = 350;
/// What one that begins anew pays at all, and for each collider, each pair that the boxes cannot tell apart, and each
/// patch that has such pairs.
constexpr std::uint64_t kAnewCost = 6000;
constexpr std::uint64_t kColliderCost = 12;
constexpr std::uint64_t kMeetingCost = 38;
constexpr std::uint64_t kTouchedCost = 100;
/// Frames after a restart before both are compared.
constexpr std::uint64_t kWarmFrames = 8;

/// Part boxes of this age are computed again.
constexpr float kOld_m = 0.03F;

/// Number of nodes of a level. Above a tree of one meshlet stands one node.
std::size_t nodes_of(const Meshlets& meshlets, std::size_t level) {
  return level < meshlets.levels() ? meshlets.nodes(level) : 1;
}

/// Whether more than half of the colliders move farther than `limit_m`.
bool most_move_farther(std::span<const Segment> segments, float limit_m) {
  const auto moves = [&](const Segment& segment) { return glm::distance(segment.start, segment.end) > limit_m; };
  return 2 * static_cast<std::size_t>(std::ranges::count_if(segments, moves)) > segments.size();
}

std::size_t level_of_parts(const Meshlets& meshlets) {
  std::size_t level = 1;
  while (nodes_of(meshlets, level) > kMostParts) ++level;
  return level;
}

}  // namespace

CoherentSearch::CoherentSearch(const Avatar& avatar, const Meshlets& meshlets)
    : meshlets_(meshlets),
      bounds_(avatar, meshlets),
      level_(level_of_parts(meshlets)),
      motion_(avatar, meshlets, std::min(level_, std::max<std::size_t>(meshlets.levels(), 1) - 1)) {
  for (std::size_t level = 0; level < level_; ++level) meshlets_a_part_ *= kMeshletFanout;
  std::size_t nodes = 0;
  for (std::size_t level = 0; level <= level_; ++level) {
    first_node_.push_back(nodes);
    if (level > 0) nodes += nodes_of(meshlets, level);
  }
  nodes_.resize(nodes);
  parts_.existing = ~std::uint64_t{0} >> (kMostParts - nodes_of(meshlets, level_));
  parts_.boxes.put_nowhere();
  parts_.grown_m.fill(0);
  parts_.step_m.fill(0);
  parts_.clock.fill(0);
  parts_.count = (nodes_of(meshlets, level_) + kPartBlock - 1) / kPartBlock * kPartBlock;
}

void CoherentSearch::restart(std::size_t columns) {
  ++restarts_;
  warm_ = {};
  parts_.clock.fill(0);
  for (Node& node : nodes_) node.clock = -1;
  followers_.assign(columns, Follower());
  distance_.assign(columns * parts_.count / kPartBlock, DistanceBlock());
}

bool CoherentSearch::begin(const DetectorFrame& frame, Method method) {
  const std::span<const SkinMatrix> before = method == Method::kStatic ? palette_ : frame.palette_before;
  const bool is_same =
      before.size() == frame.palette.size() &&
      (method == Method::kStatic ||
       (palette_.size() == before.size() && std::memcmp(palette_.data(), before.data(), before.size_bytes()) == 0));
  bool follows = is_same && last_index_ && *last_index_ + 1 == frame.index && frame.index % kRestart != 0 &&
                 method == method_ && frame.columns == followers_.size();
  // Nothing moves within a static frame.
  std::span<const float> steps;
  if (method != Method::kStatic || follows) steps = motion_.between(before, frame.palette);
  float all_steps_m = 0;
  for (const float step_m : steps) {
    follows = follows && step_m < kFarthest_m;
    all_steps_m += step_m;
  }
  palette_.assign(frame.palette.begin(), frame.palette.end());
  const bool goes_on = last_index_ && *last_index_ + 1 == frame.index;
  last_index_ = frame.index;
  method_ = method;
  if (!goes_on || frame.index % kTryAgain == 0) is_fast_ = false;
  const bool is_new = !goes_on || frame.index % kRestart == 0;
  if (is_new) is_dense_ = false;
  const float mean_step_m = all_steps_m / static_cast<float>(std::max<std::size_t>(steps.size(), 1));
  is_fast_ = is_fast_ || most_move_farther(frame.segments, kFast_m - mean_step_m);
  if (is_new || is_fast_ || is_dense_) {  // perhaps nobody asks for the frame after a new one
    followers_.clear();                   // so that the next frame does not follow
    return false;
  }
  bounds_.begin(frame, method);
  if (!follows) restart(frame.columns);
  const float pad_m = bounds_.pad_m();
  pad_m_ = follows ? std::max(pad_m_, pad_m) : pad_m;
  reserve_m_ = pad_m_ + 2 * kGapUnit_m;
  float carried_most_m = 0;
  for (std::size_t part = 0; part < nodes_of(meshlets_, level_); ++part) {
    parts_.step_m[part] = steps.empty() ? 0 : steps[part];
    if (follows) parts_.clock[part] += units_up(parts_.step_m[part]);
    const Node& node = node_of(level_, part);
    if (node.clock < 0 || since(part, node.clock) > kOld_m) refresh(level_, part, part);
    carried_most_m = std::max(carried_most_m, carried_m(part));
    parts_.grown_m[part] = since(part, node.clock) + carried_m(part) + pad_m_;
  }
  due_.resize(frame.segments.size() + 1);
  due_.resize(follow_segments(parts_, frame.segments, frame.index, reserve_m_ + carried_most_m,
                              {followers_.data(), distances()}, due_.data()));
  colliders_ = frame.segments.size();
  spared_ = colliders_ * nodes_of(meshlets_, level_);
  for (const Due& due : due_) spared_ -= static_cast<std::uint64_t>(std::popcount(due.parts));
  return true;
}

bool CoherentSearch::find(const DetectorFrame& frame, const Ways& ways, Method method) {
  pairs_.clear();
  roots_.clear();
  boxes_meeting_ = 0;
  if (meshlets_.levels() == 0) return true;
  if (!begin(frame, method)) return false;
  queries_.resize(due_.size());
  for (std::size_t i = 0; i < due_.size(); ++i) {
    const Segment& segment = frame.segments[due_[i].segment];
    GapQuery& query = queries_[i];
    query.end = segment.end;
    query.box = box_of(ways.segments[due_[i].segment]);
    query.reach_m = due_[i].way_m + bounding_radius_m(segment) + reserve_m_;
    query.own_clock = followers_[segment.column].own_clock;
    query.column = segment.column;
  }
  find_near_parts(parts_, due_, queries_, kFarFrames, distances(), roots_);
  least_m_.assign(roots_.size(), std::numeric_limits<float>::max());
  level_pairs_ = roots_;
  for (std::size_t level = level_; level > 0; --level) look_below(level);
  return true;
}

/// Replaces the pairs by those of the level below that are near.
void CoherentSearch::look_below(std::size_t level) {
  boxes_.clear();
  near_m_.clear();
  for (const NodePair& pair : level_pairs_) {
    const std::size_t part = roots_[pair.root].node;
    Node& node = node_of(level, pair.node);
    if (node.clock < 0 || since(part, node.clock) > kStale_m) refresh(level, pair.node, part);
    node.boxes.grown_m = since(part, node.clock) + carried_m(part) + pad_m_;
    boxes_.push_back(&node.boxes);
    near_m_.push_back(kNearFrames * (queries_[pair.due].reach_m + parts_.step_m[part]));
  }
  children_.clear();
  find_near_children(level_pairs_, boxes_.data(), queries_, near_m_.data(), least_m_.data(), children_);
  if (level > 1) {
    below_.resize(children_.size());
    for (std::size_t i = 0; i < children_.size(); ++i) {
      const NodePair& pair = level_pairs_[children_[i].pair];
      below_[i] = {pair.due, children_[i].child, pair.root};
    }
    level_pairs_.swap(below_);
    return;
  }
  pairs_.resize(children_.size());
  for (std::size_t i = 0; i < children_.size(); ++i) {
    const NearChild& child = children_[i];
    const NodePair& pair = level_pairs_[child.pair];
    NearPair& out = pairs_[i];
    out.meshlet = child.child;
    out.segment = due_[pair.due].segment;
    out.may_meet = child.may_meet;
    boxes_meeting_ += child.may_meet ? 1U : 0U;
    out.gap_m = child.gap_m;
    out.spent_m = near_m_[child.pair] / kNearFrames * kGapUp;
    out.root = pair.root;
  }
}

void CoherentSearch::learn(std::uint64_t skinned) {
  compare_costs(skinned);
  for (const NearPair& pair : pairs_) least_m_[pair.root] = std::min(least_m_[pair.root], pair.gap_m);
  for (std::size_t i = 0; i < roots_.size(); ++i) {
    const std::size_t part = roots_[i].node;
    const GapQuery& query = queries_[roots_[i].due];
    std::int32_t& distance = distances()[query.column * parts_.count + part];
    const float gap_m = std::clamp(least_m_[i], 0.0F, kLargestGap_m);
    distance =
        std::max(distance, static_cast<std::int32_t>(gap_m * (1 / kGapUnit_m)) + parts_.clock[part] + query.own_clock);
  }
}

void CoherentSearch::compare_costs(std::uint64_t skinned) {
  if (warm_.frames++ == 0) {  // it knew nothing, and looked at all that one that begins anew looks at
    const std::uint64_t touched = std::min<std::uint64_t>(meshlets_.size(), boxes_meeting_);
    warm_.meeting_cost = kMeetingCost * boxes_meeting_ + kTouchedCost * touched;
    return;
  }
  warm_.cost +=
      kFollowedCost * colliders_ + kDueCost * due_.size() + kNearCost * pairs_.size() + kSkinnedCost * skinned;
  warm_.cost_anew += kAnewCost + kColliderCost * colliders_ + warm_.meeting_cost;
  is_dense_ = warm_.frames > kWarmFrames && warm_.cost > warm_.cost_anew;
}

void CoherentSearch::refresh(std::size_t level, std::size_t node, std::size_t part) {
  Node& of = node_of(level, node);
  const std::size_t first = node * kMeshletFanout;
  const std::size_t count = std::min(kMeshletFanout, nodes_of(meshlets_, level - 1) - first);
  of.boxes.children.put_nowhere();
  of.boxes.existing = (1U << count) - 1;
  std::array<SkinBox, kMeshletFanout> out;
  bounds_.boxes(level - 1, first, std::span(out).first(count));
  for (int axis = 0; axis < 3; ++axis) {
    const auto a = static_cast<std::size_t>(axis);
    for (std::size_t i = 0; i < count; ++i) {
      of.boxes.children.low[a][i] = out[i].low[axis];
      of.boxes.children.high[a][i] = out[i].high[axis];
    }
    if (level != level_) continue;
    parts_.boxes.low[a][part] = *std::ranges::min_element(of.boxes.children.low[a]);
    parts_.boxes.high[a][part] = *std::ranges::max_element(of.boxes.children.high[a]);
  }
  of.clock = parts_.clock[part];
  if (level == level_) parts_.grown_m[part] = carried_m(part) + pad_m_;
}

}  // namespace vestige
