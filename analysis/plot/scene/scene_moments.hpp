#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <string_view>
#include <vector>

#include "analysis/plot/scene/trails.hpp"
#include "detector/output/recorded_contacts.hpp"
#include "traces/trace_file/trace_reader.hpp"

namespace vestige::plot {

/// The moments of a trace to draw.
struct MomentChoice {
  std::size_t count = 8;
  double from_s = -std::numeric_limits<double>::infinity();
  double to_s = std::numeric_limits<double>::infinity();
  double trail_s = 0.1;  ///< length of the paths, back in time
};

/// One frame of a trace and the paths that led to it.
struct Moment {
  std::uint64_t frame = 0;
  double time_s = 0;
  std::vector<Pose> poses;  ///< of each person; one that is missing has no nodes
  std::vector<Path> paths;
  std::vector<RecordedContact> contacts;  ///< contacts in the time that the paths cover
};

struct FrameTime {
  std::uint64_t index = 0;
  double time_s = 0;
};

/// Returns the times of all frames, and rewinds the trace. Throws `Error` with `name` if the trace has no frame.
std::vector<FrameTime> frame_times(TraceReader& trace, std::string_view name);

/// Throws `UsageError` that names --from and --to if they are in the wrong order.
void require_order(double from_s, double to_s);
/// Throws `UsageError` that says that the trace, which lasts from `first_s` to `last_s`, has no frame in that time.
[[noreturn]] void refuse_empty_span(std::string_view name, double first_s, double last_s);

/// Reads the moments of all people. `times` are the trace's frames. Without contacts, the moments are evenly spaced
/// over the chosen time. With contacts, they are evenly spaced among the frames that have contacts. Returns fewer
/// moments than asked for if there are fewer frames. `contacts` may be in any order. Throws `Error` or `UsageError`
/// with `name` if that time has no frame or no contact.
std::vector<Moment> read_moments(TraceReader& trace, std::string_view name, std::vector<FrameTime> times,
                                 const MomentChoice& choice, std::span<const RecordedContact> contacts);

}  // namespace vestige::plot
