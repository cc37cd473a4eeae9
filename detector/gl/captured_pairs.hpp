#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "detector/gl/gl_objects.hpp"

namespace vestige {

/// What a geometry shader writes for a pair that it could not prove to miss; what the numbers count is its own matter.
struct CapturedPair {
  std::uint32_t segment;
  std::uint32_t triangle;
};

/// The buffer into which shaders capture pairs, `Captured` at VESTIGE_BINDING_CAPTURED. Belongs to the context whose
/// functions it was made with, which must be current.
class CapturedPairs {
 public:
  explicit CapturedPairs(const GlFunctions& gl);

  /// Before the draws of a frame: nothing is captured yet.
  void begin();

  /// After them: fills `pairs`. False where some pairs found no room; then there is room, and all has to be drawn again
  /// from `begin` on.
  bool read(std::vector<CapturedPair>& pairs);

 private:
  void grow(std::size_t pairs);

  const GlFunctions& gl_;
  GlBuffer buffer_;
  std::size_t capacity_ = 0;
};

}  // namespace vestige
