#include "analysis/batch/batch_run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <condition_variable>
#include <exception>
#include <filesystem>
#include <limits>
#include <mutex>
#include <optional>
#include <system_error>
#include <thread>
#include <utility>

#include "analysis/base/clocks.hpp"
#include "analysis/base/provenance.hpp"
#include "analysis/run/detection_run.hpp"
#include "analysis/scoring/contact_recording.hpp"
#include "analysis/scoring/contact_recording_file.hpp"
#include "analysis/scoring/scores.hpp"
#include "detector/actuators/law_maker.hpp"
#include "detector/frame.hpp"
#include "traces/base/sha256.hpp"
#include "traces/base/system_error.hpp"
#include "traces/files/output_file.hpp"
#include "traces/motion/animation_choice.hpp"
#include "traces/recording/sampled_scene.hpp"
#include "traces/trace_file/trace_reader.hpp"
#include "traces/trace_file/trace_writer.hpp"

namespace vestige {

namespace {

constexpr auto kProgressPeriod = std::chrono::milliseconds(100);
constexpr double kScenarioBytesPerFrame = 1500;  // roughly; for the progress bar

struct ItemTimes {
  double recording_s = 0;
  double reading_s = 0;
  double detection_s = 0;
  double scoring_s = 0;
};

nlohmann::ordered_json to_json(const ItemTimes& times) {
  const Machine machine = this_machine();
  return {{"schema_version", 1},          {"time", utc_now()},
          {"machine", to_json(machine)},  {"recording_s", times.recording_s},
          {"reading_s", times.reading_s}, {"detection_s", times.detection_s},
          {"scoring_s", times.scoring_s}};
}

/// Thrown if the user stops the run; not an error.
struct Stopped {};

/// Finds which actuators of the batch's maps the spheres of a trace cover.
class CoverFinder {
 public:
  CoverFinder(const BatchPlan& plan, std::map<std::string, CoveredPlaces>& found) {
    if (std::ranges::none_of(plan.laws, [](const std::string& law) { return law_named(law).needs_poses; })) return;
    for (const BatchMap& map : plan.maps)
      if (map.layout != nullptr) maps_.push_back({map.layout->posed_places(), found[map.name]});
  }

  /// Adds the contacts of a frame.
  void add(const DetectorFrame& frame, std::span<const Contact> row) {
    if (std::ranges::none_of(row, &Contact::hit)) return;
    for (auto& [places, found] : maps_) {
      places.move(frame.palette);
      for (std::uint32_t column = 0; column < row.size(); ++column) {
        if (!row[column].hit()) continue;
        places.covered_by(column, frame, found.places);
        found.first.push_back(found.places.size());
      }
    }
  }

 private:
  struct OneMap {
    PosedPlaces places;
    CoveredPlaces& found;
  };
  std::vector<OneMap> maps_;
};

/// One batch under way.
class BatchRun {
 public:
  BatchRun(const BatchPlan& plan, const Shard& shard, const BatchFolder& folder,
           const std::function<std::unique_ptr<Detector>()>& make_detector)
      : plan_(plan), folder_(folder), make_detector_(make_detector), key_(item_key(to_json(plan))) {
    for (std::size_t i = 0; i < plan.traces.size(); ++i)
      if (shard.has(i)) mine_.push_back(i);
    for (const std::size_t trace : mine_) weights_.push_back(weight_of(plan.traces[trace]));
    shares_ = std::vector<std::atomic<double>>(mine_.size());
    items_.resize(mine_.size());
    failures_.resize(mine_.size());
    for (const std::string& law : plan.laws) {
      laws_.emplace_back().name = law;
      laws_.back().options = plan.law_options;
      laws_.back().actuators = plan.actuators.model;
      laws_.back().unfelt_m = plan.unfelt_m;
    }
  }

