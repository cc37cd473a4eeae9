#include "analysis/accuracy/accuracy.hpp"

#include <algorithm>
#include <chrono>
#include <iterator>
#include <numeric>
#include <random>
#include <utility>

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
  RateMeasurement(const MovingScene& scene, const std::vector<AccuracyContestant>& contestants, double rate_hz)
      : scene_(scene),
        contestants_(contestants),
        sampler_(scene, rate_hz),
        last_(last_frame_within(scene, rate_hz)),
        skinning_step_(std::max<std::uint64_t>(1, last_ / kSkinningFrames)) {
    runs_.reserve(contestants.size());
    points_.resize(contestants.size());
    const TraceFrame first = sampler_.next();
    for (std::size_t i = 0; i < contestants.size(); ++i) {
      warm_up(contestants[i], rate_hz);
      runs_.emplace_back(scene, contestants[i]);
      runs_[i].detection.begin(first);
      points_[i].contestant = i;
      points_[i].rate_hz = rate_hz;
      points_[i].frame_us.reserve(last_);
    }
  }

  bool is_done() const { return done_ == last_; }
  std::uint64_t frames_done() const { return done_; }

  /// Runs the next frames through one contestant after the other.
  void take_turns(std::mt19937_64& random) {
    std::vector<TraceFrame> frames;
    frames.reserve(kTurnFrames);
    for (; frames.size() < kTurnFrames && done_ < last_; ++done_) frames.push_back(sampler_.next());
    std::vector<std::size_t> order(contestants_.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::ranges::shuffle(order, random);
    for (const std::size_t contestant : order)
      for (const TraceFrame& frame : frames) measure(contestant, frame);
  }

  std::vector<AccuracyPoint> score(const TrueContacts& truth) {
    const double frame_s = 1 / points_.front().rate_hz;
    for (std::size_t i = 0; i < points_.size(); ++i) {
      points_[i].contacts = runs_[i].finder.contacts();
      const std::vector<ContactEvent> events = runs_[i].finder.take();
      points_[i].score = score_events(truth.events, events, frame_s, static_cast<double>(last_) * frame_s);
    }
    return std::move(points_);
  }

 private:
  /// A driver may compile programs when they are first needed. This time must not count as a frame's time.
  void warm_up(const AccuracyContestant& contestant, double rate_hz) const {
    SceneSampler sampler(scene_, rate_hz);
    DetectionRun detection(scene_.avatar, scene_.collider_ids, *contestant.instance);
    detection.begin(sampler.next());
    for (int i = 0; i < kWarmUpFrames; ++i) detection.step(sampler.next());
  }

  void measure(std::size_t contestant, const TraceFrame& trace_frame) {
    Run& run = runs_[contestant];
    AccuracyPoint& point = points_[contestant];
    const auto start = std::chrono::steady_clock::now();
    run.detection.step(trace_frame);
    const std::chrono::duration<double, std::micro> elapsed = std::chrono::steady_clock::now() - start;
    point.frame_us.push_back(elapsed.count());
    run.finder.add(run.detection.frame(), run.detection.row());
    if (point.frames % skinning_step_ == 0)
      point.skinning.add(scene_.avatar, trace_frame, run.detection.frame(), *contestants_[contestant].instance);
    ++point.frames;
  }

  const MovingScene& scene_;
  const std::vector<AccuracyContestant>& contestants_;
  SceneSampler sampler_;
  std::uint64_t last_;
  std::uint64_t done_ = 0;
  std::uint64_t skinning_step_;
  std::vector<Run> runs_;
  std::vector<AccuracyPoint> points_;
};

}  // namespace

double AccuracyPoint::total_s() const {
  return std::accumulate(frame_us.begin(), frame_us.end(), 0.0) * 1e-6;
}

std::vector<AccuracyPoint> run_accuracy(const MovingScene& scene, const TrueContacts& truth,
                                        const std::vector<AccuracyContestant>& contestants,
                                        const std::vector<double>& rates_hz, std::uint64_t seed,
                                        const std::function<bool(double)>& progress) {
  std::uint64_t total = 0;
  for (const double rate_hz : rates_hz) total += last_frame_within(scene, rate_hz);
  std::mt19937_64 random(seed);
  std::vector<AccuracyPoint> points;
  std::uint64_t before = 0;
  for (const double rate_hz : rates_hz) {
    RateMeasurement measurement(scene, contestants, rate_hz);
    while (!measurement.is_done()) {
      measurement.take_turns(random);
      const std::uint64_t done = before + measurement.frames_done();
      if (!progress(static_cast<double>(done) / static_cast<double>(total))) return points;
    }
    before += measurement.frames_done();
    std::ranges::move(measurement.score(truth), std::back_inserter(points));
  }
  return points;
}

}  // namespace vestige
