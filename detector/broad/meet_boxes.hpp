#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/vec4.hpp>
#include <span>

namespace vestige {

/// A box that surely contains its object. The w components are unused.
struct alignas(16) SkinBox {
  glm::vec4 low;
  glm::vec4 high;
};

/// Number of boxes that one call tests, one bit each.
inline constexpr std::size_t kBoxBlock = 32;

/// Tests `count` boxes, at most kBoxBlock, against `boxes`. Bit i of meets[k] says whether box i meets boxes[k]. Boxes
/// that touch meet. A coordinate that is not a number separates nothing.
///
/// `ends` holds low x of all boxes i, then low y, z, high x, y, z. Each group begins `stride` floats after the previous
/// one. The function may read kBoxBlock floats of each group.
void meet_boxes(std::span<const SkinBox> boxes, const float* ends, std::size_t stride, std::size_t count,
                std::uint32_t* meets);

/// Takes away bits from the `meets` of `meet_boxes`: those of boxes i around cut segments that miss boxes[k]. `axes`
/// holds the CrossAxes of all i, laid out as `ends`.
void meet_cut_segments(std::span<const SkinBox> boxes, const float* axes, std::size_t stride, std::size_t count,
                       std::uint32_t* meets);

}  // namespace vestige
