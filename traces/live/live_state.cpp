#include "traces/live/live_state.hpp"

#include <algorithm>
#include <utility>

namespace vestige {

namespace {

/// A sender that has been silent for so long may be followed by another one.
constexpr std::chrono::seconds kSilence(1);
/// A pose of which nothing came for so long is at its end.
constexpr std::chrono::milliseconds kLongestPause(10);
/// A sender that has not ended a frame for so long does not say where frames end.
constexpr std::chrono::milliseconds kLongestPart(100);

}  // namespace

LiveState::LiveState(const Avatar& avatar, const glm::dvec3& origin_m, const Stance& stance, Senders senders)
    : state_(avatar, origin_m, stance), senders_(senders) {
  state_.show(kept_);
}

bool LiveState::Speaker::admits(const Datagram& datagram) const {
  return !address || *address == datagram.sender || datagram.arrived - heard > kSilence;
}

void LiveState::Speaker::hear(const Datagram& datagram) {
  address = datagram.sender;
  heard = datagram.arrived;
}

bool LiveState::admits(const VmcContent& content, const Datagram& datagram) {
  if (senders_ == Senders::kAny) return true;
  const bool tells_pose = content.pose || content.ends;
  if ((tells_pose && !of_pose_.admits(datagram)) || (content.colliders && !of_colliders_.admits(datagram))) {
    ++left_out_;
    if (!stranger_) stranger_ = datagram.sender;
    return false;
  }
  if (tells_pose) {
    if (of_pose_.address && *of_pose_.address != datagram.sender) ends_ = Ends::kUnknown;
    of_pose_.hear(datagram);
  }
  if (content.colliders) of_colliders_.hear(datagram);
  return true;
}

bool LiveState::remove_colliders_silent_since(Clock::time_point time) {
  if (!of_colliders_.address || of_colliders_.address == of_pose_.address || of_colliders_.heard > time) return false;
  remove_colliders();
  return true;
}

void LiveState::remove_colliders() {
  of_colliders_.address.reset();
  state_.remove_colliders();
  kept_.colliders.clear();
}

bool LiveState::completes(const VmcContent& content) const {
  return content.ends || ends_ == Ends::kNeverTold || (!content.pose && !is_told_in_part_);
}

void LiveState::begin_part(const VmcContent& content, Clock::time_point arrived) {
  if (!is_told_in_part_) {
    state_.show(kept_);
    mark_teleported(kept_.teleported);
    part_begun_ = arrived;
  }
  is_told_in_part_ = true;
  if (content.pose) part_told_ = arrived;
}

void LiveState::end_old_part(Clock::time_point now) {
  if (!is_told_in_part_) return;
  const bool pauses = now - part_told_ > kLongestPause;
  if (now - part_begun_ > kLongestPart || (pauses && ends_ == Ends::kUnknown)) ends_ = Ends::kNeverTold;
  if (pauses) note_whole(part_told_);
}

bool LiveState::take(const Datagram& datagram) {
  const std::uint64_t frames_before = frames_;
  bool whole = false;
  bool ends = false;
  const bool changed = state_.take(datagram.bytes, [&](const VmcContent& content) {
    if (!admits(content, datagram)) return false;
    end_old_part(datagram.arrived);
    if (content.ends && std::exchange(ends_, Ends::kTold) == Ends::kNeverTold) begins_ = true;
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
  pose_arrived_ = std::max(pose_arrived_, arrived);
  if (poses_ == 1) begins_ = true;
}

void LiveState::show(TraceFrame& frame) {
  if (is_told_in_part_) {
    frame.poses.front() = kept_.poses.front();
    frame.colliders = kept_.colliders;
    frame.teleported.clear();
  } else {
    state_.show(frame);
    state_.forget_removed();
  }
  teleported_.insert(frame.teleported.begin(), frame.teleported.end());
  frame.teleported.assign(teleported_.begin(), teleported_.end());
  teleported_.clear();
}

void LiveState::mark_teleported(std::span<const std::uint32_t> ids) {
  teleported_.insert(ids.begin(), ids.end());
}

bool LiveState::take_beginning() {
  return std::exchange(begins_, false);
}

}  // namespace vestige
