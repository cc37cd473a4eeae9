#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <limits>
#include <span>
#include <string_view>
#include <vector>

#include "detector/output/contacts_csv.hpp"
#include "traces/trace_file/trace_reader.hpp"

namespace vestige::plot {

/// Which moments of a trace are looked at.
struct MomentChoice {
  std::size_t count = 8;
  double from_s = -std::numeric_limits<double>::infinity();
  double to_s = std::numeric_limits<double>::infinity();
  double trail_s = 0.1;  ///< how far back paths reach
};

/// Where one collider was, without a gap or a jump: at least one place. The last two, of a path that ends at the
/// moment, are the segment that is tested.
struct Path {
  struct Stop {
    double age_s = 0;  ///< before the moment
    glm::dvec3 position_m = glm::dvec3(0);
  };
  bool is_current = false;  ///< the collider is there at the moment
  std::vector<Stop> stops;  ///< oldest first; thinned out where they are many
};

/// One frame of a trace and the paths that led to it.
struct Moment {
  std::uint64_t frame = 0;
  double time_s = 0;
  Pose pose;
  std::vector<Path> paths;
  std::vector<RecordedContact> contacts;  ///< of the time that the paths cover
};

struct FrameTime {
  std::uint64_t index = 0;
  double time_s = 0;
};

/// All frames of a trace, which is then at its beginning again. Throws `Error` naming `name` where there is none.
std::vector<FrameTime> frame_times(TraceReader& trace, std::string_view name);

/// Reads the moments among `times`, the trace's frames: evenly over the chosen time or, where contacts are given,
/// frames with contacts, evenly over these. Fewer than asked where there are fewer frames. `contacts` may be in any
/// order. Throws `Error` or `UsageError` naming `name`: no frame in that time, no contact in it.
std::vector<Moment> read_moments(TraceReader& trace, std::string_view name, std::vector<FrameTime> times,
                                 const MomentChoice& choice, std::span<const RecordedContact> contacts);

}  // namespace vestige::plot
