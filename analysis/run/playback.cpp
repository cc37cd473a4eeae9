#include "analysis/run/playback.hpp"

#include <algorithm>
#include <cstddef>
#include <optional>
#include <thread>

#include "analysis/base/clocks.hpp"

namespace vestige {

namespace {

using namespace std::chrono_literals;
using Clock = PlaybackCalls::Clock;

constexpr auto kSlice = 50ms;  ///< longest wait, so that an interrupt is noticed
constexpr double kGap_s = 0.2;

Clock::duration to_duration(double duration_s) {
  // Beyond a century the clock's count would overflow.
  return std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(std::min(duration_s, 3e9)));
}

/// One run through the trace.
class Run {
 public:
  /// `offset_s` is added to the trace's times that are handed on.
  Run(double rate, const PlaybackCalls& calls, double first_s, double offset_s, Clock::time_point begin,
      std::size_t columns)
      : rate_(rate),
        calls_(calls),
        laws_(calls.make_laws()),
        first_s_(first_s),
        last_s_(first_s),
        offset_s_(offset_s),
        begin_(begin),
        nothing_(columns) {}

  Clock::time_point due(double time_s) const { return begin_ + to_duration((time_s - first_s_) / rate_); }

  /// Waits until a frame is due. Returns false if the playback must end.
  bool wait_for(double time_s, double share) {
    const auto until = due(time_s);
    for (auto now = Clock::now(); now < until; now = Clock::now()) {
      if (!calls_.go_on(share)) return false;
      const double now_s = first_s_ + seconds(now - begin_) * rate_;
      if (now_s > last_s_ + kGap_s && now_s < time_s)
        for (std::size_t i = 0; i < laws_.size(); ++i)
          calls_.take(i, laws_[i](now_s + offset_s_, nothing_, nullptr), now);
      std::this_thread::sleep_until(std::min(until, now + kSlice));
    }
    return calls_.go_on(share);
  }

  void take(double time_s, const DetectionRun& detection) {
    ++frames_;
    last_s_ = time_s;
    for (std::size_t i = 0; i < laws_.size(); ++i)
      calls_.take(i, laws_[i](time_s + offset_s_, detection.row(i), &detection.frame(i)), due(time_s));
  }

  std::uint64_t frames() const { return frames_; }
  /// Returns the time from the first frame to the first frame of the next run. The step between the runs is the mean
  /// step.
  double length_s() const {
    const double length_s = last_s_ - first_s_;
    return frames_ > 1 ? length_s + length_s / static_cast<double>(frames_ - 1) : kGap_s;
  }

 private:
  double rate_;
  const PlaybackCalls& calls_;
  std::vector<PlaybackCalls::Law> laws_;
  double first_s_;
  double last_s_;
  double offset_s_;
  Clock::time_point begin_;
  ContactRow nothing_;
  std::uint64_t frames_ = 0;
};

}  // namespace

PlaybackResult play(TraceReader& trace, std::span<const DetectedPerson> people, const PlaybackOptions& options,
                    const PlaybackCalls& calls) {
  const std::vector<std::uint32_t>& ids = trace.collider_ids();
  const auto frame_count = static_cast<double>(trace.frame_count());
  PlaybackResult result;
  result.people.resize(people.size());
  const auto start = Clock::now();
  auto begin = start;
  double offset_s = 0;
  TraceFrame trace_frame;
  bool going = frame_count > 0;
  while (going) {
    trace.rewind();
    DetectionRun detection(people, ids);
    std::optional<Run> run;
    while (going && trace.next(trace_frame)) {
      const double time_s = trace_frame.time_s();
      if (!run) {
        run.emplace(options.rate, calls, time_s, offset_s, begin, ids.size());
      } else if (Clock::now() > run->due(time_s)) {
        ++result.missed_deadlines;
      }
      going = run->wait_for(time_s, static_cast<double>(run->frames()) / frame_count);
      if (!going) break;
      const bool was_behind = result.fell_behind();
      result.most_late_s = std::max(result.most_late_s, seconds(Clock::now() - run->due(time_s)));
      if (result.fell_behind() && !was_behind) calls.fell_behind();
      detection.step(trace_frame);
      run->take(time_s, detection);
      ++result.frames;
      for (std::size_t i = 0; i < people.size(); ++i) result.people[i].contacts += detection.row(i).hits();
    }
    for (std::size_t i = 0; i < people.size(); ++i) {
      result.people[i].non_finite_frames += detection.builder(i).non_finite_frames();
      result.people[i].non_finite_segments += detection.builder(i).non_finite_segments();
    }
    if (going) ++result.loops;
    going = going && options.loop && run;
    if (!going) break;
    begin += to_duration(run->length_s() / options.rate);
    offset_s += run->length_s();
  }
  result.duration_s = seconds(Clock::now() - start);
  return result;
}

}  // namespace vestige
