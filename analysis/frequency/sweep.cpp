#include "analysis/frequency/sweep.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <iterator>
#include <random>
#include <utility>

#include "analysis/frequency/render_thread.hpp"
#include "analysis/run/detection_run.hpp"
#include "detector/output/texture_hash.hpp"
#include "traces/base/error.hpp"

namespace vestige {

namespace {

constexpr std::size_t kWarmUpFrames = 2;
/// The fewest passes after the first: one pass alone tells nothing of noise.
constexpr std::size_t kFewestPasses = 2;
/// Length of one stretch beside a renderer: 18 of the renderer's frames.
constexpr double kRenderedStretch_s = 0.2;
/// Means need less time than intervals.
constexpr double kStageShare = 0.2;

/// The colliders of one place: those that are drawn for one count, or for any count.
using Colliders = std::vector<std::uint32_t>;

/// The rows of one contestant with all colliders that were drawn at a place for any count, by place, then frame.
using Reference = std::vector<std::vector<ContactRow>>;

/// Returns where the colliders of one count stand in a row with all drawn colliders. Both lists are ascending.
std::vector<std::size_t> columns_of(const Colliders& some, const Colliders& all) {
  std::vector<std::size_t> columns;
  columns.reserve(some.size());
  for (const std::uint32_t id : some)
    columns.push_back(static_cast<std::size_t>(std::ranges::lower_bound(all, id) - all.begin()));
  return columns;
}

/// Returns how many contacts of `timed` differ from those in these columns of `reference`.
std::uint64_t differing(const ContactRow& timed, const ContactRow& reference, const std::vector<std::size_t>& columns) {
  std::uint64_t count = 0;
  for (std::size_t i = 0; i < timed.size(); ++i) {
    const Contact& expected = reference[columns[i]];
    if (timed[i].hit() != expected.hit() || timed[i].actuator != expected.actuator) ++count;
  }
  return count;
}

/// What one measurement of one place showed.
struct PlaceRun {
  Repetition repetition;
  std::vector<double> frame_us;
  DetectorWork work;
  std::uint64_t skipped_frames = 0;
  double skipped_us = 0;
  std::uint64_t disagreements = 0;
};

class RunningSweep {
 public:
  RunningSweep(const std::vector<std::uint32_t>& ids, const Avatar& avatar, SweepSample sample,
               const std::vector<Contestant>& contestants, const SweepSettings& settings)
      : avatar_(avatar), contestants_(contestants), settings_(settings), places_(std::move(sample.places)) {
    sweep_.places = static_cast<std::uint32_t>(places_.size());
    if (!places_.empty()) sweep_.place_frames = static_cast<std::uint32_t>(places_.front().size() - 1);
    sweep_.sample_sha256 = sample.sha256;
    sweep_.trace = sample.trace;
    sweep_.sampled = sample.sampled;
    drawn_for_any_.resize(places_.size());
    for (const std::uint32_t count : settings.counts) {
      drawn_.push_back(draw_colliders(ids, count, places_.size(), settings.seed));
      for (std::size_t i = 0; i < places_.size(); ++i) {
        Colliders both;
        std::ranges::set_union(drawn_for_any_[i], drawn_.back()[i], std::back_inserter(both));
        drawn_for_any_[i] = std::move(both);
      }
    }
    for (const Contestant& contestant : contestants) add_series(contestant);
  }

  Sweep run(const std::function<bool(double)>& progress) {
    std::vector<Entry> open;
    for (std::size_t s = 0; s < sweep_.series.size(); ++s)
      for (std::size_t p = 0; p < settings_.counts.size(); ++p) open.push_back({s, p});
    for (std::size_t s = 0; s < sweep_.series.size(); ++s) {
      if (!progress(0)) return std::move(sweep_);
      references_.push_back(make_reference(contestants_[s]));
      for (std::size_t p = 0; p < settings_.counts.size(); ++p) describe({s, p});
    }
    for (const Entry& entry : open) {
      if (!progress(0)) return std::move(sweep_);
      warm_up(entry);
    }
    std::mt19937_64 random(settings_.seed);
    std::ranges::shuffle(open, random);
    for (const Entry& entry : open) {
      if (!progress(0)) return std::move(sweep_);
      measure_cold(entry);
    }

    const double total_s = settings_.min_time_s * static_cast<double>(open.size());
    double spent_s = 0;
    while (!open.empty()) {
      std::ranges::shuffle(open, random);
      for (const Entry& entry : open) {
        const double seconds = renderers_[entry.series] == nullptr ? measure(entry) : measure_rendered(entry);
        spent_s += std::min(seconds, settings_.min_time_s);
        if (!progress(total_s > 0 ? std::min(spent_s / total_s, 1.0) : 1.0)) return std::move(sweep_);
      }
      std::erase_if(open, [&](const Entry& entry) { return is_measured(point_of(entry)); });
    }
    if (settings_.stages) measure_stages(progress);
    return std::move(sweep_);
  }

