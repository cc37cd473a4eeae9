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
/// none does, the picture before stays. The span's last frame is shown, too, so that nothing is lost behind it.
class FilmClock {
 public:
  explicit FilmClock(const FilmSpan& span) : span_(span) {}

  /// Takes the frames in their order. Returns the number of the period that shows this frame, from 0 on; nothing if the
  /// frame is not shown.
  std::optional<std::uint64_t> period_of(double time_s);
  /// Returns the period that shows the span's last frame, if `period_of` has not shown it: that after the last picture.
  std::uint64_t last_period();

  /// Returns the film's length in periods if no more pictures come. The last one is shown for the shortest time that
  /// another is; one alone, for a period.
  std::uint64_t periods() const;

 private:
  std::uint64_t show_in(std::uint64_t period);

  FilmSpan span_;
  std::optional<double> first_s_;
  std::uint64_t next_ = 0;                     ///< the period after that of the last picture
  std::optional<std::uint64_t> shortest_gap_;  ///< from a picture to the next
};

/// What must be known of a film before its first picture is drawn.
struct FilmPlan {
  SceneSight sight;
  glm::dvec3 origin_m = glm::dvec3(0);  ///< in the world: where people are posed
  std::size_t pictures = 0;             ///< at least 1
  std::uint64_t last_frame = 0;         ///< of the span: the last picture
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