  BatchOutcome run(std::size_t jobs, const std::function<bool(const BatchProgress&)>& progress) {
    in_threads(std::min(jobs, mine_.size()), progress);
    if (failure_) std::rethrow_exception(failure_);
    BatchOutcome outcome;
    outcome.interrupted = finished_ < mine_.size();
    for (std::optional<BatchItem>& item : items_)
      if (item) outcome.items.push_back(std::move(*item));
    for (std::optional<BatchFailure>& failure : failures_)
      if (failure) outcome.failures.push_back(std::move(*failure));
    return outcome;
  }

 private:
  double weight_of(const BatchTrace& trace) const {
    if (trace.scenario != nullptr) return kScenarioBytesPerFrame * plan_.recording.rate_hz * plan_.recording.duration_s;
    std::error_code missing;
    const auto bytes = std::filesystem::file_size(trace.given, missing);
    return missing ? 1 : std::max(1.0, static_cast<double>(bytes));
  }

  void in_threads(std::size_t count, const std::function<bool(const BatchProgress&)>& progress) {
    std::vector<std::thread> threads;
    running_ = count;
    try {
      for (std::size_t i = 0; i < count; ++i) threads.emplace_back([this] { run_thread(); });
    } catch (const std::system_error&) {
      const std::lock_guard lock(mutex_);
      running_ -= count - threads.size();  // the threads that exist do all the work
      if (threads.empty()) throw Error("--jobs", "the system cannot start a thread", "try again later");
    }
    for (std::unique_lock lock(mutex_); running_ != 0; lock.lock()) {
      ended_.wait_for(lock, kProgressPeriod);
      lock.unlock();
      if (!progress(progress_now())) stop_ = true;
    }
    for (std::thread& thread : threads) thread.join();
  }

  void run_thread() {
    try {
      work();
    } catch (const Stopped&) {
      // Unfinished work is dropped.
    } catch (...) {
      note_failure();
    }
    const std::lock_guard lock(mutex_);
    --running_;
    ended_.notify_all();
  }

  BatchProgress progress_now() const {
    double done = 0;
    double all = 0;
    for (std::size_t i = 0; i < weights_.size(); ++i) {
      done += weights_[i] * shares_[i];
      all += weights_[i];
    }
    return {all > 0 ? done / all : 1, finished_, mine_.size()};
  }

  void note_failure() {
    const std::lock_guard lock(mutex_);
    stop_ = true;
    if (!failure_) failure_ = std::current_exception();
  }

  void work() {
    const std::unique_ptr<Detector> detector = make_detector_();
    for (std::size_t i = next_++; i < mine_.size() && !stop_; i = next_++) {
      const BatchTrace& trace = plan_.traces[mine_[i]];
      ItemTimes times;
      if (trace.scenario != nullptr) record_scenario(trace, times);
      Computed computed;
      try {
        computed = compute(i, *detector, times);
      } catch (const Error& error) {
        failures_[i] = failure_of("trace", trace.name, trace.given, error);
      }
      // Outside: what cannot be written is no fault of the trace's.
      if (computed.recording) store(trace, computed, times);
      if (!failures_[i]) items_[i] = BatchItem{mine_[i], !computed.recording.has_value(), std::move(computed.item)};
      shares_[i] = 1;
      ++finished_;
    }
  }

  struct Computed {
    nlohmann::ordered_json item;
    std::optional<RecordedTrace> recording;  ///< none: an earlier run's
  };

  std::string path_of(const BatchTrace& trace) const {
    return trace.scenario != nullptr ? folder_.trace(trace.name) : trace.given;
  }

