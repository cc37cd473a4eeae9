#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "detector/approximate/shape.hpp"

namespace vestige {

/// Where a way crosses the surface of the union of some shapes.
struct Crossing {
  double t = 0;           ///< in (0, 1]
  std::size_t chord = 0;  ///< number of the chord whose shape is entered or left
  std::int8_t side = 0;   ///< +1 entering, -1 leaving
};

/// Returns the first crossing in (0, 1] of the surface of the union. Where a way goes from one shape into another that
/// overlaps it, no surface is crossed. Of shapes that are entered or left at the same time, the first counts.
std::optional<Crossing> first_crossing(std::span<const Chord> chords);

/// Returns the first time in [0, 1] at which a way is within one of the grown shapes and inside none of the shrunk
/// ones: when a sphere, whose radius shapes were grown and shrunk by, first touches the surface of the union. Where
/// shapes overlap, this may find a touch deep inside.
std::optional<double> first_touch(std::span<const Chord> grown, std::span<const Chord> shrunk);

}  // namespace vestige
