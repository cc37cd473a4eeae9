#include "analysis/mapping/body.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <set>

#include "traces/scene/pose.hpp"

namespace vestige {

namespace {

constexpr double kVestLow = 0.045;
constexpr double kVestHigh = 0.955;

/// An adult's heights as shares of the body's height: ankles, knees, crotch, neck, chin.
constexpr double kAnkles = 0.05;
constexpr double kKnees = 0.28;
constexpr double kCrotch = 0.48;
constexpr double kNeck = 0.83;
constexpr double kChin = 0.87;
constexpr double kShoulder = 0.115;  // from the middle outwards; elbow and wrist:
constexpr double kElbow = 0.27;
constexpr double kWrist = 0.40;
/// A body that is 1.3 times wider than this share of its height holds its arms out.
constexpr double kArmsHang = 0.35;

struct Reach {
  double low = std::numeric_limits<double>::infinity();
  double high = -std::numeric_limits<double>::infinity();

  void add(double value) {
    low = std::min(low, value);
    high = std::max(high, value);
  }
  bool is_empty() const { return low > high; }
};

}  // namespace

Body::Body(const Avatar& avatar) : surface_(avatar), parts_of_nodes_(vestige::parts_of_nodes(avatar)) {
  weigh_parts();
  settle_islands();
  if (!is_understood()) {
    understanding_ = Understanding::kProportions;
    part_weights_.clear();
  }
  middle_x_m_ = middle_m(turned_from_front({1, 0, 0}, avatar.facing.axis));
  find_vest();
}

void Body::weigh_parts() {
  for (const Influences& influences : avatar().influences) {
    auto& weights = part_weights_.emplace_back();
    for (std::size_t k = 0; k < kMaxInfluences && influences.weight[k] > 0; ++k) {
      const auto node = static_cast<std::size_t>(avatar().palette[influences.palette[k]].node);
      // A node without a part, such as a root, counts as the trunk on which the rest hangs.
      const SkinPart part = parts_of_nodes_[node].value_or(SkinPart::kTorso);
      weights[static_cast<std::size_t>(part)] += influences.weight[k];
    }
  }
}

/// An island is smaller than a fifth of its part's largest piece, so that the other hand is not an island.
constexpr std::size_t kIslandsInLargest = 5;

/// Vertices at one place count once, since they have the same weights.
void Body::settle_islands() {
  const auto strongest = [](const std::array<float, kSkinParts>& weights) {
    return static_cast<std::size_t>(std::ranges::max_element(weights) - weights.begin());
  };
  std::vector<std::size_t> part(surface_.place_count(), 0);
  std::vector<std::set<std::uint32_t>> beside(surface_.place_count());
  for (std::uint32_t i = 0; i < avatar().triangles.size(); ++i) {
    const glm::uvec3 places = surface_.places(i);
    for (int corner = 0; corner < 3; ++corner) {
      part[places[corner]] = strongest(part_weights_[avatar().triangles[i][corner]]);
      beside[places[corner]].insert({places[(corner + 1) % 3], places[(corner + 2) % 3]});
    }
  }
  std::vector<std::vector<std::uint32_t>> pieces;
  std::array<std::size_t, kSkinParts> largest = {};
  std::vector<bool> seen(part.size(), false);
  for (std::uint32_t first = 0; first < part.size(); ++first) {
    if (seen[first]) continue;
    seen[first] = true;
    auto& piece = pieces.emplace_back(1, first);
    for (std::size_t i = 0; i < piece.size(); ++i)
      for (const std::uint32_t next : beside[piece[i]])
        if (!seen[next] && part[next] == part[first]) {
          seen[next] = true;
          piece.push_back(next);
        }
    largest[part[first]] = std::max(largest[part[first]], piece.size());
  }
  std::vector<std::optional<std::size_t>> settled(part.size());
  for (const auto& piece : pieces) {
    if (kIslandsInLargest * piece.size() >= largest[part[piece.front()]]) continue;
    std::array<std::size_t, kSkinParts> around = {};
    for (const std::uint32_t place : piece)
      for (const std::uint32_t next : beside[place])
        if (part[next] != part[place]) ++around[part[next]];
    const auto most = std::ranges::max_element(around);
    // A piece that touches no other part, such as a sword, keeps its joint's part.
    if (*most == 0) continue;
    for (const std::uint32_t place : piece) settled[place] = static_cast<std::size_t>(most - around.begin());
  }
  for (std::uint32_t i = 0; i < avatar().triangles.size(); ++i)
    for (int corner = 0; corner < 3; ++corner)
      if (const auto& to = settled[surface_.places(i)[corner]]) {
        auto& weights = part_weights_[avatar().triangles[i][corner]];
        weights = {};
        weights[*to] = 1;
      }
}

/// Returns whether the joints name a torso and at least two of: head or neck, arms, legs.
bool Body::is_understood() const {
  std::array<bool, kSkinParts> named = {};
  for (const PaletteEntry& entry : avatar().palette)
    if (const auto part = parts_of_nodes_[static_cast<std::size_t>(entry.node)])
      named[static_cast<std::size_t>(*part)] = true;
  const auto any = [&](SkinPart first, SkinPart last) {
    return std::any_of(named.begin() + static_cast<std::ptrdiff_t>(first),
                       named.begin() + static_cast<std::ptrdiff_t>(last) + 1, [](bool is) { return is; });
  };
  const int limbs = int{any(SkinPart::kNeck, SkinPart::kHead)} + int{any(SkinPart::kUpperArm, SkinPart::kHand)} +
                    int{any(SkinPart::kThigh, SkinPart::kFoot)};
  return any(SkinPart::kTorso, SkinPart::kTorso) && limbs >= 2;
}

SkinPart Body::part_by_proportions(const glm::dvec3& position_m) const {
  const Box& bounds = surface_.bounds();
  const double height_m = surface_.height_m();
  const double y = (position_m.y - bounds.low.y) / height_m;
  const glm::dvec3 from_middle = turned(position_m - (bounds.low + bounds.high) / 2.0);
  const double beside = std::abs(from_middle.x) / height_m;
  const bool arms_out = std::abs(turned(bounds.extent()).x) > kArmsHang * height_m * 1.3;
  if (arms_out && y > kCrotch * 0.8 && y < kChin && beside > kShoulder) {
    if (beside > kWrist) return SkinPart::kHand;
    return beside > kElbow ? SkinPart::kForearm : SkinPart::kUpperArm;
  }
  if (y >= kChin) return SkinPart::kHead;
  if (y >= kNeck) return SkinPart::kNeck;
  if (y >= kCrotch) return SkinPart::kTorso;
  if (y >= kKnees) return SkinPart::kThigh;
  return y >= kAnkles ? SkinPart::kShin : SkinPart::kFoot;
}

SkinPart Body::part_at(const SkinPoint& point) const {
  if (understanding_ == Understanding::kProportions) return part_by_proportions(surface_.position_m(point));
  const glm::uvec3& corner = avatar().triangles[point.triangle];
  const auto& a = part_weights_[corner.x];
  const auto& b = part_weights_[corner.y];
  const auto& c = part_weights_[corner.z];
  std::size_t best = 0;
  double most = -1;
  for (std::size_t i = 0; i < kSkinParts; ++i) {
    const double weight = point.weight.x * double{a[i]} + point.weight.y * double{b[i]} + point.weight.z * double{c[i]};
    if (weight > most) {
      most = weight;
      best = i;
    }
  }
  return static_cast<SkinPart>(best);
}

int Body::node_at(const SkinPoint& point) const {
  struct Weighed {
    int node;
    double weight;
  };
  std::array<Weighed, 3 * kMaxInfluences> nodes = {};
  std::size_t count = 0;
  for (int corner = 0; corner < 3; ++corner) {
    const Influences& influences = avatar().influences[avatar().triangles[point.triangle][corner]];
    for (std::size_t k = 0; k < kMaxInfluences && influences.weight[k] > 0; ++k) {
      const int node = avatar().palette[influences.palette[k]].node;
      const auto end = nodes.begin() + static_cast<std::ptrdiff_t>(count);
      auto found = std::find_if(nodes.begin(), end, [&](const Weighed& other) { return other.node == node; });
      if (found == end) {
        *found = {node, 0};
        ++count;
      }
      found->weight += point.weight[corner] * double{influences.weight[k]};
    }
  }
  // Among equal weights, the lowest node number wins, since corners may come in any order.
  const auto better = [](const Weighed& a, const Weighed& b) {
    return a.weight != b.weight ? a.weight < b.weight : a.node > b.node;
  };
  return std::max_element(nodes.begin(), nodes.begin() + static_cast<std::ptrdiff_t>(count), better)->node;
}

double Body::middle_m(const glm::dvec3& direction) const {
  Reach torso;
  for (std::uint32_t i = 0; i < avatar().triangles.size(); ++i) {
    const SkinPoint middle = {i, glm::dvec3(1.0 / 3)};
    if (part_at(middle) != SkinPart::kTorso) continue;
    for (const glm::dvec3& corner : surface_.corners_m(i)) torso.add(glm::dot(corner, direction));
  }
  if (torso.is_empty()) return glm::dot((surface_.bounds().low + surface_.bounds().high) / 2.0, direction);
  return (torso.low + torso.high) / 2;
}

void Body::find_vest() {
  // Uses the joint nearest to the trunk of each limb: its parent belongs to another part.
  std::vector<glm::dmat4> world;
  const Pose rest = rest_pose(avatar());
  world_matrices(avatar(), rest, world);
  Reach hips;
  Reach necks;
  Reach torso;
  if (understanding_ == Understanding::kJoints)
    for (const PaletteEntry& entry : avatar().palette) {
      const auto i = static_cast<std::size_t>(entry.node);
      const int parent = avatar().nodes[i].parent;
      const auto above = parent < 0 ? std::nullopt : parts_of_nodes_[static_cast<std::size_t>(parent)];
      if (parts_of_nodes_[i] == above) continue;
      const double y_m = world[i][3].y + rest.origin_m.y;
      if (parts_of_nodes_[i] == SkinPart::kThigh) hips.add(y_m);
      if (parts_of_nodes_[i] == SkinPart::kNeck || parts_of_nodes_[i] == SkinPart::kHead) necks.add(y_m);
    }
  for (std::uint32_t i = 0; i < avatar().triangles.size(); ++i) {
    const SkinPoint middle = {i, glm::dvec3(1.0 / 3)};
    if (part_at(middle) == SkinPart::kTorso) torso.add(surface_.position_m(middle).y);
  }
  if (torso.is_empty()) torso = {surface_.bounds().low.y, surface_.bounds().high.y};
  const double low_m = hips.is_empty() ? torso.low : hips.low;
  const double high_m = necks.is_empty() ? torso.high : necks.low;
  const bool upright = low_m < high_m;
  const double from_m = upright ? low_m : torso.low;
  const double to_m = upright ? high_m : torso.high;
  vest_low_m_ = from_m + kVestLow * (to_m - from_m);
  vest_high_m_ = from_m + kVestHigh * (to_m - from_m);
}

}  // namespace vestige
