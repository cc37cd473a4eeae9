#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "analysis/run/seen_run.hpp"
#include "analysis/view/page_packer.hpp"
#include "detector/contact.hpp"
#include "traces/trace_file/trace_reader.hpp"

namespace vestige {

/// What the contacts of a page carry.
inline constexpr PlaneSet kPagePlanes = kHashedPlanes | Plane::kBarycentric | Plane::kPosition | Plane::kSide;

/// Adds a frame to `packer`, whose people are those of `sides`, one side after the other, and what they find in it.
/// Contacts carry `kPagePlanes`. `contacts` counts them for each side.
void pack_frame(const TraceFrame& frame, std::span<SeenRun* const> sides, PagePacker& packer,
                std::span<std::uint64_t> contacts);

/// Packs all frames of a trace. Returns the number of contacts of each side. `progress` receives the share done; if it
/// returns false, the reading ends, and nothing is returned.
std::optional<std::vector<std::uint64_t>> pack_trace(TraceReader& trace, std::span<SeenRun* const> sides,
                                                     PagePacker& packer, const std::function<bool(double)>& progress);

}  // namespace vestige
