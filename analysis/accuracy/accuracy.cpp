#include "analysis/accuracy/accuracy.hpp"

#include <algorithm>
#include <chrono>
#include <iterator>
#include <numeric>
#include <optional>
#include <random>
#include <utility>

#include "analysis/base/clocks.hpp"
#include "analysis/run/detection_run.hpp"
#include "detector/frame.hpp"

namespace vestige {

namespace {

constexpr std::size_t kTurnFrames = 32;
constexpr std::uint64_t kSkinningFrames = 5;
constexpr int kWarmUpFrames = 2;

/// The state that a contestant keeps from turn to turn at one rate.
struct Run {
  Run(const MovingScene& scene, const AccuracyContestant& contestant)
      : detection(scene.avatar, scene.collider_ids, *contestant.instance) {}
  DetectionRun detection;
  ContactEventFinder finder;
};

class RateMeasurement {
 public:
  RateMeasurement(const MovingScene& scene, const std::vector<AccuracyContestant>& contestants,
                  const std::vector<std::size_t>& which, double rate_hz, std::size_t passes)
      : scene_(scene),
        rate_hz_(rate_hz),
        passes_(passes),
        last_(last_frame_within(scene, rate_hz)),
        skinning_step_(std::max<std::uint64_t>(1, last_ / kSkinningFrames)) {
    points_.resize(which.size());
    contestants_.reserve(which.size());
    for (std::size_t i = 0; i < which.size(); ++i) {
      contestants_.push_back(&contestants[which[i]]);
      warm_up(*contestants_[i]);
      points_[i].contestant = which[i];
      points_[i].rate_hz = rate_hz;
      points_[i].frames = last_;
      points_[i].frame_us.reserve(last_ * passes);
    }
    begin_pass();
  }

  bool is_done() const { return pass_ == passes_; }
  /// Of all passes.
  std::uint64_t frames_done() const { return is_done() ? passes_ * last_ : pass_ * last_ + done_; }

