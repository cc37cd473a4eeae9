#include "detector/meet_boxes.hpp"

#include <array>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "detector/meet_boxes.cpp"  // NOLINT(bugprone-suspicious-include)
#include <hwy/foreach_target.h>
// After foreach_target.h, which includes this file once for each instruction set.
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace vestige {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

std::uint32_t MeetBlock(const SkinBox& box, const float* ends, std::size_t stride, std::size_t count) {
  const hn::CappedTag<float, kBoxBlock> d;
  const std::size_t lanes = hn::Lanes(d);
  std::uint32_t meets = 0;
  for (std::size_t i = 0; i < count; i += lanes) {
    auto apart = hn::FirstN(d, 0);
    for (int axis = 0; axis < 3; ++axis) {
      const float* low = ends + static_cast<std::size_t>(axis) * stride + i;
      const float* high = low + 3 * stride;
      apart = hn::Or(apart, hn::Gt(hn::LoadU(d, low), hn::Set(d, box.high[axis])));
      apart = hn::Or(apart, hn::Lt(hn::LoadU(d, high), hn::Set(d, box.low[axis])));
    }
    std::array<std::uint8_t, 8> bytes = {};
    hn::StoreMaskBits(d, hn::Not(apart), bytes.data());
    std::uint32_t bits = 0;
    for (std::size_t byte = 0; byte < 4; ++byte) bits |= static_cast<std::uint32_t>(bytes[byte]) << (8 * byte);
    meets |= bits << i;
  }
  return count < kBoxBlock ? meets & ((1U << count) - 1) : meets;
}

}  // namespace HWY_NAMESPACE
}  // namespace vestige
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vestige {

HWY_EXPORT(MeetBlock);

std::uint32_t meet_boxes(const SkinBox& box, const float* ends, std::size_t stride, std::size_t count) {
  return HWY_DYNAMIC_DISPATCH(MeetBlock)(box, ends, stride, count);
}

}  // namespace vestige
#endif
