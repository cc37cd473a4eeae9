#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "analysis/run/detection_run.hpp"
#include "traces/scene/trace.hpp"
#include "traces/trace_file/trace_reader.hpp"

namespace vestige {

/// Consecutive frames of a trace. The first frame only gives the start of the second frame's segments.
using Place = std::vector<TraceFrame>;

/// How much happens in some frames, seen with all colliders of the trace.
struct FrameContacts {
  double empty_share = 0;         ///< share of the frames without a contact, 0 … 1
  double contacts_per_frame = 0;  ///< mean
};

/// The frames of a trace that stand for the whole trace.
struct SweepSample {
  std::vector<Place> places;
  FrameContacts trace;    ///< of all frames but the first
  FrameContacts sampled;  ///< of the places' frames
  std::string sha256;     ///< of the places' poses, colliders and times: equal for the same frames of equal traces
};

/// Chooses `places` evenly spaced places, or as many as the trace has room for, but at least one. Each has
/// `place_frames` frames and the frame before them, or the whole trace if it is shorter. Of 64 ways to put
/// such a grid, it takes the one in which contacts, and frames without contacts, are as frequent as in the whole trace.
/// The detectors of `people`, who are all of the trace, find these contacts: fast ones. `goes_on` is asked now and
/// then; if it returns false, the sample has no places. Throws `Error` if the trace has fewer than two frames.
SweepSample sample_places(TraceReader& trace, std::span<const DetectedPerson> people, std::uint32_t places,
                          std::uint32_t place_frames, const std::function<bool()>& goes_on);

/// Draws `count` of the ids for each place, at random without replacement: ascending ids, by place. Places share as few
/// ids as possible. The same input gives the same ids. Precondition: 0 < count <= ids.size().
std::vector<std::vector<std::uint32_t>> draw_colliders(std::span<const std::uint32_t> ids, std::uint32_t count,
                                                       std::size_t places, std::uint64_t seed);

}  // namespace vestige
