#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/vec4.hpp>
#include <span>

namespace vestige {

/// A box that surely holds what it is of; w means nothing.
struct alignas(16) SkinBox {
  glm::vec4 low;
  glm::vec4 high;
};

/// Boxes tested at once: one bit each.
inline constexpr std::size_t kBoxBlock = 32;

/// Bit i of meets[k] says whether box i, of `count` up to kBoxBlock, meets boxes[k]; touching is meeting, and what is
/// no number may meet anything. `ends`: low x of all boxes i, then low y, z, high x, y, z, each `stride` after the
/// last; kBoxBlock floats of each may be read.
void meet_boxes(std::span<const SkinBox> boxes, const float* ends, std::size_t stride, std::size_t count,
                std::uint32_t* meets);

}  // namespace vestige