 private:
  struct Entry {
    std::size_t series;
    std::size_t point;
  };

  SweepPoint& point_of(const Entry& entry) { return sweep_.series[entry.series].points[entry.point]; }

  void add_series(const Contestant& contestant) {
    detectors_.push_back(contestant.make(contestant.planes));
    SweepSeries series;
    series.detector = contestant.detector;
    series.skip = contestant.skip;
    series.planes = contestant.planes;
    series.method = detectors_.back()->method();
    series.approximate = detectors_.back()->is_approximate();
    series.triangles_kept = detectors_.back()->triangles_kept();
    renderers_.push_back(make_renderer(contestant));
    if (renderers_.back() != nullptr) series.renderer = renderers_.back()->gl_info();
    series.gl = detectors_.back()->gl_info();
    for (const std::uint32_t count : settings_.counts) {
      SweepPoint point;
      point.colliders = count;
      point.places = places_.size();
      series.points.push_back(std::move(point));
    }
    sweep_.series.push_back(std::move(series));
  }

  /// In a pass of its own, so that no timed frame reads these clocks.
  void measure_stages(const std::function<bool(double)>& progress) {
    for (std::size_t s = 0; s < sweep_.series.size(); ++s) {
      if (renderers_[s] != nullptr) continue;
      for (std::size_t p = 0; p < settings_.counts.size(); ++p) {
        if (!progress(1)) return;
        std::vector<StagePlace> places;
        places.reserve(places_.size());
        for (std::size_t number = 0; number < places_.size(); ++number)
          places.push_back({places_[number], drawn_[p][number]});
        point_of({s, p}).stages =
            vestige::measure_stages(avatar_, places, *detectors_[s], kStageShare * settings_.min_time_s);
      }
    }
  }

  std::unique_ptr<RenderThread> make_renderer(const Contestant& contestant) const {
    if (!contestant.make_renderer_context) return nullptr;
    std::vector<const TraceFrame*> frames;
    for (const Place& place : places_)
      for (const TraceFrame& frame : place) frames.push_back(&frame);
    return std::make_unique<RenderThread>(contestant.make_renderer_context, avatar_, std::move(frames));
  }

  Reference make_reference(const Contestant& contestant) const {
    const auto detector = contestant.make(kHashedPlanes);
    Reference reference;
    for (std::size_t number = 0; number < places_.size(); ++number) {
      const Place& place = places_[number];
      DetectionRun detection(avatar_, drawn_for_any_[number], *detector);
      detection.begin(place.front());
      auto& rows = reference.emplace_back();
      for (std::size_t i = 1; i < place.size(); ++i) {
        detection.step(place[i]);
        rows.push_back(detection.row());
      }
    }
    return reference;
  }

  void describe(const Entry& entry) {
    SweepPoint& point = point_of(entry);
    TextureHash hash;
    ContactRow row;
    for (std::size_t number = 0; number < places_.size(); ++number) {
      const std::vector<std::size_t> columns = columns_of(drawn_[entry.point][number], drawn_for_any_[number]);
      for (const ContactRow& all : references_[entry.series][number]) {
        row.clear(columns.size());
        for (std::size_t i = 0; i < columns.size(); ++i)
          if (all[columns[i]].hit()) row[i] = all[columns[i]];
        hash.add(row);
        const auto contacts = static_cast<std::uint64_t>(std::ranges::count_if(row, &Contact::hit));
        point.contacts += contacts;
        if (contacts == 0) ++point.empty_frames;
        ++point.pass_frames;
      }
    }
    point.texture_hash = hash.hex();
  }

  /// Runs at every place, since a place with another number of segments may need another program.
  void warm_up(const Entry& entry) {
    for (std::size_t number = 0; number < places_.size(); ++number) {
      DetectionRun detection(avatar_, drawn_[entry.point][number], *detectors_[entry.series]);
      for (std::size_t i = 0; i < std::min(kWarmUpFrames, places_[number].size()); ++i)
        detection.step(places_[number][i]);
    }
  }

  void measure_cold(const Entry& entry) {
    SweepPoint& point = point_of(entry);
    if (renderers_[entry.series] != nullptr) renderers_[entry.series]->resume();
    for (std::size_t number = 0; number < places_.size(); ++number) {
      const PlaceRun run = run_place(entry, number);
      point.cold.push_back(run.repetition);
      point.work += run.work;
      point.disagreements += run.disagreements;
    }
    if (renderers_[entry.series] != nullptr) renderers_[entry.series]->pause();
  }

