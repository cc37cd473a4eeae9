#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "analysis/plot/film/film_plan.hpp"
#include "analysis/plot/studio/subject.hpp"
#include "detector/actuators/law_maker.hpp"
#include "detector/method.hpp"
#include "traces/trace_file/trace_reader.hpp"

namespace vestige::plot {

struct FilmOptions {
  FilmSpan span;
  std::optional<double> azimuth_degrees;  ///< as in `Camera::from`; empty: the side of `plot scene`
  double trail_s = 0.15;                  ///< how far back paths and contacts are shown, at least; above 0
  std::size_t width_dots = 640;           ///< at least 320
  LawFlags law;
  Method method = Method::kStatic;
};

struct Film {
  std::string webp;  ///< the file
  std::size_t pictures = 0;
  std::size_t contacts = 0;  ///< in the frames from the first picture to the last
  double length_s = 0;
  std::vector<std::string> notes;  ///< what was not finite, a sentence for each person
};

/// Draws a trace as an animated picture: its people with the regions of their maps, motors that light up with their
/// duty, colliders with their paths, contacts that fade, and the timeline of the duties. A picture shows the contacts
/// and the highest duties since the picture before, so that nothing between two pictures is lost. Holds the
/// compressed pictures in memory, and the scenes that are painted at a time: one for each processor, but of more than
/// one at most 2 GB.
///
/// `progress` receives the share done and returns false to stop; then nothing is returned. Throws `GlUnavailable` if
/// there is no OpenGL context, and `Error` or `UsageError` as `plan_film` and `FeltTrace` do. `name` is the trace's.
std::optional<Film> make_film(TraceReader& trace, const std::vector<Subject>& people, const FilmOptions& options,
                              std::string_view name, const std::function<bool(double)>& progress);

}  // namespace vestige::plot
