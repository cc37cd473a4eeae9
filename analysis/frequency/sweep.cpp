#include "analysis/frequency/sweep.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <limits>
#include <map>
#include <random>
#include <utility>

#include "analysis/frequency/render_thread.hpp"
#include "analysis/run/detection_run.hpp"
#include "analysis/run/span_run.hpp"
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

/// The rows of a frame, by person.
using Rows = std::vector<ContactRow>;

/// The rows of one contestant with all colliders that were drawn at a place for any count, by place, then frame.
using Reference = std::vector<std::vector<Rows>>;

/// Returns where the colliders of one count stand in a row with all drawn colliders. Both lists are ascending.
std::vector<std::size_t> columns_of(const DrawnIds& some, const DrawnIds& all) {
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

/// A contestant in the race.
struct Racer {
  const SweepScene* scene = nullptr;
  std::vector<std::unique_ptr<Detector>> detectors = {};
  std::vector<DetectedPerson> people = {};
  std::unique_ptr<RenderThread> renderer = nullptr;  ///< null if it is measured alone
  Reference reference = {};
};

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
  RunningSweep(const std::vector<std::uint32_t>& ids, std::span<const SweptPerson> people, SweepSample sample,
               const std::vector<Contestant>& contestants, const SweepSettings& settings)
      : ids_(ids), people_(people), contestants_(contestants), settings_(settings), place_count_(sample.places.size()) {
    sweep_.places = static_cast<std::uint32_t>(place_count_);
    if (place_count_ != 0) sweep_.place_frames = static_cast<std::uint32_t>(sample.places.front().size() - 1);
    sweep_.sample_sha256 = sample.sha256;
    sweep_.trace = sample.trace;
    sweep_.sampled = sample.sampled;
    recorded_ = make_sweep_scene(std::move(sample.places), ids, settings.counts, settings.seed);
    for (const Contestant& contestant : contestants) add_series(contestant);
  }

  Sweep run(const std::function<bool(double)>& progress) {
    std::vector<Entry> open;
    for (std::size_t s = 0; s < sweep_.series.size(); ++s)
      for (std::size_t p = 0; p < settings_.counts.size(); ++p) open.push_back({s, p});
    for (std::size_t s = 0; s < sweep_.series.size(); ++s) {
      if (!progress(0)) return std::move(sweep_);
      racers_[s].reference = make_reference(s);
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

    std::vector<Turn> turns = turns_of(open);
    const double total_s = settings_.min_time_s * static_cast<double>(turns.size());
    double spent_s = 0;
    while (!turns.empty()) {
      std::ranges::shuffle(turns, random);
      for (const Turn& turn : turns) {
        spent_s += std::min(take(turn), settings_.min_time_s);
        if (!progress(total_s > 0 ? std::min(spent_s / total_s, 1.0) : 1.0)) return std::move(sweep_);
      }
      std::erase_if(turns, [&](const Turn& turn) { return is_measured(point_of(turn.entry).*turn.passes); });
    }
    if (settings_.stages) measure_stages(progress);
    return std::move(sweep_);
  }

 private:
  struct Entry {
    std::size_t series;
    std::size_t point;
  };
  /// A point, and which of its passes are measured: one frame after another, or spans of frames.
  struct Turn {
    Entry entry;
    std::vector<Repetition> SweepPoint::*passes;
  };
  /// Where a timed row comes from.
  struct RowPlace {
    Entry entry;
    std::size_t place;
    std::size_t frame;  ///< in its place
    std::size_t person;
  };

  std::vector<Turn> turns_of(const std::vector<Entry>& entries) const {
    std::vector<Turn> turns;
    for (const Entry& entry : entries) {
      turns.push_back({entry, &SweepPoint::repetitions});
      if (settings_.in_flight != 0 && racers_[entry.series].renderer == nullptr)
        turns.push_back({entry, &SweepPoint::spanned});
    }
    return turns;
  }

  /// Returns the seconds timed.
  double take(const Turn& turn) {
    if (turn.passes == &SweepPoint::spanned) return measure_throughput(turn.entry);
    return racers_[turn.entry.series].renderer == nullptr ? measure(turn.entry) : measure_rendered(turn.entry);
  }

  SweepPoint& point_of(const Entry& entry) { return sweep_.series[entry.series].points[entry.point]; }

  void add_series(const Contestant& contestant) {
    Racer& racer = racers_.emplace_back();
    racer.scene = &scene_of(contestant.crowd);
    racer.detectors = make_detectors(contestant, contestant.planes);
    racer.people = detected(racer.detectors);
    if (contestant.make_renderer_context) racer.renderer = make_renderer(contestant);
    const Detector& detector = *racer.detectors.front();
    SweepSeries series;
    series.detector = contestant.detector;
    series.skip = contestant.skip;
    series.planes = contestant.planes;
    series.method = detector.method();
    series.approximate = detector.is_approximate();
    series.triangles_kept = detector.triangles_kept();
    series.people = static_cast<std::uint32_t>(racer.people.size());
    series.first_only = contestant.crowd.first_only;
    if (racer.renderer != nullptr) series.renderer = racer.renderer->gl_info();
    series.gl = detector.gl_info();
    for (const std::uint32_t count : settings_.counts) {
      SweepPoint point;
      point.colliders = count;
      point.places = place_count_;
      point.in_flight = settings_.in_flight;
      series.points.push_back(std::move(point));
    }
    sweep_.series.push_back(std::move(series));
  }

  /// In a pass of its own, so that no timed frame reads these clocks.
  void measure_stages(const std::function<bool(double)>& progress) {
    for (std::size_t s = 0; s < sweep_.series.size(); ++s) {
      const Racer& racer = racers_[s];
      if (racer.renderer != nullptr) continue;
      for (std::size_t p = 0; p < settings_.counts.size(); ++p) {
        if (!progress(1)) return;
        std::vector<StagePlace> places;
        places.reserve(place_count_);
        for (std::size_t number = 0; number < place_count_; ++number)
          places.push_back({racer.scene->places[number], racer.scene->drawn[p][number]});
        point_of({s, p}).stages = vestige::measure_stages(racer.people, places, kStageShare * settings_.min_time_s);
      }
    }
  }

  /// Contestants with equal crowds share a scene.
  const SweepScene& scene_of(Crowd crowd) {
    if (crowd.copies == 1) return recorded_;
    std::unique_ptr<SweepScene>& scene = copied_[{crowd.copies, crowd.first_only}];
    if (scene == nullptr) scene = std::make_unique<SweepScene>(with_copies(recorded_, ids_, crowd));
    return *scene;
  }

  /// One for each person of the crowd.
  std::vector<std::unique_ptr<Detector>> make_detectors(const Contestant& contestant, PlaneSet planes) const {
    std::vector<std::unique_ptr<Detector>> detectors;
    detectors.reserve(contestant.crowd.copies * people_.size());
    for (std::uint32_t copy = 0; copy < contestant.crowd.copies; ++copy)
      for (const SweptPerson& person : people_) detectors.push_back(contestant.make(person.avatar, person.map, planes));
    return detectors;
  }

  std::vector<DetectedPerson> detected(const std::vector<std::unique_ptr<Detector>>& detectors) const {
    std::vector<DetectedPerson> people;
    people.reserve(detectors.size());
    for (std::size_t i = 0; i < detectors.size(); ++i)
      people.push_back({i, people_[i % people_.size()].avatar, *detectors[i]});
    return people;
  }

  std::unique_ptr<RenderThread> make_renderer(const Contestant& contestant) const {
    std::vector<const TraceFrame*> frames;
    for (const Place& place : recorded_.places)
      for (const TraceFrame& frame : place) frames.push_back(&frame);
    return std::make_unique<RenderThread>(contestant.make_renderer_context, people_.front().avatar, std::move(frames));
  }

  Reference make_reference(std::size_t series) const {
    const SweepScene& scene = *racers_[series].scene;
    const auto detectors = make_detectors(contestants_[series], kHashedPlanes);
    const std::vector<DetectedPerson> people = detected(detectors);
    Reference reference;
    for (std::size_t number = 0; number < place_count_; ++number) {
      const Place& place = scene.places[number];
      DetectionRun detection(people, scene.drawn_for_any[number]);
      detection.begin(place.front());
      auto& frames = reference.emplace_back();
      for (std::size_t i = 1; i < place.size(); ++i) {
        detection.step(place[i]);
        Rows& rows = frames.emplace_back();
        for (std::size_t person = 0; person < people.size(); ++person) rows.push_back(detection.row(person));
      }
    }
    return reference;
  }

  void describe(const Entry& entry) {
    SweepPoint& point = point_of(entry);
    const Racer& racer = racers_[entry.series];
    std::vector<TextureHash> hashes(racer.people.size());
    ContactRow row;
    for (std::size_t number = 0; number < place_count_; ++number) {
      const std::vector<std::size_t> columns = columns_at(entry, number);
      for (const Rows& rows : racer.reference[number]) {
        std::uint64_t contacts = 0;
        for (std::size_t person = 0; person < rows.size(); ++person) {
          row.clear(columns.size());
          for (std::size_t i = 0; i < columns.size(); ++i)
            if (const Contact& one = rows[person][columns[i]]; one.hit()) row[i] = one;
          hashes[person].add(row);
          point.results += row.size();
          contacts += row.hits();
        }
        point.contacts += contacts;
        if (contacts == 0) ++point.empty_frames;
        ++point.pass_frames;
      }
    }
    std::vector<std::string> texts;
    texts.reserve(hashes.size());
    for (TextureHash& hash : hashes) texts.push_back(hash.hex());
    point.texture_hash = texture_hash_of(texts);
  }

  /// Where the colliders of a point stand in the reference's rows.
  std::vector<std::size_t> columns_at(const Entry& entry, std::size_t place) const {
    const SweepScene& scene = *racers_[entry.series].scene;
    return columns_of(scene.drawn[entry.point][place], scene.drawn_for_any[place]);
  }

  /// Runs at every place, since a place with another number of segments may need another program.
  void warm_up(const Entry& entry) {
    const Racer& racer = racers_[entry.series];
    for (std::size_t number = 0; number < place_count_; ++number) {
      const Place& place = racer.scene->places[number];
      DetectionRun detection(racer.people, racer.scene->drawn[entry.point][number]);
      for (std::size_t i = 0; i < std::min(kWarmUpFrames, place.size()); ++i) detection.step(place[i]);
      if (settings_.in_flight != 0) warm_up_spans(entry, number);
    }
  }

  /// A detector that keeps frames in flight makes buffers for each of them.
  void warm_up_spans(const Entry& entry, std::size_t number) {
    const Racer& racer = racers_[entry.series];
    const std::span<const TraceFrame> place = racer.scene->places[number];
    SpanRun detection(racer.people, racer.scene->drawn[entry.point][number]);
    detection.begin(place.front());
    detection.step(place.subspan(1, std::min<std::size_t>(settings_.in_flight, place.size() - 1)));
  }

  void measure_cold(const Entry& entry) {
    SweepPoint& point = point_of(entry);
    RenderThread* const renderer = racers_[entry.series].renderer.get();
    if (renderer != nullptr) renderer->resume();
    for (std::size_t number = 0; number < place_count_; ++number) {
      const PlaceRun run = run_place(entry, number);
      point.cold.push_back(run.repetition);
      point.work += run.work;
      point.disagreements += run.disagreements;
    }
    if (renderer != nullptr) renderer->pause();
  }

  /// Measures as many places as fit into one stretch beside the renderer. Returns the seconds timed.
  double measure_rendered(const Entry& entry) {
    SweepPoint& point = point_of(entry);
    RenderThread& renderer = *racers_[entry.series].renderer;
    const auto start = std::chrono::steady_clock::now();
    std::chrono::duration<double> elapsed = {};
    double seconds = 0;
    renderer.resume();
    do {
      seconds += measure(entry);
      elapsed = std::chrono::steady_clock::now() - start;
    } while (elapsed.count() < kRenderedStretch_s);
    point.rendered_frames += renderer.pause();
    point.rendered_s += elapsed.count();
    return seconds;
  }

  /// Measures the place whose turn it is. Returns the seconds timed.
  double measure(const Entry& entry) {
    SweepPoint& point = point_of(entry);
    const PlaceRun run = run_place(entry, point.repetitions.size() % place_count_);
    point.frame_us.insert(point.frame_us.end(), run.frame_us.begin(), run.frame_us.end());
    point.skipped_timed += run.skipped_frames;
    point.skipped_us += run.skipped_us;
    point.repetitions.push_back(run.repetition);
    return run.repetition.seconds;
  }

  PlaceRun run_place(const Entry& entry, std::size_t number) {
    const Racer& racer = racers_[entry.series];
    const Place& place = racer.scene->places[number];
    const DrawnIds& ids = racer.scene->drawn[entry.point][number];
    const std::vector<std::size_t> columns = columns_at(entry, number);
    DetectionRun detection(racer.people, ids);
    detection.begin(place.front());
    PlaceRun run;
    for (std::size_t i = 1; i < place.size(); ++i) {
      const auto start = std::chrono::steady_clock::now();
      const DetectorWork done = detection.step(place[i]);
      const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;
      run.frame_us.push_back(elapsed.count() * 1e6);
      run.repetition.seconds += elapsed.count();
      ++run.repetition.frames;
      if (done.frames_skipped == racer.people.size()) {
        ++run.skipped_frames;
        run.skipped_us += run.frame_us.back();
      }
      run.work += done;
      for (std::size_t person = 0; person < racer.people.size(); ++person)
        run.disagreements += check_row(detection.row(person), {entry, number, i, person}, columns);
    }
    return run;
  }

  /// Measures the place whose turn it is, by spans of frames. Returns the seconds timed.
  double measure_throughput(const Entry& entry) {
    SweepPoint& point = point_of(entry);
    const std::size_t number = point.spanned.size() % place_count_;
    const Racer& racer = racers_[entry.series];
    const std::span<const TraceFrame> place = racer.scene->places[number];
    const std::vector<std::size_t> columns = columns_at(entry, number);
    SpanRun detection(racer.people, racer.scene->drawn[entry.point][number]);
    detection.begin(place.front());
    Repetition repetition;
    for (std::size_t first = 1; first < place.size(); first += settings_.in_flight) {
      const auto frames = place.subspan(first, std::min<std::size_t>(settings_.in_flight, place.size() - first));
      const auto start = std::chrono::steady_clock::now();
      detection.step(frames);
      repetition.seconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
      repetition.frames += frames.size();
      for (std::size_t person = 0; person < racer.people.size(); ++person)
        for (std::size_t k = 0; k < frames.size(); ++k)
          check_row(detection.row(person, k), {entry, number, first + k, person}, columns);
    }
    point.spanned.push_back(repetition);
    return repetition.seconds;
  }

  /// Returns how many contacts of a timed row differ from the reference. Throws `Error` if its detector promises none.
  std::uint64_t check_row(const ContactRow& row, const RowPlace& at, const std::vector<std::size_t>& columns) const {
    const Racer& racer = racers_[at.entry.series];
    const std::uint64_t different = differing(row, racer.reference[at.place][at.frame - 1][at.person], columns);
    const std::string& detector = contestants_[at.entry.series].detector;
    if (different != 0 && promises_same_bits(detector))
      throw Error(detector,
                  fmt::format("frame {} gave other contacts with {} colliders than with {}",
                              racer.scene->places[at.place][at.frame].index, columns.size(),
                              racer.scene->drawn_for_any[at.place].size()),
                  "this is a bug in Vestige or in the GL driver: try another --context, and report it");
    return different;
  }

  bool is_measured(const std::vector<Repetition>& repetitions) const {
    const std::size_t passes = repetitions.size() / place_count_;
    if (repetitions.size() % place_count_ != 0 || passes < kFewestPasses) return false;
    double seconds = 0;
    for (const Repetition& repetition : repetitions) seconds += repetition.seconds;
    return seconds >= settings_.min_time_s;
  }

  const std::vector<std::uint32_t>& ids_;
  std::span<const SweptPerson> people_;
  const std::vector<Contestant>& contestants_;
  const SweepSettings& settings_;
  std::size_t place_count_;
  SweepScene recorded_;
  std::map<std::pair<std::uint32_t, bool>, std::unique_ptr<SweepScene>> copied_;  // by copies and first_only
  std::vector<Racer> racers_;
  Sweep sweep_;
};

}  // namespace

