#pragma once

#include <cstdint>
#include <optional>

#include "detector/detector.hpp"
#include "traces/scene/avatar.hpp"
#include "traces/scene/pose.hpp"

namespace vestige {

/// How far a detector's own skinned vertices lie from the double-precision reference, and how many are identical to the
/// fp32 skinning that the contract fixes (detector/CONTRACT.md, 3).
struct SkinningError {
  std::uint64_t frames = 0;
  std::uint64_t vertices = 0;  ///< vertices compared, over all frames
  /// Vertices whose position equals the contract's fp32 skinning. Absent if the CPU skinned them: then nothing was
  /// compared.
  std::optional<std::uint64_t> identical;
  double largest_m = 0;      ///< largest distance to the double reference
  double largest_cpu_m = 0;  ///< largest distance of the contract's fp32 skinning to the double reference
  double height_m = 0;       ///< longest side of the avatar's box, in the double reference

  void add(const Avatar& avatar, const Pose& pose, const DetectorFrame& frame, Detector& detector);
  /// Adds what was compared elsewhere. Both are of one detector.
  SkinningError& operator+=(const SkinningError& other);
};

}  // namespace vestige
