#include "analysis/frequency/growth.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "analysis/frequency/detector_memory.hpp"
#include "analysis/frequency/sweep_report.hpp"
#include "traces/scene/subdivision.hpp"

namespace vestige {

namespace {

SweepSettings settings_for(const GrowthSettings& settings, const Avatar& avatar, std::uint32_t colliders) {
  SweepSettings sweep = settings.sweep;
  sweep.counts = {colliders};
  if (std::uint64_t{colliders} * avatar.triangles.size() > kManyPairs) {
    sweep.runs = 3;
    sweep.run_frames = 1;
  }
  return sweep;
}

/// Returns the map for the avatar that traces/scene/subdivision.hpp makes.
ActuatorMap subdivided(const ActuatorMap& map) {
  ActuatorMap fine = map;
  if (map.triangle_count == 0) return fine;
  fine.triangle_count = 4 * map.triangle_count;
  fine.width = 2 * map.width;
  fine.height = 2 * map.height;
  fine.actuator.assign(std::size_t{fine.width} * fine.height, 0);
  for (std::size_t i = 0; i < fine.triangle_count; ++i) fine.actuator[i] = map.actuator[i / 4];
  return fine;
}

/// Measures one size after another. A contestant whose frame took longer than the limit is left out of those that
/// follow.
class GrowingRace {
 public:
  GrowingRace(const ContestantMaker& survey, const std::vector<Contestant>& contestants, double frame_limit_s)
      : survey_(survey),
        contestants_(contestants),
        frame_limit_us_(1e6 * frame_limit_s),
        latest_(contestants.size()),
        too_slow_(contestants.size()) {}

  /// `settings` have one count. The sweep has a series of one point for each contestant.
  Sweep measure(TraceReader& trace, const SweptPerson& person, const SweepSettings& settings,
                const std::function<bool(double)>& progress) {
    std::vector<std::size_t> places;
    std::vector<Contestant> racing;
    for (std::size_t i = 0; i < contestants_.size(); ++i) {
      if (too_slow_[i]) continue;
      places.push_back(i);
      racing.push_back(contestants_[i]);
    }
    Sweep sweep;
    if (!racing.empty()) sweep = run_sweep(trace, {&person, 1}, survey_, racing, settings, progress);
    const SweepScene scene = first_frames(trace, settings);
    for (SweepSeries& series : latest_) series.points.assign(1, blank_point(settings.counts.front()));
    for (std::size_t i = 0; i < racing.size(); ++i) {
      SweepSeries& series = latest_[places[i]] = std::move(sweep.series[i]);
      SweepPoint& point = series.points.front();
      if (progress(1)) point.memory_bytes = detector_memory_bytes(racing[i], person, scene);
      too_slow_[places[i]] = point.mean_us() > frame_limit_us_;
    }
    sweep.series = latest_;
    return sweep;
  }

 private:
  static SweepPoint blank_point(std::uint32_t colliders) {
    SweepPoint point;
    point.colliders = colliders;
    return point;
  }

  static SweepScene first_frames(TraceReader& trace, const SweepSettings& settings) {
    constexpr std::size_t kFrames = 3;
    Place place;
    TraceFrame frame;
    trace.rewind();
    while (place.size() < kFrames && trace.next(frame)) place.push_back(frame);
    return make_sweep_scene({std::move(place)}, trace.collider_ids(), settings.counts, settings.seed);
  }

