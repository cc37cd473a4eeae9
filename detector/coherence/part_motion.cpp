#include "detector/coherence/part_motion.hpp"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <limits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "detector/coherence/part_motion.cpp"  // NOLINT(bugprone-suspicious-include)
#include <hwy/foreach_target.h>
// After foreach_target.h, which includes this file once for each instruction set.
#include <hwy/highway.h>

#include "detector/broad/meshlet_bounds.hpp"
#include "detector/broad/transformed_box-inl.hpp"

// Under linear blend skinning, a vertex x moves by the sum of w_j D_j x, where D_j is what changed of the matrix of
// palette entry j, and the w_j sum to s. That is at most s times the largest |D_j x|, and x is in the rest box of j. A
// point of a triangle is a convex combination of its corners, so it moves no farther than the farthest of them.
//
// Let u = 2^-24, and R_j = |D_j0| |x| + |D_j1| |y| + |D_j2| |z| + |D_j3| along an axis, where |x|, |y|, |z| are the
// largest values that j moves. The centre D_j c of a box errs by at most 4 u R_j, its half extent |D_j| h by 3 u R_j,
// and each of their sums by u R_j: less than 10 u R_j together. `rounding` is 16 u R_j. The subtraction that gives D_j,
// the norm and the root err by a few u of the result: kUp is 16 u.
HWY_BEFORE_NAMESPACE();
namespace vestige {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using D = BoxTag;

/// Returns the square of the largest displacement of the points of `boxes`.
inline float largest_squared(std::span<const RestBox> boxes, const EntryMotion* motion) {
  const D d;
  float largest = 0;
  for (const RestBox& box : boxes) {
    const EntryMotion& of = motion[box.entry];
    alignas(16) std::array<float, 4> reach;
    for (int first = 0; first < 4; first += static_cast<int>(hn::Lanes(d))) {
      const auto [centre, half] = transformed_box(box, of, first);
      const auto rounded = hn::Add(half, hn::Load(d, &of.rounding[first]));
      hn::Store(hn::Add(hn::Abs(centre), rounded), d, &reach[static_cast<std::size_t>(first)]);
    }
    const float squared = reach[0] * reach[0] + reach[1] * reach[1] + reach[2] * reach[2];
    // Not a number: nothing is known.
    if (!(squared <= largest)) largest = squared == squared ? squared : std::numeric_limits<float>::infinity();
  }
  return largest;
}

void measure_parts(const Meshlets& meshlets, std::size_t level, const EntryMotion* motion, std::span<float> squared) {
  for (std::size_t part = 0; part < squared.size(); ++part) {
    const std::span<const RestBox> boxes = meshlets.rest_boxes(level, part);
    squared[part] = boxes.empty() ? std::numeric_limits<float>::infinity() : largest_squared(boxes, motion);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace vestige
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vestige {

namespace {

HWY_EXPORT(measure_parts);

constexpr float kUp = 1 + 0x1p-20F;
constexpr float kRounding = 0x1p-20F;

}  // namespace

PartMotion::PartMotion(const Avatar& avatar, const Meshlets& meshlets, std::size_t level)
    : meshlets_(meshlets),
      level_(level),
      scale_(static_cast<float>(1 + weight_excess(avatar)) * kUp),
      extent_of_(avatar.palette.size(), glm::vec4(0)),
      motion_(avatar.palette.size()),
      steps_m_(meshlets.nodes(level)) {
  for (const RestBox& box : meshlets.rest_boxes(meshlets.levels() - 1, 0))
    extent_of_[box.entry] = glm::vec4(glm::abs(box.centre) + box.half_extent, 0);
}

std::span<const float> PartMotion::between(std::span<const SkinMatrix> before, std::span<const SkinMatrix> now) {
  for (std::size_t entry = 0; entry < now.size(); ++entry) {
    EntryMotion& motion = motion_[entry];
    for (std::size_t c = 0; c < 4; ++c) motion.column[c] = now[entry].column[c] - before[entry].column[c];
    for (std::size_t c = 0; c < 3; ++c) motion.magnitude[c] = glm::abs(motion.column[c]);
    const glm::vec4& extent = extent_of_[entry];
    motion.rounding = (motion.magnitude[0] * extent.x + motion.magnitude[1] * extent.y +
                       motion.magnitude[2] * extent.z + glm::abs(motion.column[3])) *
                      kRounding;
  }
  HWY_DYNAMIC_DISPATCH(measure_parts)(meshlets_, level_, motion_.data(), steps_m_);
  // Squares below 2^-126 may be lost: less than 2^-62 m.
  for (float& step : steps_m_) step = std::sqrt(step) * scale_ + 0x1p-62F;
  return steps_m_;
}

}  // namespace vestige
#endif
