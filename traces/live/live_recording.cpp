#include "traces/live/live_recording.hpp"

#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <cstring>
#include <string_view>
#include <utility>

#include "traces/base/error.hpp"
#include "traces/base/nanoseconds.hpp"
#include "traces/live/live_scene.hpp"

namespace vestige {

namespace {

using Clock = std::chrono::steady_clock;
using WhenBehind = RecordingThread::WhenBehind;

/// The longest time between two calls of `asked`.
constexpr std::chrono::milliseconds kLongestWait(20);
/// Limits, in number and time, of the datagrams taken before a due frame is made.
constexpr int kMostInATurn = 1000;
constexpr std::chrono::milliseconds kLongestTurn(5);
/// How late a frame may be made: about the interval between a sender's own frames, plus the delays of the network. So a
/// busy machine costs no frame; each lost frame would be a gap over which no contact can occur.
constexpr double kMostLate_s = 0.02;
constexpr std::string_view kInput = "input";  // traces/FORMAT.md

std::int64_t nanoseconds_since(Clock::time_point start) {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(Clock::now() - start).count();
}

pollfd reading_from(int descriptor) {
  return {.fd = descriptor, .events = POLLIN, .revents = 0};
}

/// Waits at most `timeout`. Returns whether there is something to read, in any of the places.
bool await(std::span<pollfd> places, std::chrono::nanoseconds timeout) {
  const auto wait = std::clamp<std::chrono::nanoseconds>(timeout, std::chrono::nanoseconds(0), kLongestWait);
  const timespec time = {.tv_sec = 0, .tv_nsec = wait.count()};
  return ::ppoll(places.data(), places.size(), &time, nullptr) > 0;
}

void note(std::vector<RecordingNote>& notes, std::string_view topic, std::uint64_t count) {
  if (count > 0) notes.push_back({.kind = RecordingNote::Kind::kDropped, .count = count, .text = std::string(topic)});
}

void note_frames(std::vector<RecordingNote>& notes, std::uint64_t count) {
  note(notes, "/pose", count);
  note(notes, "/colliders", count);
}

/// Serves a request from outside. Returns true if the recording must stop.
bool must_stop(RecordingThread& out, const LiveSettings& settings) {
  const LiveRequest request = settings.asked();
  if (request == LiveRequest::kSnapshot) out.snapshot();
  return request == LiveRequest::kStop || out.is_full();
}

}  // namespace

LiveCounts record_lines(int descriptor, LiveNdjson& lines, RecordingThread& out, const LiveSettings& settings) {
  const Clock::time_point start = Clock::now();
  const double most_ns = settings.duration_s.value_or(INFINITY) * kNanosecondsPerSecond;
  std::uint64_t frames = 0;
  std::uint64_t noted = 0;
  bool ended = false;
  const auto take = [&](TraceFrame frame) {
    if (ended || static_cast<double>(frame.time_ns) >= most_ns) {
      ended = true;
      return;
    }
    std::vector<RecordingNote> notes;
    note_frames(notes, lines.malformed() - std::exchange(noted, lines.malformed()));
    out.put(std::move(frame), std::move(notes), WhenBehind::kWait);
    ++frames;
  };
  std::string buffer(std::size_t{64} << 10, '\0');
  pollfd place = reading_from(descriptor);
  while (!ended && !must_stop(out, settings)) {
    if (!await({&place, 1}, kLongestWait)) {
      ended = static_cast<double>(nanoseconds_since(start)) >= most_ns;
      continue;
    }
    const ssize_t count = ::read(descriptor, buffer.data(), buffer.size());
    if (count < 0 && (errno == EINTR || errno == EAGAIN)) continue;
    if (count < 0) throw Error("standard input", std::string("could not be read: ") + std::strerror(errno), "");
    const std::int64_t now_ns = nanoseconds_since(start);
    if (count == 0) {
      lines.finish(now_ns, take);
      break;
    }
    lines.push(std::string_view(buffer).substr(0, static_cast<std::size_t>(count)), now_ns, take);
  }
  std::vector<RecordingNote> rest;
  note_frames(rest, lines.malformed() - noted);
  if (!rest.empty()) out.put(std::move(rest));
  LiveCounts counts;
  counts.frames = frames;
  counts.malformed = lines.malformed();
  return counts;
}

namespace {

/// One recording of states.
class StateRecording {
 public:
  StateRecording(std::span<const LiveSource> sources, RecordingThread& out, const LiveSettings& settings)
      : sources_(sources),
        scene_(states_of(sources)),
        out_(out),
        settings_(settings),
        frames_(settings.duration_s ? std::max(1.0, std::round(*settings.duration_s * settings.rate_hz)) : INFINITY) {
    for (const LiveSource& source : sources) places_.push_back(reading_from(source.datagrams.descriptor()));
  }

