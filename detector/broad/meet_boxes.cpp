#include "detector/broad/meet_boxes.hpp"

#include <algorithm>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "detector/broad/meet_boxes.cpp"  // NOLINT(bugprone-suspicious-include)
#include <hwy/foreach_target.h>
// After foreach_target.h, which includes this file once for each instruction set.
#include <hwy/highway.h>

#include "detector/broad/mask_bits-inl.hpp"
#include "detector/ways/cross_axes-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace vestige {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

void meet_block(std::span<const SkinBox> boxes, const float* ends, std::size_t stride, std::size_t count,
                std::uint32_t* meets) {
  const hn::CappedTag<float, 16> d;
  std::fill_n(meets, boxes.size(), 0U);
  for (std::size_t i = 0; i < count; i += hn::Lanes(d)) {
    const auto low_x = hn::LoadU(d, ends + i);
    const auto low_y = hn::LoadU(d, ends + stride + i);
    const auto low_z = hn::LoadU(d, ends + 2 * stride + i);
    const auto high_x = hn::LoadU(d, ends + 3 * stride + i);
    const auto high_y = hn::LoadU(d, ends + 4 * stride + i);
    const auto high_z = hn::LoadU(d, ends + 5 * stride + i);
    for (std::size_t k = 0; k < boxes.size(); ++k) {
      const SkinBox& box = boxes[k];
      const auto apart_x = hn::Or(hn::Gt(low_x, hn::Set(d, box.high.x)), hn::Lt(high_x, hn::Set(d, box.low.x)));
      const auto apart_y = hn::Or(hn::Gt(low_y, hn::Set(d, box.high.y)), hn::Lt(high_y, hn::Set(d, box.low.y)));
      const auto apart_z = hn::Or(hn::Gt(low_z, hn::Set(d, box.high.z)), hn::Lt(high_z, hn::Set(d, box.low.z)));
      meets[k] |= mask_bits(d, hn::Not(hn::Or(hn::Or(apart_x, apart_y), apart_z))) << i;
    }
  }
  if (count < kBoxBlock)
    for (std::size_t k = 0; k < boxes.size(); ++k) meets[k] &= (1U << count) - 1;
}

void cut_block(std::span<const SkinBox> boxes, const float* axes, std::size_t stride, std::size_t count,
               std::uint32_t* meets) {
  using Lanes = hn::CappedTag<float, 16>;
  const Lanes d;
  for (std::size_t k = 0; k < boxes.size(); ++k) {
    if (meets[k] == 0) continue;
    const SkinBox& box = boxes[k];
    const Triple<Lanes> low = {hn::Set(d, box.low.x), hn::Set(d, box.low.y), hn::Set(d, box.low.z)};
    const Triple<Lanes> high = {hn::Set(d, box.high.x), hn::Set(d, box.high.y), hn::Set(d, box.high.z)};
    const BoxLanes<Lanes> lanes = box_lanes(d, low, high);
    for (std::size_t i = 0; i < count; i += hn::Lanes(d)) {
      const auto three = [&](std::size_t first) -> Triple<Lanes> {
        const float* at = axes + first * stride + i;
        return {hn::LoadU(d, at), hn::LoadU(d, at + stride), hn::LoadU(d, at + 2 * stride)};
      };
      const AxesLanes<Lanes> of_segments = {three(0), three(3), three(6)};
      meets[k] &= ~(mask_bits(d, are_beside(d, lanes, of_segments)) << i);
    }
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace vestige
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vestige {

HWY_EXPORT(meet_block);
HWY_EXPORT(cut_block);

void meet_boxes(std::span<const SkinBox> boxes, const float* ends, std::size_t stride, std::size_t count,
                std::uint32_t* meets) {
  HWY_DYNAMIC_DISPATCH(meet_block)(boxes, ends, stride, count, meets);
}

void meet_cut_segments(std::span<const SkinBox> boxes, const float* axes, std::size_t stride, std::size_t count,
                       std::uint32_t* meets) {
  HWY_DYNAMIC_DISPATCH(cut_block)(boxes, axes, stride, count, meets);
}

}  // namespace vestige
#endif
