#include "traces/live/live_state.hpp"

#include <algorithm>
#include <utility>

namespace vestige {

namespace {

/// A sender that has been silent for so long may be followed by another one.
constexpr std::chrono::seconds kSilence(1);
/// A pose that is told for longer has lost its end.
constexpr std::chrono::milliseconds kLongestTelling(100);

}  // namespace

LiveState::LiveState(const Avatar& avatar, const glm::dvec3& origin_m, const Stance& stance, Senders senders)
    : state_(avatar, origin_m, stance), senders_(senders) {
  state_.show(kept_);
}

bool LiveState::Speaker::admits(const Datagram& datagram) {
  if (!address || datagram.arrived - heard > kSilence) address = datagram.sender;
  if (*address != datagram.sender) return false;
  heard = datagram.arrived;
  return true;
}

bool LiveState::admits(const VmcContent& content, const Datagram& datagram) {
  if (senders_ == Senders::kAny) return true;
  const bool admitted =
      (!content.vmc || of_pose_.admits(datagram)) && (!content.vestige || of_colliders_.admits(datagram));
  if (!admitted) {
    ++left_out_;
    if (!stranger_) stranger_ = datagram.sender;
  }
  return admitted;
}

bool LiveState::completes(const VmcContent& content, Clock::time_point arrived) {
  if (content.ends || !tells_end_) return true;
  if (is_told_in_part_) return arrived - part_began_ > kLongestTelling;
  return !content.pose;
}

void LiveState::keep() {
  if (is_told_in_part_) return;
  state_.show(kept_);
  mark_teleported(kept_.teleported);
}

bool LiveState::take(const Datagram& datagram) {
  bool whole = false;
  bool ends = false;
  const bool changed = state_.take(datagram.bytes, [&](const VmcContent& content) {
    if (!admits(content, datagram)) return false;
    if (content.tells_end && !std::exchange(tells_end_, true)) begins_ = true;
    ends = content.ends;
    whole = completes(content, datagram.arrived);
    if (!whole) {
      keep();
      if (!std::exchange(is_told_in_part_, true)) part_began_ = datagram.arrived;
    }
    has_new_pose_ = has_new_pose_ || content.pose;
    return true;
  });
  if (!whole || (!changed && !ends)) return false;
  note_whole(datagram.arrived);
  return true;
}

void LiveState::note_whole(Clock::time_point arrived) {
  is_told_in_part_ = false;
  ++frames_;
  arrived_ = arrived;
  if (!std::exchange(has_new_pose_, false)) return;
  ++poses_;
  pose_arrived_ = arrived;
  came_between_ = frames_ - frames_at_pose_ > 1;
  frames_at_pose_ = frames_;
  if (poses_ == 1) begins_ = true;
}

void LiveState::show(TraceFrame& frame) {
  if (is_told_in_part_) {
    frame.poses.front() = kept_.poses.front();
    frame.colliders = kept_.colliders;
    frame.teleported.clear();
  } else {
    state_.show(frame);
  }
  const std::vector<std::uint32_t> shown_now = std::exchange(frame.teleported, std::exchange(teleported_, {}));
  for (const std::uint32_t id : shown_now)
    if (std::ranges::find(frame.teleported, id) == frame.teleported.end()) frame.teleported.push_back(id);
}

void LiveState::mark_teleported(std::span<const std::uint32_t> ids) {
  for (const std::uint32_t id : ids)
    if (std::ranges::find(teleported_, id) == teleported_.end()) teleported_.push_back(id);
}

bool LiveState::take_beginning() {
  return std::exchange(begins_, false);
}

}  // namespace vestige