  LiveCounts run() {
    await_beginning();
    while (begun_ && static_cast<double>(index_) < frames_ && !must_stop(out_, settings_)) {
      const std::int64_t left_ns = time_of(index_) - nanoseconds_since(start_);
      if (left_ns > 0) {
        if (await(places_, std::chrono::nanoseconds(left_ns))) receive();
        continue;
      }
      receive();  // everything received until now belongs to this frame
      skip_missed();
      if (static_cast<double>(index_) < frames_) make_frame();
    }
    std::vector<RecordingNote> rest = notes();
    if (!rest.empty()) out_.put(std::move(rest));
    return counts();
  }

 private:
  /// The losses already noted in the trace.
  struct Noted {
    std::uint64_t late = 0;
    std::uint64_t input = 0;
  };

  void await_beginning() {
    while (!begun_ && !must_stop(out_, settings_))
      if (await(places_, kLongestWait)) receive();
    start_ = Clock::now();
  }

  /// Takes a limited number of datagrams, from all sources in turn. In a flood there is always another one, but frames
  /// and stop requests must have their turn.
  void receive() {
    const Clock::time_point until = Clock::now() + kLongestTurn;
    bool any = true;
    for (int count = 0; any && count < kMostInATurn && Clock::now() < until; ++count) {
      any = false;
      for (const LiveSource& source : sources_) {
        const auto datagram = source.datagrams.next();
        if (!datagram) continue;
        any = true;
        begun_ = source.state.take(*datagram) || begun_;
      }
    }
  }

  std::int64_t time_of(std::uint64_t index) const {
    return std::llround(static_cast<double>(index) / settings_.rate_hz * kNanosecondsPerSecond);
  }

  /// Skips frames that can no longer be made, because the state has changed since their time.
  void skip_missed() {
    const double late_s = static_cast<double>(nanoseconds_since(start_)) / kNanosecondsPerSecond - kMostLate_s;
    const double first = std::max(0.0, std::ceil(late_s * settings_.rate_hz));
    const auto current = static_cast<std::uint64_t>(std::min(frames_, first));
    if (current <= index_) return;
    late_ += current - index_;
    index_ = current;
  }

  void make_frame() {
    TraceFrame frame;
    frame.index = index_;
    frame.time_ns = time_of(index_);
    const std::vector<std::vector<std::uint32_t>> teleported = scene_.show(frame);
    if (settings_.complete) settings_.complete(frame);
    const Noted before = noted_;
    ++index_;
    if (out_.put(std::move(frame), notes(), WhenBehind::kDrop)) {
      for (const LiveSource& source : sources_) source.state.forget_markers();
      ++made_;
      return;
    }
    // The frame was not taken, so the next frame must carry its notes.
    for (std::size_t i = 0; i < sources_.size(); ++i) sources_[i].state.mark_teleported(teleported[i]);
    noted_ = before;
    ++late_;
  }

  /// Returns the losses since the last notes, and the markers.
  std::vector<RecordingNote> notes() {
    std::vector<RecordingNote> notes;
    Noted now = {.late = late_};
    for (const LiveSource& source : sources_) {
      notes.insert(notes.end(), source.state.vmc().markers().begin(), source.state.vmc().markers().end());
      now.input += source.state.vmc().malformed() + source.datagrams.overflowed();
    }
    note_frames(notes, now.late - noted_.late);
    note(notes, kInput, now.input - noted_.input);
    noted_ = now;
    return notes;
  }

  LiveCounts counts() const {
    LiveCounts counts;
    counts.frames = made_;
    counts.late = late_;
    counts.ids_clash = scene_.ids_clash();
    for (const LiveSource& source : sources_) {
      counts.malformed += source.state.vmc().malformed();
      counts.overflowed += source.datagrams.overflowed();
    }
    return counts;
  }

  static std::vector<LiveState*> states_of(std::span<const LiveSource> sources) {
    std::vector<LiveState*> states;
    states.reserve(sources.size());
    for (const LiveSource& source : sources) states.push_back(&source.state);
    return states;
  }

  std::span<const LiveSource> sources_;
  LiveScene scene_;
  std::vector<pollfd> places_;
  RecordingThread& out_;
  const LiveSettings& settings_;
  double frames_;  ///< may be infinite
  Clock::time_point start_;
  bool begun_ = false;
  std::uint64_t index_ = 0;
  std::uint64_t made_ = 0;
  std::uint64_t late_ = 0;
  Noted noted_;
};

}  // namespace

LiveCounts record_states(std::span<const LiveSource> sources, RecordingThread& out, const LiveSettings& settings) {
  return StateRecording(sources, out, settings).run();
}

}  // namespace vestige
