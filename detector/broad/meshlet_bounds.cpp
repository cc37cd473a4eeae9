#include "detector/broad/meshlet_bounds.hpp"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <limits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "detector/broad/meshlet_bounds.cpp"  // NOLINT(bugprone-suspicious-include)
#include <hwy/foreach_target.h>
// After foreach_target.h, which includes this file once for each instruction set.
#include <hwy/highway.h>

#include "detector/broad/transformed_box-inl.hpp"

// The margin `pad` of a computed box. Let u = 2^-24. Let R be the reach of the palette along an axis: the largest |M_0
// x| + |M_1 y| + |M_2 z| + |M_3| of any entry, where |x|, |y|, |z| are the largest values over the vertices that the
// entry moves. No intermediate result is larger than R, apart from factors near 1. Consider a sum of products in which
// each product meets k rounded operations. By the standard model (Higham, Accuracy and Stability of Numerical
// Algorithms, 2nd ed., 2.2 and Lemma 3.1) the sum errs by at most k u / (1 - k u) times the sum of the products'
// magnitudes:
//   skin_vertex        a term meets 2 products, at most 7 sums over influences and 3 over columns: k = 12
//   a box's centre     1 product, 3 sums: k = 4
//   its half extent    1 product, 2 sums: k = 3
//   its ends           1 sum, and 1 for the pad: k = 2 on up to 2 R
// Together this is less than 32 u R. The rest boxes are rounded outwards. `pad` contains 64 u R, which also covers the
// rounding of `pad`.
// Weights: if a vertex's weights sum to s, the vertex lies between s times the low end and s times the high end of the
// box. So the box needs |s - 1| R more. `pad` contains twice the largest |s - 1| of the avatar, times R. With a weight
// below 0, the vertex is not a convex combination. Then no node has bounds.
// Underflow: a product below 2^-126 errs by at most 2^-150. If the product is one of a weight and a matrix, the error
// is multiplied by |x|, |y| or |z|. There are fewer than 64 products, so 2^-116 (1 + |x| + |y| + |z|) is more than
// enough.
HWY_BEFORE_NAMESPACE();
namespace vestige {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using D = BoxTag;
using V = hn::Vec<D>;

struct Ends {
  V low;
  V high;
};

/// Returns the ends along the axes `first` and following, as many as there are lanes.
inline Ends transformed(std::span<const RestBox> boxes, const BoundTransform* transforms, int first) {
  const D d;
  Ends ends = {hn::Set(d, std::numeric_limits<float>::infinity()), hn::Set(d, -std::numeric_limits<float>::infinity())};
  for (const RestBox& box : boxes) {
    const auto [centre, half] = transformed_box(box, transforms[box.entry], first);
    ends.low = hn::Min(ends.low, hn::Sub(centre, half));
    ends.high = hn::Max(ends.high, hn::Add(centre, half));
  }
  return ends;
}

/// Bounds one node, which must have rest boxes; `other` as in MeshletBounds.
inline void bound_node(std::span<const RestBox> boxes, const BoundTransform* now, const BoundTransform* other,
                       Method method, const glm::vec4& pad, SkinBox& out) {
  const D d;
  for (int first = 0; first < 4; first += static_cast<int>(hn::Lanes(d))) {
    Ends ends = transformed(boxes, now, first);
    if (method == Method::kCcd) {
      const Ends before = transformed(boxes, other, first);
      ends = {hn::Min(ends.low, before.low), hn::Max(ends.high, before.high)};
    } else if (method == Method::kCarried) {
      // A start carried by m is at or above `low` only if it was at or above low - m.
      const Ends moved = transformed(boxes, other, first);
      ends.low = hn::Sub(ends.low, hn::Max(moved.high, hn::Zero(d)));
      ends.high = hn::Sub(ends.high, hn::Min(moved.low, hn::Zero(d)));
    }
    const V margin = hn::LoadU(d, &pad[first]);
    hn::Store(hn::Sub(ends.low, margin), d, &out.low[first]);
    hn::Store(hn::Add(ends.high, margin), d, &out.high[first]);
  }
}

void bound_nodes(const Meshlets& meshlets, std::size_t level, std::size_t first, const BoundMotion& motion,
                 std::span<SkinBox> out) {
  // A copy: otherwise the compiler reads the members again after each box that is written.
  const auto [now, other, method, pad] = motion;
  for (std::size_t i = 0; i < out.size(); ++i) {
    const std::span<const RestBox> rest = meshlets.rest_boxes(level, first + i);
    if (rest.empty()) {
      out[i] = {glm::vec4(-std::numeric_limits<float>::infinity()), glm::vec4(std::numeric_limits<float>::infinity())};
    } else {
      bound_node(rest, now, other, method, pad, out[i]);
    }
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace vestige
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vestige {

namespace {

HWY_EXPORT(bound_nodes);

constexpr float kInfinity = std::numeric_limits<float>::infinity();
/// Within this reach no computation overflows.
constexpr float kLargestReach_m = std::numeric_limits<float>::max() / 64;

/// Fills `out` and returns the palette's reach.
glm::vec4 prepare(std::span<const SkinMatrix> palette, const std::vector<RestBox>& extents,
                  std::vector<BoundTransform>& out) {
  out.resize(palette.size());
  for (std::size_t i = 0; i < palette.size(); ++i) {
    out[i].column = palette[i].column;
    for (std::size_t column = 0; column < 3; ++column) out[i].magnitude[column] = glm::abs(palette[i].column[column]);
  }
  glm::vec4 reach(0);
  glm::vec4 sum(0);
  for (const RestBox& extent : extents) {
    const BoundTransform& t = out[extent.entry];
    const glm::vec4 of_entry = t.magnitude[0] * extent.half_extent.x + t.magnitude[1] * extent.half_extent.y +
                               t.magnitude[2] * extent.half_extent.z + glm::abs(t.column[3]);
    reach = glm::max(reach, of_entry);
    sum += of_entry;
  }
  return reach + (sum - sum);  // not a number if one of them is not finite
}

bool within_reach(const glm::vec4& reach) {
  return reach.x <= kLargestReach_m && reach.y <= kLargestReach_m && reach.z <= kLargestReach_m;
}

}  // namespace

double weight_excess(const Avatar& avatar) {
  double excess = 0;
  for (const Influences& influences : avatar.influences) {
    double sum = 0;
    for (std::size_t k = 0; k < avatar.influence_count; ++k) {
      if (!(influences.weight[k] >= 0)) return static_cast<double>(kInfinity);
      sum += static_cast<double>(influences.weight[k]);
    }
    excess = std::max(excess, std::abs(sum - 1));
  }
  return excess;
}

MeshletBounds::MeshletBounds(const Avatar& avatar, const Meshlets& meshlets) : meshlets_(meshlets) {
  rounding_ = static_cast<float>(0x1p-18 + 2 * weight_excess(avatar));
  double largest = 0;
  if (meshlets.levels() > 0) {
    for (const RestBox& box : meshlets.rest_boxes(meshlets.levels() - 1, 0)) {
      const glm::vec3 extent = glm::abs(box.centre) + box.half_extent;
      extents_.push_back({glm::vec3(0), box.entry, extent, 0});
      largest = std::max(largest,
                         static_cast<double>(extent.x) + static_cast<double>(extent.y) + static_cast<double>(extent.z));
    }
  }
  underflow_m_ = static_cast<float>(0x1p-116 * (1 + largest));
}

void MeshletBounds::begin(const DetectorFrame& frame, Method method) {
  method_ = method;
  const glm::vec4 reach = prepare(frame.palette, extents_, now_);
  bounded_ = within_reach(reach) && rounding_ < 1;
  pad_ = reach * rounding_ + underflow_m_;
  if (method == Method::kStatic) return;
  const glm::vec4 reach_before = prepare(frame.palette_before, extents_, other_);
  bounded_ = bounded_ && within_reach(reach_before);
  pad_ += reach_before * rounding_ + underflow_m_;
  if (method == Method::kCcd) return;
  for (std::size_t i = 0; i < other_.size(); ++i) {
    for (std::size_t column = 0; column < 4; ++column)
      other_[i].column[column] = frame.palette[i].column[column] - frame.palette_before[i].column[column];
    for (std::size_t column = 0; column < 3; ++column) other_[i].magnitude[column] = glm::abs(other_[i].column[column]);
  }
  // Four errors add up: the box, the matrices' difference and its box, the vertices' displacement, and the start
  // rounded to fp32.
  pad_ *= 4;
}

float MeshletBounds::pad_m() const {
  return bounded_ ? pad_.x + pad_.y + pad_.z : kInfinity;
}

void MeshletBounds::boxes(std::size_t level, std::size_t first, std::span<SkinBox> out) const {
  if (bounded_) {
    HWY_DYNAMIC_DISPATCH(bound_nodes)(meshlets_, level, first, {now_.data(), other_.data(), method_, pad_}, out);
  } else {
    std::ranges::fill(out, SkinBox{glm::vec4(-kInfinity), glm::vec4(kInfinity)});
  }
}

}  // namespace vestige
#endif
