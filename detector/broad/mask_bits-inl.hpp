// This file is included once for each instruction set, after hwy/highway.h. So the include guard follows Highway's
// pattern.
#if defined(VESTIGE_MASK_BITS_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef VESTIGE_MASK_BITS_INL
#undef VESTIGE_MASK_BITS_INL
#else
#define VESTIGE_MASK_BITS_INL
#endif

#include <array>
#include <cstdint>

HWY_BEFORE_NAMESPACE();
namespace vestige {
namespace HWY_NAMESPACE {

/// Returns one bit for each lane, of which there are at most 16. All other bits are 0.
template <typename D>
inline std::uint32_t mask_bits(D d, hwy::HWY_NAMESPACE::Mask<D> mask) {
  static_assert(hwy::HWY_NAMESPACE::MaxLanes(D()) <= 16);
  std::array<std::uint8_t, 8> bytes = {};
  hwy::HWY_NAMESPACE::StoreMaskBits(d, mask, bytes.data());
  return bytes[0] | static_cast<std::uint32_t>(bytes[1]) << 8;
}

}  // namespace HWY_NAMESPACE
}  // namespace vestige
HWY_AFTER_NAMESPACE();

#endif
