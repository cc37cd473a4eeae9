#pragma once

#include <cstddef>

namespace vestige {

/// The most frames that a detector hands to the GPU before it waits for the first of them.
inline constexpr std::size_t kMostInFlight = 8;

/// Takes frames 0 to `frames` - 1 through the GPU, several at a time. `start(frame, place)` hands a frame to the GPU
/// and returns whether there is anything to wait for. If so, `finish(place)` is called later, in the order of the
/// frames. A place is below kMostInFlight, and belongs to its frame until `finish` returns.
template <typename Start, typename Finish>
void keep_in_flight(std::size_t frames, Start start, Finish finish) {
  std::size_t started = 0;
  std::size_t finished = 0;
  for (std::size_t frame = 0; frame < frames; ++frame) {
    if (started - finished == kMostInFlight) finish(finished++ % kMostInFlight);
    if (start(frame, started % kMostInFlight)) ++started;
  }
  while (finished != started) finish(finished++ % kMostInFlight);
}

}  // namespace vestige