  /// Unless it is there from an earlier run, of which the folder is.
  void record_scenario(const BatchTrace& trace, ItemTimes& times) const {
    const std::string path = folder_.trace(trace.name);
    const std::string finished_item = folder_.item(trace.name);
    if (std::filesystem::exists(path) && std::filesystem::exists(finished_item) &&
        folder_.finished(trace.name, key_, sha256_of_file(path)))
      return;
    const double begin_s = thread_cpu_s();
    const Animation* animation = find_animation(plan_.avatar, "");
    const std::uint32_t count = plan_.recording.count.value_or(trace.scenario->default_count);
    const auto colliders = trace.scenario->make(plan_.avatar, animation, {count, trace.seed});
    TraceWriterOptions writing;
    writing.shape = colliders->shape();
    writing.overwrite = Overwrite::kAllow;
    writing.chunk_s = std::numeric_limits<double>::infinity();  // gives the same bytes, however long recording takes
    const std::string growing = folder_.growing_trace(trace.name);
    {
      TraceWriter writer(growing,
                         {{"program", program_version()},
                          {"colliders", std::string(trace.scenario->name)},
                          {"count", std::to_string(count)},
                          {"seed", std::to_string(trace.seed)},
                          {"rate_hz", fmt::format("{}", plan_.recording.rate_hz)}},
                         {{plan_.avatar, {plan_.avatar_glb}}}, writing);
      RecordingSettings settings;
      settings.rate_hz = plan_.recording.rate_hz;
      settings.duration_s = plan_.recording.duration_s;
      const auto write = [&](const TraceFrame& frame) {
        writer.write(frame);
        return true;
      };
      record(write, {{plan_.avatar, animation}}, *colliders, settings, [&](double) { return !stop_; });
      if (stop_) throw Stopped();
      writer.finish();
    }
    std::error_code failure;
    std::filesystem::rename(growing, path, failure);
    if (failure) throw system_error(path, "could not give the recorded trace its name", failure.value());
    times.recording_s = thread_cpu_s() - begin_s;
  }

  Computed compute(std::size_t i, Detector& detector, ItemTimes& times) {
    const BatchTrace& trace = plan_.traces[mine_[i]];
    const std::string path = path_of(trace);
    const std::string sha256 = sha256_of_file(path);
    if (auto earlier = folder_.finished(trace.name, key_, sha256)) return {std::move(*earlier), std::nullopt};
    Computed computed;
    computed.item = {{"schema_version", 1}, {"key", key_}, {"trace", trace.name}, {"trace_sha256", sha256}};
    computed.recording = detect(path, i, detector, computed.item, times);
    const double begin_s = thread_cpu_s();
    computed.item["scores"] = score_maps(*computed.recording);
    times.scoring_s = thread_cpu_s() - begin_s;
    return computed;
  }

  RecordedTrace detect(const std::string& path, std::size_t i, Detector& detector, nlohmann::ordered_json& item,
                       ItemTimes& times) {
    double mark_s = thread_cpu_s();
    const auto lap_s = [&] {
      const double now_s = thread_cpu_s();
      return now_s - std::exchange(mark_s, now_s);
    };
    const std::size_t number = plan_.traces[mine_[i]].person.value_or(0);
    TraceReader reader(path, People::kSeveral);
    const RecordedPerson& person = reader.people()[number];
    if (sha256_hex(person.avatar_glb) != plan_.avatar_sha256)
      throw Error(path,
                  fmt::format("was recorded with another avatar than that of the batch, '{}'", plan_.avatar_given),
                  "run one batch for each avatar, or name the avatar of the traces with --avatar");
    const Facing facing = plan_.avatar.facing.axis;
    if (const auto recorded = facing_named(person.facing); recorded && *recorded != facing)
      throw Error(path,
                  fmt::format("records that its avatar faces {}, and that of the batch faces {}", to_string(*recorded),
                              to_string(facing)),
                  "run one batch for each facing");
    if (!plan_.takes_radii && reader.has_spheres())
      throw Error(path, fmt::format("has colliders with a radius, of which {} tests only the centres", plan_.detector),
                  "choose --detector cpu, geometry, compute, exact, boxes, capsules or decimated");
    require_spheres(plan_.laws, reader.has_spheres(), path);
    const std::vector<std::uint32_t>& ids = reader.collider_ids();
    const auto frame_count = static_cast<double>(reader.frame_count());
    RecordedTrace recorded;
    recorded.collider_ids = ids;
    recorded.shape = reader.has_spheres() ? ColliderShape::kSpheres : ColliderShape::kPoints;
    ContactRecording& recording = recorded.contacts;
    CoverFinder cover(plan_, recorded.covered);
    const std::vector<DetectedPerson> detected = {{number, plan_.avatar, detector}};
    DetectionRun detection(detected, ids);
    TraceFrame trace_frame;
    std::uint64_t frames = 0;
    std::uint64_t contacts = 0;
    for (bool more = reader.next(trace_frame); more; more = reader.next(trace_frame)) {
      times.reading_s += lap_s();
      detection.step(trace_frame);
      contacts += detection.row().hits();
      recording.add(detection.frame().time_s, detection.row());
      cover.add(detection.frame(), detection.row());
      times.detection_s += lap_s();
      ++frames;
      if (stop_) throw Stopped();
      shares_[i] = static_cast<double>(frames) / frame_count;
    }
    times.reading_s += lap_s();
    require_frames(reader, path);
    item["frames"] = frames;
    item["colliders"] = ids.size();
    item["contacts"] = contacts;
    item["origin_changes"] = detection.builder().origin_changes();
    item["non_finite_frames"] = detection.builder().non_finite_frames();
    item["non_finite_segments"] = detection.builder().non_finite_segments();
    item["damage"] = damage_of(reader, plan_.traces[mine_[i]].given);
    return recorded;
  }

