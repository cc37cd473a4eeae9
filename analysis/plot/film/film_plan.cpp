#include "analysis/plot/film/film_plan.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "analysis/plot/scene/crowd.hpp"
#include "analysis/plot/scene/scene_moments.hpp"
#include "traces/base/error.hpp"

namespace vestige::plot {

namespace {

void refuse_long_film(std::uint64_t period, const FilmSpan& span, std::string_view name) {
  if (static_cast<double>(period) < kLongestFilm_s * span.rate_hz) return;
  throw UsageError(
      "plot film",
      fmt::format("the film of {} would be longer than {:g} s, and a film is held in memory", name, kLongestFilm_s),
      "choose a part with --from and --to, or a higher --speed");
}

}  // namespace

std::optional<std::uint64_t> FilmClock::period_of(double time_s) {
  if (time_s < span_.from_s || time_s > span_.to_s) return {};
  if (!first_s_) first_s_ = time_s;
  // Sums of times land a hair beside the round number.
  const double periods = (time_s - *first_s_) / span_.speed * span_.rate_hz + 1e-6;
  if (periods < static_cast<double>(next_)) return {};
  const auto period = static_cast<std::uint64_t>(std::min(periods, 1e15));
  next_ = period + 1;
  return period;
}

std::optional<FilmPlan> plan_film(TraceReader& trace, const std::vector<Subject>& people, const FilmSpan& span,
                                  const Camera& camera, std::string_view name, const std::function<bool()>& go_on) {
  require_order(span.from_s, span.to_s);
  const CrowdPoser poser(people);
  SightFinder finder(camera);
  FilmClock clock(span);
  FilmPlan plan;
  std::optional<double> first_s;
  std::uint64_t last_period = 0;
  TraceFrame frame;
  trace.rewind();
  while (trace.next(frame)) {
    if (!go_on()) return {};
    if (!first_s) first_s = frame.time_s();
    if (frame.time_s() > span.to_s) break;
    const std::optional<std::uint64_t> period = clock.period_of(frame.time_s());
    if (!period) continue;
    refuse_long_film(*period, span, name);
    if (plan.pictures == 0) {
      plan.origin_m = standing_at(people, frame.poses);
      plan.begin_s = frame.time_s();
    }
    finder.add(poser.pose(frame.poses, plan.origin_m).surface);
    ++plan.pictures;
    // The last picture is shown for as long as the one before.
    plan.periods = *period + std::max<std::uint64_t>(1, *period - last_period);
    last_period = *period;
  }
  if (plan.pictures == 0) {
    while (trace.next(frame)) {
    }
    refuse_empty_span(name, first_s.value_or(0), frame.time_s());
  }
  plan.end_s = plan.begin_s + static_cast<double>(plan.periods) / span.rate_hz * span.speed;
  plan.sight = finder.sight();
  return plan;
}

}  // namespace vestige::plot
