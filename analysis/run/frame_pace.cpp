#include "analysis/run/frame_pace.hpp"

#include <algorithm>
#include <optional>
#include <thread>

#include "analysis/base/clocks.hpp"

namespace vestige {

namespace {

using namespace std::chrono_literals;
using Clock = FrameCalls::Clock;

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
  Run(double rate, const FrameCalls& calls, double first_s, double offset_s, Clock::time_point begin)
      : rate_(rate), calls_(calls), first_s_(first_s), last_s_(first_s), offset_s_(offset_s), begin_(begin) {}

  Clock::time_point due(double time_s) const { return begin_ + to_duration((time_s - first_s_) / rate_); }

  /// Waits until a frame is due. Returns false if the playback must end.
  bool wait_for(double time_s, double share) {
    const auto until = due(time_s);
    for (auto now = Clock::now(); now < until; now = Clock::now()) {
      if (!calls_.go_on(share)) return false;
      const double now_s = first_s_ + seconds(now - begin_) * rate_;
      if (calls_.gap && now_s > last_s_ + kGap_s && now_s < time_s) calls_.gap(now_s + offset_s_, now);
      std::this_thread::sleep_until(std::min(until, now + kSlice));
    }
    return calls_.go_on(share);
  }

  void take(const TraceFrame& frame) {
    ++frames_;
    last_s_ = frame.time_s();
    calls_.take(frame, last_s_ + offset_s_, due(last_s_));
  }

  /// Waits until the frame after the last one would be due.
  void hold_the_last() const {
    const auto until = begin_ + to_duration(length_s() / rate_);
    for (auto now = Clock::now(); now < until && calls_.go_on(1); now = Clock::now())
      std::this_thread::sleep_until(std::min(until, now + kSlice));
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
  const FrameCalls& calls_;
  double first_s_;
  double last_s_;
  double offset_s_;
  Clock::time_point begin_;
  std::uint64_t frames_ = 0;
};

}  // namespace

FramePace play_frames(TraceReader& trace, const PlaybackOptions& options, const FrameCalls& calls) {
  const auto frame_count = static_cast<double>(trace.frame_count());
  FramePace pace;
  const auto start = Clock::now();
  auto begin = start;
  double offset_s = 0;
  TraceFrame frame;
  bool going = frame_count > 0;
  while (going) {
    trace.rewind();
    if (calls.begin_run) calls.begin_run();
    std::optional<Run> run;
    while (going && trace.next(frame)) {
      const double time_s = frame.time_s();
      if (!run) {
        run.emplace(options.rate, calls, time_s, offset_s, begin);
      } else if (Clock::now() > run->due(time_s)) {
        ++pace.missed_deadlines;
      }
      going = run->wait_for(time_s, static_cast<double>(run->frames()) / frame_count);
      if (!going) break;
      const bool was_behind = pace.fell_behind();
      pace.most_late_s = std::max(pace.most_late_s, seconds(Clock::now() - run->due(time_s)));
      if (pace.fell_behind() && !was_behind) calls.fell_behind();
      run->take(frame);
      ++pace.frames;
    }
    if (going) ++pace.loops;
    if (going && !options.loop && run && calls.at_end == FrameCalls::AtEnd::kHoldTheLast) run->hold_the_last();
    going = going && options.loop && run;
    if (!going) break;
    begin += to_duration(run->length_s() / options.rate);
    offset_s += run->length_s();
  }
  pace.duration_s = seconds(Clock::now() - start);
  return pace;
}

}  // namespace vestige
