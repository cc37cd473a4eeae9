#include "detector/broad/meet_boxes.hpp"

#include <algorithm>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "detector/broad/meet_boxes.cpp"  // NOLINT(bugprone-suspicious-include)
#include <hwy/foreach_target.h>
// After foreach_target.h, which includes this file once for each instruction set.
#include <hwy/highway.h>

#include "detector/broad/mask_bits-inl.hpp"

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

}  // namespace HWY_NAMESPACE
}  // namespace vestige
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vestige {

HWY_EXPORT(meet_block);

void meet_boxes(std::span<const SkinBox> boxes, const float* ends, std::size_t stride, std::size_t count,
                std::uint32_t* meets) {
  HWY_DYNAMIC_DISPATCH(meet_block)(boxes, ends, stride, count, meets);
}

}  // namespace vestige
#endif
