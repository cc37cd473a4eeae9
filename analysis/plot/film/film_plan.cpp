#include "analysis/plot/film/film_plan.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <utility>

#include "analysis/plot/scene/crowd.hpp"
#include "analysis/plot/scene/scene_moments.hpp"
#include "traces/base/error.hpp"

namespace vestige::plot {

namespace {

void refuse_long_film(std::uint64_t periods, const FilmSpan& span, std::string_view name) {
  if (static_cast<double>(periods) <= kLongestFilm_s * span.rate_hz + 1) return;  // the last picture has a length, too
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
  return show_in(static_cast<std::uint64_t>(std::min(periods, 1e15)));
}

std::uint64_t FilmClock::last_period() {
  return show_in(next_);
}

std::uint64_t FilmClock::periods() const {
  return next_ == 0 ? 0 : next_ - 1 + shortest_gap_.value_or(1);
}

std::uint64_t FilmClock::show_in(std::uint64_t period) {
  if (next_ > 0) {
    const std::uint64_t gap = period - (next_ - 1);
    shortest_gap_ = std::min(gap, shortest_gap_.value_or(gap));
  }
  next_ = period + 1;
  return period;
}

std::optional<FilmPlan> plan_film(TraceReader& trace, const std::vector<Subject>& people, const FilmSpan& span,
                                  const Camera& camera, std::string_view name, const std::function<bool()>& go_on) {
  const CrowdPoser poser(people);
  SightFinder finder(camera);
  FilmClock clock(span);
  FilmPlan plan;
  std::optional<double> first_s;
  TraceFrame frame;
  TraceFrame last;  // of the span
  bool is_last_shown = false;
  const auto show = [&](const TraceFrame& shown, std::uint64_t period) {
    refuse_long_film(period + 1, span, name);
    finder.add(poser.pose(shown.poses, plan.origin_m).surface);
    ++plan.pictures;
  };
  trace.rewind();
  while (trace.next(frame)) {
    if (!go_on()) return {};
    if (!first_s) first_s = frame.time_s();
    if (frame.time_s() > span.to_s) break;
    if (frame.time_s() < span.from_s) continue;
    const std::optional<std::uint64_t> period = clock.period_of(frame.time_s());
    is_last_shown = period.has_value();
    if (plan.pictures == 0) {
      plan.origin_m = standing_at(people, frame.poses);
      plan.begin_s = frame.time_s();
    }
    if (period) show(frame, *period);
    std::swap(frame, last);
  }
  if (plan.pictures == 0) {
    while (trace.next(frame)) {
    }
    refuse_empty_span(name, first_s.value_or(0), frame.time_s());
  }
  if (!is_last_shown) show(last, clock.last_period());
  plan.last_frame = last.index;
  plan.periods = clock.periods();
  refuse_long_film(plan.periods, span, name);
  plan.end_s = plan.begin_s + static_cast<double>(plan.periods) / span.rate_hz * span.speed;
  plan.sight = finder.sight();
  return plan;
}

}  // namespace vestige::plot