  nlohmann::ordered_json score_maps(const RecordedTrace& trace) const {
    std::vector<ScoredLayout> layouts;
    std::vector<std::string> names;
    for (const BatchMap& map : plan_.maps) {
      if (map.layout == nullptr) continue;
      const auto covered = trace.covered.find(map.name);
      layouts.push_back({map.layout.get(), covered == trace.covered.end() ? nullptr : &covered->second});
      names.push_back(map.name);
    }
    const std::vector<Scores> scores = score_all(trace.contacts, layouts, laws_);
    nlohmann::ordered_json json = nlohmann::ordered_json::array();
    for (std::size_t i = 0; i < scores.size(); ++i) {
      nlohmann::ordered_json values;
      for (std::size_t k = 0; k < metrics().size(); ++k)
        values[metrics()[k].name] =
            std::isfinite(scores[i][k]) ? nlohmann::ordered_json(scores[i][k]) : nlohmann::ordered_json(nullptr);
      json.push_back({{"map", names[i / laws_.size()]}, {"law", laws_[i % laws_.size()].name}, {"values", values}});
    }
    return json;
  }

  void store(const BatchTrace& trace, Computed& computed, const ItemTimes& times) const {
    write_contact_recording(folder_.contacts(trace.name), *computed.recording);
    computed.item["contacts_sha256"] = sha256_of_file(folder_.contacts(trace.name));
    write_json_file(folder_.item_times(trace.name), to_json(times));
    write_json_file(folder_.item(trace.name), computed.item);  // last, since this file means that all others exist
  }

  const BatchPlan& plan_;
  const BatchFolder& folder_;
  const std::function<std::unique_ptr<Detector>()>& make_detector_;
  std::string key_;
  std::vector<std::size_t> mine_;  ///< positions of the shard's traces
  std::vector<double> weights_;
  std::vector<std::atomic<double>> shares_;            ///< share done of each trace
  std::vector<std::optional<BatchItem>> items_;        ///< each is written by one thread
  std::vector<std::optional<BatchFailure>> failures_;  ///< likewise
  std::vector<LawChoice> laws_;
  std::atomic<std::size_t> next_ = 0;
  std::atomic<std::size_t> finished_ = 0;
  std::atomic<bool> stop_ = false;
  std::mutex mutex_;
  std::condition_variable ended_;
  std::size_t running_ = 0;
  std::exception_ptr failure_;
};

}  // namespace

BatchOutcome run_batch(const BatchPlan& plan, const Shard& shard, const BatchFolder& folder, std::size_t jobs,
                       const std::function<std::unique_ptr<Detector>()>& make_detector,
                       const std::function<bool(const BatchProgress&)>& progress) {
  return BatchRun(plan, shard, folder, make_detector).run(jobs, progress);
}

}  // namespace vestige
