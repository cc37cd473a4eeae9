#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "detector/gl/draw_timer.hpp"
#include "detector/gl/gl_objects.hpp"
#include "detector/stages.hpp"

namespace vestige {

/// The entry that a geometry shader writes for a pair that it could not prove to miss. Each shader defines what the two
/// numbers count.
struct CapturedPair {
  std::uint32_t segment;
  std::uint32_t triangle;
};

/// The buffer into which shaders capture pairs, `Captured` at VESTIGE_BINDING_CAPTURED. It grows up to the largest
/// storage block of the driver (GL_MAX_SHADER_STORAGE_BLOCK_SIZE). It belongs to the context whose functions it was
/// made with. That context must be current at every call.
class CapturedPairs {
 public:
  explicit CapturedPairs(const GlFunctions& gl);

  /// Calls draw(first, count) for ranges that together are `items`, in order, and consume(pair) for every pair that
  /// the shaders captured. An item captures at most `pairs_of_item` pairs, which must be above 0 and below 2^32. A
  /// range is smaller than `items` if the shaders' count could wrap, or if the driver's largest buffer cannot hold the
  /// pairs. A range that found too small a buffer is drawn again. Throws `Error` if the largest buffer cannot hold the
  /// pairs of one item, or if an OpenGL error occurred. `clock` times the stages from kUpload to kDecision, unless it
  /// is null.
  template <typename Draw, typename Consume>
  void capture(StageClock* clock, std::size_t items, std::size_t pairs_of_item, Draw&& draw, Consume&& consume) {
    std::size_t range = kLargestCount / pairs_of_item;
    for (std::size_t first = 0; first < items;) {
      const std::size_t count = std::min(range, items - first);
      enter_stage(clock, Stage::kUpload);
      begin();
      timer_.time(clock, [&] { draw(first, count); });
      enter_stage(clock, Stage::kReadBack);
      range = read(count);
      if (range == 0) {  // all pairs were read
        enter_stage(clock, Stage::kDecision);
        for (const CapturedPair& pair : pairs_) consume(pair);
        first += count;
        range = count;
      }
    }
  }

 private:
  static constexpr std::size_t kLargestCount = 0xFFFFFFFF;

  void begin();
  /// Reads the pairs of `items` back. Returns 0, or, if the buffer was too small, the number of items that may fit now.
  std::size_t read(std::size_t items);
  void grow(std::size_t pairs);

  const GlFunctions& gl_;
  GlBuffer buffer_;
  DrawTimer timer_;
  std::size_t capacity_ = 0;  ///< in pairs
  std::size_t largest_;       ///< largest capacity that the driver allows
  std::vector<CapturedPair> pairs_;
};

}  // namespace vestige