  /// Runs the next frames through one contestant after the other.
  void take_turns(std::mt19937_64& random) {
    std::vector<TraceFrame> frames;
    frames.reserve(kTurnFrames);
    for (; frames.size() < kTurnFrames && done_ < last_; ++done_) frames.push_back(sampler_->next());
    std::vector<std::size_t> order(contestants_.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::ranges::shuffle(order, random);
    for (const std::size_t contestant : order)
      for (const TraceFrame& frame : frames) measure(contestant, frame);
    if (done_ == last_ && ++pass_ < passes_) begin_pass();
  }

  std::vector<AccuracyPoint> score(const TrueContacts& truth, double tolerance_s) {
    const double frame_s = 1 / rate_hz_;
    const double until_s = static_cast<double>(last_) * frame_s;
    for (std::size_t i = 0; i < points_.size(); ++i) {
      points_[i].contacts = runs_[i].finder.contacts();
      std::vector<ContactEvent> events = runs_[i].finder.take();
      const std::size_t colliders = scene_.collider_ids.size();
      if (scene_.has_spheres()) {
        points_[i].touches =
            score_touches(truth.by_actuator, events, {scene_.is_sphere, rate_hz_, last_, truth.rate_hz});
        events = touches_of(events, scene_.is_sphere);
      }
      points_[i].score = score_events(truth.events, events, colliders, {EventMatch::kOverlap, frame_s}, until_s);
      points_[i].tolerated = score_events(truth.events, events, colliders, {EventMatch::kImpact, tolerance_s}, until_s);
    }
    return std::move(points_);
  }

 private:
  /// Each pass sees the same frames.
  void begin_pass() {
    done_ = 0;
    sampler_.emplace(scene_, rate_hz_);
    const TraceFrame first = sampler_->next();
    runs_.clear();
    runs_.reserve(contestants_.size());
    for (std::size_t i = 0; i < contestants_.size(); ++i) {
      runs_.emplace_back(scene_, *contestants_[i]);
      runs_[i].detection.begin(first);
      points_[i].passes.emplace_back();
      points_[i].processor_passes.emplace_back();
    }
  }

  /// A driver may compile programs when they are first needed. This time must not count as a frame's time.
  void warm_up(const AccuracyContestant& contestant) const {
    SceneSampler sampler(scene_, rate_hz_);
    DetectionRun detection(scene_.avatar, scene_.collider_ids, *contestant.instance);
    detection.begin(sampler.next());
    for (int i = 0; i < kWarmUpFrames; ++i) detection.step(sampler.next());
  }

  void measure(std::size_t contestant, const TraceFrame& trace_frame) {
    Run& run = runs_[contestant];
    AccuracyPoint& point = points_[contestant];
    const double processor_start_s = process_cpu_s();
    const auto start = std::chrono::steady_clock::now();
    run.detection.step(trace_frame);
    const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;
    const double processor_elapsed_s = process_cpu_s() - processor_start_s;
    point.frame_us.push_back(elapsed.count() * 1e6);
    Repetition& pass = point.passes.back();
    if (pass_ == 0 && pass.frames % skinning_step_ == 0)
      point.skinning.add(scene_.avatar, trace_frame.poses.front(), run.detection.frame(),
                         *contestants_[contestant]->instance);
    ++pass.frames;
    pass.seconds += elapsed.count();
    ++point.processor_passes.back().frames;
    point.processor_passes.back().seconds += processor_elapsed_s;
    run.finder.add(run.detection.frame(), run.detection.row());
  }

  const MovingScene& scene_;
  std::vector<const AccuracyContestant*> contestants_;
  double rate_hz_;
  std::size_t passes_;
  std::optional<SceneSampler> sampler_;
  std::uint64_t last_;
  std::size_t pass_ = 0;
  std::uint64_t done_ = 0;  ///< of this pass
  std::uint64_t skinning_step_;
  std::vector<Run> runs_;
  std::vector<AccuracyPoint> points_;
};

}  // namespace

double AccuracyPoint::precision() const {
  constexpr double kQuantile = 1.96;  // of the normal distribution, 95 % two-sided
  const auto error_of = [](const EventScore& events) {
    std::vector<ClusterShare> clusters;
    clusters.reserve(events.of_collider.size());
    for (const EventCounts& counts : events.of_collider)
      clusters.push_back({static_cast<double>(counts.wrong()), static_cast<double>(counts.true_events())});
    return share_standard_error(clusters);
  };
  return kQuantile * std::max(error_of(score), error_of(tolerated));
}

AccuracyPoint& AccuracyPoint::operator+=(const AccuracyPoint& other) {
  frames += other.frames;
  contacts += other.contacts;
  score += other.score;
  tolerated += other.tolerated;
  if (touches && other.touches) *touches += *other.touches;
  skinning += other.skinning;
  frame_us.insert(frame_us.end(), other.frame_us.begin(), other.frame_us.end());
  seeds += other.seeds;
  passes.insert(passes.end(), other.passes.begin(), other.passes.end());
  processor_passes.insert(processor_passes.end(), other.processor_passes.begin(), other.processor_passes.end());
  return *this;
}

AccuracyScene& AccuracyScene::operator+=(const AccuracyScene& other) {
  duration_s += other.duration_s;
  seeds.insert(seeds.end(), other.seeds.begin(), other.seeds.end());
  true_contacts += other.true_contacts;
  true_events += other.true_events;
  checked_frames += other.checked_frames;
  half_contacts += other.half_contacts;
  half_events += other.half_events;
  half_score += other.half_score;
  if (other.inside_s) inside_s = inside_s.value_or(0) + *other.inside_s;
  if (points.empty()) {
    points = other.points;
    return *this;
  }
  for (const AccuracyPoint& added : other.points) {
    const auto same = [&](const AccuracyPoint& point) {
      return point.contestant == added.contestant && point.rate_hz == added.rate_hz;
    };
    if (const auto mine = std::ranges::find_if(points, same); mine != points.end()) *mine += added;
  }
  return *this;
}

std::vector<AccuracyPoint> run_accuracy(const MovingScene& scene, const TrueContacts& truth,
                                        const std::vector<AccuracyContestant>& contestants,
                                        const std::vector<std::size_t>& which, const AccuracySettings& settings,
                                        const std::function<bool(double)>& progress) {
  std::uint64_t total = 0;
  for (const double rate_hz : settings.rates_hz) total += last_frame_within(scene, rate_hz) * settings.passes;
  std::mt19937_64 random(settings.seed);
  std::vector<AccuracyPoint> points;
  std::uint64_t before = 0;
  for (const double rate_hz : settings.rates_hz) {
    RateMeasurement measurement(scene, contestants, which, rate_hz, settings.passes);
    while (!measurement.is_done()) {
      measurement.take_turns(random);
      const std::uint64_t done = before + measurement.frames_done();
      if (!progress(static_cast<double>(done) / static_cast<double>(total))) return points;
    }
    before += measurement.frames_done();
    std::ranges::move(measurement.score(truth, settings.tolerance_s), std::back_inserter(points));
  }
  return points;
}

}  // namespace vestige
