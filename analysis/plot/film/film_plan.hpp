#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <glm/vec3.hpp>
#include <limits>
#include <optional>
#include <string_view>
#include <vector>

#include "analysis/plot/scene/scene_sight.hpp"
#include "analysis/plot/studio/subject.hpp"
#include "traces/trace_file/trace_reader.hpp"

namespace vestige::plot {

/// Films are held in memory, compressed, until they are written. This keeps them small.
inline constexpr double kLongestFilm_s = 60;

/// Which part of a trace a film shows, and how fast.
struct FilmSpan {
  double from_s = -std::numeric_limits<double>::infinity();  ///< of the trace
  double to_s = std::numeric_limits<double>::infinity();
  double speed = 1;     ///< seconds of the trace in a second of the film, above 0
  double rate_hz = 25;  ///< pictures in a second of the film, above 0
};

/// Says which frames of a trace become pictures. In each period of the film, the first frame that lies in it does. If
/// none does, the picture before stays.
class FilmClock {
 public:
  explicit FilmClock(const FilmSpan& span) : span_(span) {}

  /// Takes the frames in their order. Returns the number of the period that shows this frame, from 0 on; nothing if the
  /// frame is not shown.
  std::optional<std::uint64_t> period_of(double time_s);

 private:
  FilmSpan span_;
  std::optional<double> first_s_;
  std::uint64_t next_ = 0;
};

/// What must be known of a film before its first picture is drawn.
struct FilmPlan {
  SceneSight sight;
  glm::dvec3 origin_m = glm::dvec3(0);  ///< in the world: where people are posed
  std::size_t pictures = 0;             ///< at least 1
  double begin_s = 0;                   ///< of the first frame shown
  double end_s = 0;                     ///< when the last picture ends; later than `begin_s`
  std::uint64_t periods = 0;            ///< the film's length
};

/// Reads the trace and poses its people in each picture. `go_on` is asked for each frame and returns false to stop;
/// then nothing is returned. Throws `UsageError` that names the flags if no frame lies in the span, or if the film
/// would be longer than `kLongestFilm_s`. `name` is the trace's. Precondition: the trace has a frame.
std::optional<FilmPlan> plan_film(TraceReader& trace, const std::vector<Subject>& people, const FilmSpan& span,
                                  const Camera& camera, std::string_view name, const std::function<bool()>& go_on);

}  // namespace vestige::plot
