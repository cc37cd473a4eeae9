#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <limits>
#include <span>
#include <string_view>
#include <vector>

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

/// The path of one collider without a gap or a jump. It has at least one stop. If the path ends at the moment, its last
/// two stops are the segment that is tested.
struct Path {
  struct Stop {
    double age_s = 0;  ///< time before the moment
    glm::dvec3 position_m = glm::dvec3(0);
  };
  std::uint32_t collider = 0;  ///< its id
  bool is_current = false;     ///< the collider exists at the moment
  float radius_m = 0;          ///< at its last stop; 0: a point
  std::vector<Stop> stops;     ///< oldest first; thinned out if there are many
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

/// Reads the moments of all people. `times` are the trace's frames. Without contacts, the moments are evenly spaced
/// over the chosen time. With contacts, they are evenly spaced among the frames that have contacts. Returns fewer
/// moments than asked for if there are fewer frames. `contacts` may be in any order. Throws `Error` or `UsageError`
/// with `name` if that time has no frame or no contact.
std::vector<Moment> read_moments(TraceReader& trace, std::string_view name, std::vector<FrameTime> times,
                                 const MomentChoice& choice, std::span<const RecordedContact> contacts);

}  // namespace vestige::plot