  /// Measures as many places as fit into one stretch beside the renderer. Returns the seconds timed.
  double measure_rendered(const Entry& entry) {
    SweepPoint& point = point_of(entry);
    const auto start = std::chrono::steady_clock::now();
    std::chrono::duration<double> elapsed = {};
    double seconds = 0;
    renderers_[entry.series]->resume();
    do {
      seconds += measure(entry);
      elapsed = std::chrono::steady_clock::now() - start;
    } while (elapsed.count() < kRenderedStretch_s);
    point.rendered_frames += renderers_[entry.series]->pause();
    point.rendered_s += elapsed.count();
    return seconds;
  }

  /// Measures the place whose turn it is. Returns the seconds timed.
  double measure(const Entry& entry) {
    SweepPoint& point = point_of(entry);
    const PlaceRun run = run_place(entry, point.repetitions.size() % places_.size());
    point.frame_us.insert(point.frame_us.end(), run.frame_us.begin(), run.frame_us.end());
    point.skipped_timed += run.skipped_frames;
    point.skipped_us += run.skipped_us;
    point.repetitions.push_back(run.repetition);
    return run.repetition.seconds;
  }

  PlaceRun run_place(const Entry& entry, std::size_t number) {
    const Place& place = places_[number];
    const Colliders& ids = drawn_[entry.point][number];
    const std::vector<std::size_t> columns = columns_of(ids, drawn_for_any_[number]);
    DetectionRun detection(avatar_, ids, *detectors_[entry.series]);
    detection.begin(place.front());
    PlaceRun run;
    for (std::size_t i = 1; i < place.size(); ++i) {
      const auto start = std::chrono::steady_clock::now();
      const DetectorWork done = detection.step(place[i]);
      const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;
      run.frame_us.push_back(elapsed.count() * 1e6);
      run.repetition.seconds += elapsed.count();
      ++run.repetition.frames;
      if (done.frames_skipped != 0) {
        ++run.skipped_frames;
        run.skipped_us += run.frame_us.back();
      }
      run.work += done;
      const std::uint64_t different = differing(detection.row(), references_[entry.series][number][i - 1], columns);
      run.disagreements += different;
      if (different != 0 && promises_same_bits(contestants_[entry.series].detector))
        throw Error(contestants_[entry.series].detector,
                    fmt::format("frame {} gave other contacts with {} colliders than with {}", place[i].index,
                                ids.size(), drawn_for_any_[number].size()),
                    "this is a bug in Vestige or in the GL driver: try another --context, and report it");
    }
    return run;
  }

  bool is_measured(const SweepPoint& point) const {
    const std::size_t passes = point.repetitions.size() / places_.size();
    if (point.repetitions.size() % places_.size() != 0 || passes < kFewestPasses) return false;
    double seconds = 0;
    for (const Repetition& repetition : point.repetitions) seconds += repetition.seconds;
    return seconds >= settings_.min_time_s;
  }

  const Avatar& avatar_;
  const std::vector<Contestant>& contestants_;
  const SweepSettings& settings_;
  std::vector<Place> places_;
  std::vector<std::vector<Colliders>> drawn_;  // by count, then place
  std::vector<Colliders> drawn_for_any_;       // by place
  std::vector<std::unique_ptr<Detector>> detectors_;
  std::vector<std::unique_ptr<RenderThread>> renderers_;  // null for a contestant that is measured alone
  std::vector<Reference> references_;
  Sweep sweep_;
};

}  // namespace

bool promises_same_bits(std::string_view detector) {
  return detector == "cpu" || detector == "geometry" || detector == "exact";
}

Sweep run_sweep(TraceReader& trace, const Avatar& avatar, Detector& survey, const std::vector<Contestant>& contestants,
                const SweepSettings& settings, const std::function<bool(double)>& progress) {
  // Before the survey, which takes long for a long trace.
  const std::size_t colliders = trace.collider_ids().size();
  if (const std::uint32_t most = std::ranges::max(settings.counts); most > colliders)
    throw Error("--counts", fmt::format("asks for {} colliders, but the trace has {}", most, colliders),
                "record a trace with more colliders (--count), or ask for fewer");
  SweepSample sample =
      sample_places(trace, avatar, survey, settings.runs, settings.run_frames, [&] { return progress(0); });
  return RunningSweep(trace.collider_ids(), avatar, std::move(sample), contestants, settings).run(progress);
}

}  // namespace vestige