  const ContestantMaker& survey_;
  const std::vector<Contestant>& contestants_;
  double frame_limit_us_;
  std::vector<SweepSeries> latest_;
  std::vector<bool> too_slow_;
};

/// Appends the single point of each series of `more` to the series of `all`.
void append(std::vector<SweepSeries>& all, std::vector<SweepSeries> more) {
  if (all.empty()) {
    all = std::move(more);
    return;
  }
  for (std::size_t i = 0; i < all.size(); ++i) all[i].points.push_back(std::move(more[i].points.front()));
}

}  // namespace

Growth run_growth(GrowthTraces traces, SweptPerson person, const ContestantMaker& survey,
                  const std::vector<Contestant>& contestants, const GrowthSettings& settings,
                  const std::function<bool(double)>& progress) {
  Growth growth;
  growth.frame_limit_s = settings.frame_limit_s;
  bool goes_on = true;
  const double steps = static_cast<double>(settings.sweep.counts.size()) + settings.subdivisions + 1;
  double step = 0;
  const auto step_progress = [&](double share) {
    goes_on = goes_on && progress((step + share) / steps);
    return goes_on;
  };
  GrowingRace along_colliders(survey, contestants, settings.frame_limit_s);
  for (const std::uint32_t count : settings.sweep.counts) {
    if (!goes_on) return growth;
    const SweepSettings sweep = settings_for(settings, person.avatar, count);
    append(growth.by_colliders, along_colliders.measure(traces.with(count), person, sweep, step_progress).series);
    ++step;
  }
  Avatar fine = person.avatar;
  ActuatorMap fine_map = person.map;
  GrowingRace along_triangles(survey, contestants, settings.frame_limit_s);
  const SweptPerson fine_person = {fine, fine_map};
  for (std::uint32_t level = 0; goes_on && level <= settings.subdivisions; ++level) {
    if (level > 0) {
      fine = subdivided(fine);
      fine_map = subdivided(fine_map);
    }
    const SweepSettings sweep = settings_for(settings, fine, settings.colliders);
    Sweep measured = along_triangles.measure(traces.with(settings.colliders), fine_person, sweep, step_progress);
    growth.by_triangles.push_back({fine.triangles.size(), fine.position_bind.size(),
                                   measured.places * measured.place_frames, std::move(measured.series)});
    ++step;
  }
  return growth;
}

std::vector<double> mean_us(const SweepSeries& series) {
  std::vector<double> us;
  us.reserve(series.points.size());
  for (const SweepPoint& point : series.points) us.push_back(point.mean_us());
  return us;
}

std::vector<LeftOut> left_out(std::span<const double> sizes, std::span<const CostLine> lines, double frame_limit_s) {
  std::vector<LeftOut> found;
  for (const CostLine& line : lines)
    for (std::size_t i = 0; i + 1 < sizes.size(); ++i)
      if (line.us[i] > 1e6 * frame_limit_s) found.push_back({line.name, sizes[i], line.us[i] / 1e6});
  return found;
}

/// Difference of logarithms: two per cent.
constexpr double kSameCost = 0.02;

std::vector<Crossover> crossovers(std::span<const double> sizes, std::span<const CostLine> lines) {
  std::vector<Crossover> found;
  for (std::size_t a = 0; a < lines.size(); ++a)
    for (std::size_t b = a + 1; b < lines.size(); ++b)
      for (std::size_t i = 1; i < sizes.size(); ++i) {
        // The logarithm of a's cost over b's, before and after.
        const double before = std::log(lines[a].us[i - 1] / lines[b].us[i - 1]);
        const double after = std::log(lines[a].us[i] / lines[b].us[i]);
        // If both lines cost the same within their noise, neither is faster.
        if (!(before * after < 0) || std::abs(before) < kSameCost) continue;
        const double part = before / (before - after);
        const double at = std::exp(std::lerp(std::log(sizes[i - 1]), std::log(sizes[i]), part));
        const bool a_below = before < 0;
        found.push_back({lines[a_below ? a : b].name, lines[a_below ? b : a].name, at});
      }
  return found;
}

std::vector<Ablation> ablations(std::span<const SweepSeries> series) {
  std::vector<Ablation> found;
  for (const SweepSeries& on : series) {
    if (on.skip != Skip::kOn) continue;
    const auto off = std::ranges::find_if(series, [&](const SweepSeries& one) {
      return one.detector == on.detector && one.gl.context == on.gl.context && one.skip == Skip::kOff &&
             one.renderer.has_value() == on.renderer.has_value();
    });
    if (off == series.end()) continue;
    for (std::size_t p = 0; p < on.points.size(); ++p) {
      const SweepPoint& with = on.points[p];
      const SweepPoint& without = off->points[p];
      if (with.repetitions.empty() || without.repetitions.empty()) continue;
      Ablation one;
      one.name = name_of(on);
      one.colliders = with.colliders;
      one.frames = with.pass_frames;
      one.frames_skipped = with.work.frames_skipped;
      one.meshlets_skinned = with.work.meshlets_skinned;
      one.triangles = without.work.triangles_tested;
      one.triangles_tested = with.work.triangles_tested;
      one.pairs = without.work.pairs_tested;
      one.pairs_tested = with.work.pairs_tested;
      one.pairs_meeting = with.work.pairs_meeting;
      one.off_us = 1e6 / without.hz();
      one.on_us = 1e6 / with.hz();
      const double skipped_share = static_cast<double>(with.skipped_timed) / static_cast<double>(with.frame_us.size());
      if (with.skipped_timed != 0)
        one.saved_by_frames_us =
            skipped_share * one.off_us - with.skipped_us / static_cast<double>(with.frame_us.size());
      one.saved_by_meshlets_us = one.off_us - one.on_us - one.saved_by_frames_us;
      found.push_back(std::move(one));
    }
  }
  return found;
}

}  // namespace vestige
