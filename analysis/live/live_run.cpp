#include "analysis/live/live_run.hpp"

#include <fmt/format.h>
#include <poll.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "analysis/base/clocks.hpp"
#include "detector/output/contacts_hash.hpp"

namespace vestige {

namespace {

using namespace std::chrono_literals;
using Clock = LiveFrame::Clock;

/// The longest time between two calls of `go_on`.
constexpr std::chrono::nanoseconds kLongestWait = 20ms;
/// What was on stays on for so long until the next frame, as in a trace (`FrameCalls`).
constexpr std::chrono::milliseconds kLongestStay = 200ms;
constexpr std::size_t kMostMarkers = 1000;  ///< that wait for a frame
constexpr const char* kInput = "input";     // traces/FORMAT.md

std::int64_t nanoseconds(Clock::duration duration) {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(duration).count();
}

class LiveRun {
 public:
  LiveRun(LiveInput& input, std::span<const DetectedPerson> people, const LiveOptions& options, const LiveCalls& calls)
      : input_(input),
        people_(people),
        options_(options),
        calls_(calls),
        felt_(people, columns_.columns(), calls),
        hashes_(people.size()) {
    for (const int descriptor : input.descriptors())
      places_.push_back({.fd = descriptor, .events = POLLIN, .revents = 0});
    felt_.begin_run();
  }

  LiveResult run() {
    while (calls_.go_on() && !input_.has_ended() && !is_over()) {
      wait();
      input_.receive();
      take_markers();
      if (const auto due = next_frame()) {
        take(*due);
      } else {
        look_for_silence();
      }
      for (const std::string& problem : input_.take_problems()) calls_.tell(problem);
    }
    return finish();
  }

 private:
  bool is_over() const {
    return options_.duration_s && has_begun_ && seconds(Clock::now() - start_) >= *options_.duration_s;
  }

  Clock::time_point tick_time(std::uint64_t tick) const {
    return start_ + std::chrono::nanoseconds(std::llround(static_cast<double>(tick) / *options_.rate_hz * 1e9));
  }

  /// Waits until something arrives or is due.
  void wait() {
    const Clock::time_point now = Clock::now();
    Clock::time_point until = now + kLongestWait;
    if (has_begun_ && !is_silent_) until = std::min(until, input_.arrived() + options_.ttl);
    if (has_begun_ && !is_silent_ && options_.rate_hz) until = std::min(until, tick_time(tick_));
    const std::int64_t left_ns = std::max<std::int64_t>(nanoseconds(until - now), 0);
    const timespec time = {.tv_sec = 0, .tv_nsec = left_ns};
    ::ppoll(places_.data(), places_.size(), &time, nullptr);
  }

  bool has_new() const { return input_.has_begun() && input_.frames() != frames_seen_; }

  /// Returns the time of a frame that is to be detected now.
  std::optional<Clock::time_point> next_frame() {
    if (!has_begun_ || is_silent_ || !options_.rate_hz)
      return has_new() ? std::optional(input_.arrived()) : std::nullopt;
    if (Clock::now() < tick_time(tick_) || Clock::now() >= input_.arrived() + options_.ttl) return {};
    skip_missed();
    return tick_time(tick_);
  }

  /// Of several frames that are due, only the newest is made.
  void skip_missed() {
    const auto newest = static_cast<std::uint64_t>(std::max(0.0, seconds(Clock::now() - start_) * *options_.rate_hz));
    if (newest <= tick_) return;
    result_.missed_deadlines += newest - tick_;
    tick_ = newest;
  }

  void take(Clock::time_point time) {
    const bool is_new = has_new();
    const bool was_silent = is_silent_;
    const bool begins = begin(time);
    input_.show(time, live_);
    frames_seen_ = input_.frames();
    // With a rate, what comes between two frames is left out by intent.
    if (!options_.rate_hz) result_.superseded = input_.superseded();
    TraceFrame& frame = live_.frame;
    frame.index = result_.frames++;
    frame.time_ns = std::max(last_ns_, nanoseconds(time - start_));
    last_ns_ = frame.time_ns;
    if (begins || live_.begins) {
      frame.teleported.clear();
      for (const ColliderSample& collider : frame.colliders) frame.teleported.push_back(collider.id);
    }
    const Clock::time_point since = is_new ? live_.arrived : time;
    for (std::size_t i = 0; i < people_.size() && !live_.is_silent.empty(); ++i)
      felt_.mute(i, live_.is_silent[people_[i].person]);
    detect(frame, since);
    tell_moments(since, begins);
    std::vector<RecordingNote> notes = take_notes();
    if (calls_.record) calls_.record(frame, std::move(notes));
    if (was_silent) calls_.tell("input comes again");
  }

