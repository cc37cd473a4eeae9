#include "analysis/frequency/sweep.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <random>
#include <span>
#include <utility>

#include "analysis/frequency/render_thread.hpp"
#include "analysis/run/detection_run.hpp"
#include "detector/output/texture_hash.hpp"
#include "traces/base/error.hpp"

namespace vestige {

namespace {

constexpr std::size_t kWarmUpFrames = 2;
/// Length of one stretch beside a renderer: 18 of the renderer's frames.
constexpr double kRenderedStretch_s = 0.2;

/// Consecutive frames of the trace. The first frame only gives the start of the second frame's segments.
using Place = std::vector<TraceFrame>;

std::uint64_t place_length(std::uint64_t trace_frames, const SweepSettings& settings) {
  return std::min<std::uint64_t>(settings.run_frames + 1, trace_frames);
}

std::vector<Place> read_places(TraceReader& trace, const SweepSettings& settings) {
  const std::uint64_t frames = trace.frame_count();
  if (frames < 2)
    throw Error("the trace", fmt::format("has {} frame{}; at least two are needed", frames, frames == 1 ? "" : "s"),
                "record a longer trace");
  const std::uint64_t length = place_length(frames, settings);
  const std::uint64_t count = sweep_places(frames, settings);
  std::vector<Place> places(count);
  TraceFrame frame;
  trace.rewind();
  for (std::uint64_t number = 0; trace.next(frame); ++number)
    for (std::uint64_t i = 0; i < count; ++i) {
      const std::uint64_t start = count == 1 ? 0 : i * (frames - length) / (count - 1);
      if (number >= start && number < start + length) places[i].push_back(frame);
    }
  return places;
}

/// The rows of one contestant with all colliders. Rows with fewer colliders should be prefixes of these, since a
/// collider's contact does not depend on the other colliders.
struct Reference {
  std::vector<std::vector<ContactRow>> rows;  // by place, then frame
};

/// Returns how many contacts of `timed` differ from those at the beginning of `reference`.
std::uint64_t differing(const ContactRow& timed, const ContactRow& reference) {
  std::uint64_t count = 0;
  for (std::size_t i = 0; i < timed.size(); ++i)
    if (timed[i].hit() != reference[i].hit() || timed[i].actuator != reference[i].actuator) ++count;
  return count;
}

class Sweep {
 public:
  Sweep(TraceReader& trace, const Avatar& avatar, const std::vector<Contestant>& contestants,
        const SweepSettings& settings)
      : avatar_(avatar),
        contestants_(contestants),
        settings_(settings),
        ids_(trace.collider_ids()),
        places_(read_places(trace, settings)) {
    for (const Contestant& contestant : contestants) {
      detectors_.push_back(contestant.make(PlaneSet()));
      SweepSeries series;
      series.detector = contestant.detector;
      series.skip = contestant.skip;
      series.method = detectors_.back()->method();
      series.approximate = detectors_.back()->is_approximate();
      renderers_.push_back(make_renderer(contestant));
      if (renderers_.back() != nullptr) series.renderer = renderers_.back()->gl_info();
      series.gl = detectors_.back()->gl_info();
      for (const std::uint32_t count : settings.counts) {
        if (count > ids_.size())
          throw Error("--counts", fmt::format("asks for {} colliders, but the trace has {}", count, ids_.size()),
                      "record a trace with more colliders (--count), or ask for fewer");
        SweepPoint point;
        point.colliders = count;
        series.points.push_back(std::move(point));
      }
      series_.push_back(std::move(series));
    }
  }

  std::vector<SweepSeries> run(const std::function<bool(double)>& progress) {
    struct Entry {
      std::size_t series;
      std::size_t point;
    };
    std::vector<Entry> open;
    for (std::size_t s = 0; s < series_.size(); ++s)
      for (std::size_t p = 0; p < settings_.counts.size(); ++p) open.push_back({s, p});
    for (std::size_t s = 0; s < series_.size(); ++s) {
      if (!progress(0)) return std::move(series_);
      references_.push_back(make_reference(contestants_[s]));
      for (SweepPoint& point : series_[s].points) describe(references_[s], point);
    }
    for (const Entry& entry : open) {
      if (!progress(0)) return std::move(series_);
      warm_up(entry.series, series_[entry.series].points[entry.point]);
    }

    std::mt19937_64 random(settings_.seed);
    const double total_s = settings_.min_time_s * static_cast<double>(open.size());
    double spent_s = 0;
    while (!open.empty()) {
      std::ranges::shuffle(open, random);
      for (const Entry& entry : open) {
        SweepPoint& point = series_[entry.series].points[entry.point];
        const double seconds =
            renderers_[entry.series] == nullptr ? measure(entry.series, point) : measure_rendered(entry.series, point);
        spent_s += std::min(seconds, settings_.min_time_s);
        if (!progress(total_s > 0 ? std::min(spent_s / total_s, 1.0) : 1.0)) return std::move(series_);
      }
      std::erase_if(open, [&](const Entry& entry) {
        double seconds = 0;
        const auto& repetitions = series_[entry.series].points[entry.point].repetitions;
        for (const Repetition& repetition : repetitions) seconds += repetition.seconds;
        return repetitions.size() >= places_.size() && seconds >= settings_.min_time_s;
      });
    }
    return std::move(series_);
  }

