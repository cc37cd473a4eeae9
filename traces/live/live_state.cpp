#include "traces/live/live_state.hpp"

#include <algorithm>
#include <utility>

namespace vestige {

namespace {

/// A sender that has been silent for so long may be followed by another one.
constexpr std::chrono::seconds kSilence(1);
/// A pose of which nothing came for so long is at its end.
constexpr std::chrono::milliseconds kLongestPause(10);

}  // namespace

LiveState::LiveState(const Avatar& avatar, const glm::dvec3& origin_m, const Stance& stance, Senders senders)
    : state_(avatar, origin_m, stance), senders_(senders) {
  state_.show(kept_);
}

bool LiveState::Speaker::admits(const Datagram& datagram, bool says_something) {
  if (address && datagram.arrived - heard > kSilence) address.reset();
  if (address && *address != datagram.sender) return false;
  if (!says_something) return true;
  address = datagram.sender;
  heard = datagram.arrived;
  return true;
}

bool LiveState::admits(const VmcContent& content, const Datagram& datagram) {
  if (senders_ == Senders::kAny) return true;
  // Whoever says that there is no frame yet may only be asking whether somebody listens.
  const bool tells_pose = content.pose || content.tells_end;
  const bool admitted = (!tells_pose || of_pose_.admits(datagram, content.pose || content.ends)) &&
                        (!content.vestige || of_colliders_.admits(datagram, true));
  if (!admitted) {
    ++left_out_;
    if (!stranger_) stranger_ = datagram.sender;
  }
  return admitted;
}

bool LiveState::completes(const VmcContent& content) const {
  return content.ends || !tells_end_ || (!content.pose && !is_told_in_part_);
}

void LiveState::begin_part(const VmcContent& content, Clock::time_point arrived) {
  if (!is_told_in_part_) {
    state_.show(kept_);
    mark_teleported(kept_.teleported);
  }
  is_told_in_part_ = true;
  if (content.pose) part_told_ = arrived;
}

bool LiveState::take(const Datagram& datagram) {
  const std::uint64_t frames_before = frames_;
  bool whole = false;
  bool ends = false;
  const bool changed = state_.take(datagram.bytes, [&](const VmcContent& content) {
    if (!admits(content, datagram)) return false;
    if (is_told_in_part_ && datagram.arrived - part_told_ > kLongestPause) note_whole(part_told_);
    if (content.tells_end && !std::exchange(tells_end_, true)) begins_ = true;
    ends = content.ends;
    whole = completes(content);
    if (!whole) begin_part(content, datagram.arrived);
    has_new_pose_ = has_new_pose_ || content.pose;
    return true;
  });
  if (whole && (changed || ends)) note_whole(datagram.arrived);
  return frames_ != frames_before;
}

void LiveState::note_whole(Clock::time_point arrived) {
  is_told_in_part_ = false;
  ++frames_;
  arrived_ = std::max(arrived_, arrived);
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
