#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "detector/gl/gl_objects.hpp"

namespace vestige {

/// The entry that a geometry shader writes for a pair that it could not prove to miss. Each shader defines what the two
/// numbers count.
struct CapturedPair {
  std::uint32_t segment;
  std::uint32_t triangle;
};

/// The buffer into which shaders capture pairs, `Captured` at VESTIGE_BINDING_CAPTURED. It belongs to the context whose
/// functions it was made with. That context must be current at every call.
class CapturedPairs {
 public:
  explicit CapturedPairs(const GlFunctions& gl);

  /// Empties the buffer. Call it before the draws of a frame.
  void begin();

  /// Reads the pairs back into `pairs`. Call it after the draws. Returns false if the buffer was too small. Then the
  /// buffer has grown, and the caller must draw everything again from `begin` on.
  bool read(std::vector<CapturedPair>& pairs);

 private:
  void grow(std::size_t pairs);

  const GlFunctions& gl_;
  GlBuffer buffer_;
  std::size_t capacity_ = 0;
};

}  // namespace vestige