 private:
  std::span<const std::uint32_t> first_ids(std::uint32_t count) const { return std::span(ids_).first(count); }

  Reference make_reference(const Contestant& contestant) const {
    const auto detector = contestant.make(kHashedPlanes);
    const std::uint32_t most = std::ranges::max(settings_.counts);
    Reference reference;
    for (const Place& place : places_) {
      DetectionRun detection(avatar_, first_ids(most), *detector);
      detection.begin(place.front());
      auto& rows = reference.rows.emplace_back();
      for (std::size_t i = 1; i < place.size(); ++i) {
        detection.step(place[i]);
        rows.push_back(detection.row());
      }
    }
    return reference;
  }

  static void describe(const Reference& reference, SweepPoint& point) {
    TextureHash hash;
    for (const auto& rows : reference.rows)
      for (const ContactRow& row : rows) {
        const ContactRow beginning(row.begin(), row.begin() + point.colliders);
        hash.add(beginning);
        point.contacts += static_cast<std::uint64_t>(std::ranges::count_if(beginning, &Contact::hit));
      }
    point.texture_hash = hash.hex();
  }

  /// Runs at every place, since a place with another number of segments may need another program.
  void warm_up(std::size_t series, const SweepPoint& point) {
    for (const Place& place : places_) {
      DetectionRun detection(avatar_, first_ids(point.colliders), *detectors_[series]);
      for (std::size_t i = 0; i < std::min(kWarmUpFrames, place.size()); ++i) detection.step(place[i]);
    }
  }

  std::unique_ptr<RenderThread> make_renderer(const Contestant& contestant) const {
    if (!contestant.make_renderer_context) return nullptr;
    std::vector<const TraceFrame*> frames;
    for (const Place& place : places_)
      for (const TraceFrame& frame : place) frames.push_back(&frame);
    return std::make_unique<RenderThread>(contestant.make_renderer_context, avatar_, std::move(frames));
  }

  /// Measures as many places as fit into one stretch beside the renderer. Returns the seconds timed.
  double measure_rendered(std::size_t series, SweepPoint& point) {
    const auto start = std::chrono::steady_clock::now();
    std::chrono::duration<double> elapsed = {};
    double seconds = 0;
    renderers_[series]->resume();
    do {
      seconds += measure(series, point);
      elapsed = std::chrono::steady_clock::now() - start;
    } while (elapsed.count() < kRenderedStretch_s);
    point.rendered_frames += renderers_[series]->pause();
    point.rendered_s += elapsed.count();
    return seconds;
  }

  /// Measures the place whose turn it is. Returns the seconds timed.
  double measure(std::size_t series, SweepPoint& point) {
    const std::size_t place_number = point.repetitions.size() % places_.size();
    const Place& place = places_[place_number];
    DetectionRun detection(avatar_, first_ids(point.colliders), *detectors_[series]);
    detection.begin(place.front());
    Repetition repetition;
    DetectorWork work;
    std::uint64_t disagreements = 0;
    for (std::size_t i = 1; i < place.size(); ++i) {
      const auto start = std::chrono::steady_clock::now();
      const DetectorWork done = detection.step(place[i]);
      const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;
      point.frame_us.push_back(elapsed.count() * 1e6);
      repetition.seconds += elapsed.count();
      ++repetition.frames;
      if (done.frames_skipped != 0) {
        ++point.skipped_timed;
        point.skipped_us += point.frame_us.back();
      }
      work += done;
      const ContactRow& expected = references_[series].rows[place_number][i - 1];
      const std::uint64_t different = differing(detection.row(), expected);
      disagreements += different;
      if (different != 0 && promises_same_bits(series_[series].detector))
        throw Error(series_[series].detector,
                    fmt::format("frame {} gave other contacts with {} colliders than with {}", place[i].index,
                                point.colliders, expected.size()),
                    "this is a bug in Vestige or in the GL driver: try another --context, and report it");
    }
    if (point.repetitions.size() < places_.size()) {
      point.pass_frames += repetition.frames;
      point.work += work;
      point.disagreements += disagreements;
    }
    point.repetitions.push_back(repetition);
    return repetition.seconds;
  }

  const Avatar& avatar_;
  const std::vector<Contestant>& contestants_;
  const SweepSettings& settings_;
  std::vector<std::uint32_t> ids_;
  std::vector<Place> places_;
  std::vector<std::unique_ptr<Detector>> detectors_;
  std::vector<std::unique_ptr<RenderThread>> renderers_;  // null for a contestant that is measured alone
  std::vector<SweepSeries> series_;
  std::vector<Reference> references_;
};

}  // namespace

bool promises_same_bits(std::string_view detector) {
  return detector == "cpu" || detector == "geometry" || detector == "exact";
}

std::uint32_t sweep_places(std::uint64_t trace_frames, const SweepSettings& settings) {
  const std::uint64_t most = trace_frames / std::max<std::uint64_t>(1, place_length(trace_frames, settings));
  return static_cast<std::uint32_t>(std::clamp<std::uint64_t>(most, 1, settings.runs));
}

std::vector<SweepSeries> run_sweep(TraceReader& trace, const Avatar& avatar, const std::vector<Contestant>& contestants,
                                   const SweepSettings& settings, const std::function<bool(double)>& progress) {
  return Sweep(trace, avatar, contestants, settings).run(progress);
}

}  // namespace vestige