double SweepPoint::mean_us() const {
  return repetitions.empty() ? std::numeric_limits<double>::quiet_NaN() : 1e6 / hz();
}

bool promises_same_bits(std::string_view detector) {
  return detector == "cpu" || detector == "geometry" || detector == "compute" || detector == "exact";
}

Sweep run_sweep(TraceReader& trace, std::span<const SweptPerson> people, const ContestantMaker& survey,
                const std::vector<Contestant>& contestants, const SweepSettings& settings,
                const std::function<bool(double)>& progress) {
  // Before the survey, which takes long for a long trace.
  const std::size_t colliders = trace.collider_ids().size();
  if (const std::uint32_t most = std::ranges::max(settings.counts); most > colliders)
    throw Error("--counts", fmt::format("asks for {} colliders, but the trace has {}", most, colliders),
                "record a trace with more colliders (--count), or ask for fewer");
  std::vector<std::unique_ptr<Detector>> surveys;
  std::vector<DetectedPerson> surveyed;
  for (std::size_t i = 0; i < people.size(); ++i) {
    surveys.push_back(survey(people[i].avatar, people[i].map, PlaneSet()));
    surveyed.push_back({i, people[i].avatar, *surveys.back()});
  }
  SweepSample sample = sample_places(trace, surveyed, settings.runs, settings.run_frames, [&] { return progress(0); });
  return RunningSweep(trace.collider_ids(), people, std::move(sample), contestants, settings).run(progress);
}

}  // namespace vestige
