#include "analysis/live/datagram_input.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <glm/geometric.hpp>
#include <glm/mat4x4.hpp>
#include <utility>

#include "analysis/base/clocks.hpp"

namespace vestige {

namespace {

using namespace std::chrono_literals;

constexpr int kMostInATurn = 1000;  ///< datagrams of each port

/// A pose that comes later after the one before, or whose root is farther away, is no motion of a body.
constexpr auto kLongestWay = 200ms;
constexpr double kFarthestWay_m = 1;

/// How long the others wait before it is said for whom.
constexpr auto kPatience = 1s;

glm::dvec3 root_of(const Avatar& avatar, const Pose& pose) {
  std::vector<glm::dmat4> world;
  world_matrices(avatar, pose, world);
  return pose.origin_m + glm::dvec3(world[static_cast<std::size_t>(avatar.root_node)][3]);
}

}  // namespace

DatagramInput::Source::Source(const LivePort& port, LiveState::Senders senders)
    : name(port.name),
      avatar(port.avatar),
      datagrams(port.place, port.name),
      state(port.avatar, glm::dvec3(0), Stance(), senders) {}

std::vector<LiveState*> DatagramInput::states_of(std::deque<Source>& sources) {
  std::vector<LiveState*> states;
  states.reserve(sources.size());
  for (Source& source : sources) states.push_back(&source.state);
  return states;
}

std::deque<DatagramInput::Source> DatagramInput::sources_of(std::span<const LivePort> ports) {
  std::deque<Source> sources;  // in place, since they cannot be moved
  for (const LivePort& port : ports) sources.emplace_back(port, LiveState::Senders::kOneAtATime);
  return sources;
}

DatagramInput::DatagramInput(std::span<const LivePort> ports, PoseShown poses, std::chrono::milliseconds ttl)
    : poses_(poses), ttl_(ttl), sources_(sources_of(ports)), scene_(states_of(sources_)) {}

std::vector<int> DatagramInput::descriptors() const {
  std::vector<int> descriptors;
  descriptors.reserve(sources_.size());
  for (const Source& source : sources_) descriptors.push_back(source.datagrams.descriptor());
  return descriptors;
}

void DatagramInput::receive() {
  const Clock::time_point until = Clock::now() + kLongestTurn;
  bool any = true;
  for (int count = 0; any && count < kMostInATurn && Clock::now() < until; ++count) {
    any = false;
    for (Source& source : sources_) {
      const auto datagram = source.datagrams.next();
      if (!datagram) continue;
      any = true;
      source.state.take(*datagram);
    }
  }
  if (!missing_told_) look_for_missing();
}

/// Says who is waited for, once the others have waited for a while.
void DatagramInput::look_for_missing() {
  if (frames() == 0 || has_begun()) return;
  if (!others_wait_since_) others_wait_since_ = Clock::now();
  if (Clock::now() < *others_wait_since_ + kPatience) return;
  missing_told_ = true;
  for (const Source& source : sources_)
    if (source.state.frames() == 0)
      problems_.push_back(fmt::format(
          "{}: no whole frame has come to this port yet; nobody feels anything before one comes to each port",
          source.name));
}

std::uint64_t DatagramInput::frames() const {
  std::uint64_t frames = 0;
  for (const Source& source : sources_) frames += source.state.frames();
  return frames;
}

bool DatagramInput::has_begun() const {
  return std::ranges::all_of(sources_, [](const Source& source) { return source.state.frames() > 0; });
}

LiveInput::Clock::time_point DatagramInput::arrived() const {
  Clock::time_point newest = sources_.front().state.arrived();
  for (const Source& source : sources_) newest = std::max(newest, source.state.arrived());
  return newest;
}

void DatagramInput::show(Clock::time_point time, LiveFrame& out) {
  out.arrived = arrived();
  out.begins = false;
  out.pose_delay_s = 0;
  count_superseded();
  out.is_silent.clear();
  for (Source& source : sources_) {
    look_for_silence(source, time);
    out.is_silent.push_back(source.is_silent);
  }
  scene_.show(out.frame);
  for (std::size_t i = 0; i < sources_.size(); ++i) lead(sources_[i], out.frame.poses[i], time, out);
  out.decoded = Clock::now();
}

void DatagramInput::count_superseded() {
  // Those who came first waited for the others.
  const bool counts = has_shown_ || sources_.size() == 1;
  has_shown_ = true;
  for (Source& source : sources_) {
    const std::uint64_t frames = source.state.frames();
    if (counts && frames > source.frames_shown) superseded_ += frames - source.frames_shown - 1;
    source.frames_shown = frames;
  }
}

void DatagramInput::look_for_silence(Source& source, Clock::time_point time) {
  LiveState& state = source.state;
  const bool was_silent = std::exchange(source.is_silent, sources_.size() > 1 && state.arrived() + ttl_ < time);
  if (source.is_silent && !was_silent) {
    state.remove_colliders();
    problems_.push_back(fmt::format(
        "{}: no whole frame came for {} ms: this person's actuators are off, and the colliders that came to "
        "this port are gone, until one comes",
        source.name, ttl_.count()));
  }
  if (state.remove_colliders_silent_since(time - ttl_))
    problems_.push_back(fmt::format("{}: the program that sends colliders has been silent for {} ms: they are gone",
                                    source.name, ttl_.count()));
}

/// Puts the pose of a time in the place of the newest one.
void DatagramInput::lead(Source& source, Pose& pose, Clock::time_point time, LiveFrame& out) const {
  LiveState& state = source.state;
  const bool begins = state.take_beginning();
  if (state.poses() != source.poses_shown) {
    const Clock::duration since_last = state.pose_arrived() - source.pose_arrived;
    const glm::dvec3 root_m = root_of(source.avatar, pose);
    const bool jumps = begins || source.poses_shown == 0 || since_last > kLongestWay ||
                       !(glm::distance(root_m, source.root_m) <= kFarthestWay_m);
    source.is_led = poses_ == PoseShown::kInterpolate && !jumps && (source.is_led || source.came_between);
    source.came_between = false;
    source.ramp.lead_to(pose, state.pose_arrived(), source.is_led ? since_last : Clock::duration(0));
    source.poses_shown = state.poses();
    source.pose_arrived = state.pose_arrived();
    source.root_m = root_m;
    out.begins = out.begins || jumps;
  } else {
    source.came_between = true;
  }
  out.begins = out.begins || begins;
  if (source.poses_shown == 0) return;  // the rest pose
  pose = source.ramp.at(time);
  out.pose_delay_s = std::max(out.pose_delay_s, seconds(source.ramp.delay_at(time)));
}

std::vector<RecordingNote> DatagramInput::take_markers() {
  std::vector<RecordingNote> notes;
  for (Source& source : sources_) {
    const std::vector<RecordingNote>& markers = source.state.vmc().markers();
    notes.insert(notes.end(), markers.begin(), markers.end());
    source.state.forget_markers();
  }
  return notes;
}

std::vector<std::string> DatagramInput::take_problems() {
  std::vector<std::string> told = std::exchange(problems_, {});
  for (Source& source : sources_) {
    const std::vector<std::string>& problems = source.state.vmc().problems();
    for (; source.problems_told < problems.size(); ++source.problems_told)
      told.push_back(fmt::format("{}: {}", source.name, problems[source.problems_told]));
    if (!source.state.stranger() || source.stranger_told) continue;
    source.stranger_told = true;
    told.push_back(
        fmt::format("{}: a second program, {}, sends to this port, and is left out until the first one has been silent "
                    "for a second\n  Give each person's sender a port of its own.",
                    source.name, to_string(*source.state.stranger())));
  }
  if (scene_.ids_clash() && !clash_told_) {
    clash_told_ = true;
    told.emplace_back(
        "colliders of one id came to several ports; only those of the port that had it first count\n  Give each sender "
        "ids of its own.");
  }
  return told;
}

LiveLosses DatagramInput::losses() const {
  LiveLosses losses;
  for (const Source& source : sources_) {
    losses.malformed += source.state.vmc().malformed();
    losses.overflowed += source.datagrams.overflowed();
    losses.strangers += source.state.left_out();
  }
  losses.ids_clash = scene_.ids_clash();
  return losses;
}

}  // namespace vestige