  /// Begins, or goes on after silence. Returns whether one of them is so.
  bool begin(Clock::time_point time) {
    if (has_begun_ && !is_silent_) {
      ++tick_;
      return false;
    }
    if (!has_begun_) start_ = time;
    has_begun_ = true;
    is_silent_ = false;
    if (options_.rate_hz)
      tick_ = 1 + static_cast<std::uint64_t>(std::max(0.0, seconds(time - start_) * *options_.rate_hz));
    return true;
  }

  void detect(const TraceFrame& frame, Clock::time_point since) {
    std::swap(numbered_, numbered_before_);
    if (columns_.number(frame, numbered_)) felt_.use_ids(columns_.columns(), numbered_before_);
    felt_.take(numbered_, law_time_s(numbered_.time_s()), since);
    for (std::size_t i = 0; i < hashes_.size(); ++i) hashes_[i].add(frame.index, felt_.row(i), columns_.ids());
  }

  void tell_moments(Clock::time_point since, bool begins) {
    const Clock::time_point now = felt_.detected();
    LiveMoments moments = {.arrived = since,
                           .decoded = live_.decoded,
                           .detected = now,
                           .pose_delay_s = live_.pose_delay_s,
                           .interval_s = {}};
    if (!begins) moments.interval_s = seconds(now - detected_before_);
    detected_before_ = now;
    calls_.note(moments);
  }

  /// Returns the time for a law, which never goes back: a frame may have arrived a little before the laws went on
  /// without it.
  double law_time_s(double time_s) { return law_time_s_ = std::max(law_time_s_, time_s); }

  /// Beyond the most that wait, the input counts markers as malformed.
  void take_markers() {
    if (markers_.size() >= kMostMarkers) return;
    for (RecordingNote& marker : input_.take_markers())
      if (calls_.record) markers_.push_back(std::move(marker));
  }

  std::vector<RecordingNote> take_notes() {
    std::vector<RecordingNote> notes = std::exchange(markers_, {});
    const auto note = [&notes](RecordingNote::Kind kind, std::uint64_t count, const char* text) {
      if (count > 0) notes.push_back({.kind = kind, .count = count, .text = text});
    };
    const std::uint64_t lost = input_.losses().total();
    note(RecordingNote::Kind::kDropped, lost - std::exchange(lost_noted_, lost), kInput);
    const std::uint64_t before = std::exchange(superseded_noted_, result_.superseded);
    note(RecordingNote::Kind::kSuperseded, result_.superseded - before, "");
    return notes;
  }

  void look_for_silence() {
    const Clock::time_point now = Clock::now();
    if (!has_begun_) return;
    if (now < input_.arrived() + options_.ttl) {
      if (now >= input_.arrived() + kLongestStay) felt_.gap(law_time_s(seconds(now - start_)), now);
      return;
    }
    const bool was_silent = std::exchange(is_silent_, true);
    if (!was_silent) felt_.forget_contacts();
    felt_.gap(law_time_s(seconds(now - start_)), now);
    if (was_silent) return;
    ++result_.silences;
    calls_.tell(
        fmt::format("no whole frame came for {} ms: all actuators are off until one comes", options_.ttl.count()));
  }

  LiveResult finish() {
    if (has_begun_) result_.duration_s = seconds(Clock::now() - start_);
    result_.colliders = columns_.seen();
    result_.losses = input_.losses();
    result_.notes = take_notes();
    result_.people = felt_.finish();
    for (ContactsHash& hash : hashes_) result_.contacts_hashes.push_back(hash.hex());
    return std::move(result_);
  }

  LiveInput& input_;
  std::span<const DetectedPerson> people_;
  const LiveOptions& options_;
  const LiveCalls& calls_;
  LiveColumns columns_;
  FeltFrames felt_;
  std::vector<ContactsHash> hashes_;
  std::vector<pollfd> places_;
  bool has_begun_ = false;
  bool is_silent_ = false;
  Clock::time_point start_;
  Clock::time_point detected_before_;
  std::uint64_t tick_ = 0;  ///< of the next frame, with a rate
  std::uint64_t frames_seen_ = 0;
  std::int64_t last_ns_ = 0;
  double law_time_s_ = 0;
  std::vector<RecordingNote> markers_;  ///< that wait for a frame
  std::uint64_t lost_noted_ = 0;
  std::uint64_t superseded_noted_ = 0;
  LiveFrame live_;
  TraceFrame numbered_;
  TraceFrame numbered_before_;
  LiveResult result_;
};

}  // namespace

LiveResult run_live(LiveInput& input, std::span<const DetectedPerson> people, const LiveOptions& options,
                    const LiveCalls& calls) {
  return LiveRun(input, people, options, calls).run();
}

}  // namespace vestige
