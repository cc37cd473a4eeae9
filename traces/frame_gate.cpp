#include "traces/frame_gate.hpp"

#include <algorithm>
#include <limits>
#include <utility>

namespace vestige {

using mcap::Malformed;
using mcap::Trust;
using trace_format::Stream;

namespace {

constexpr std::size_t kMostWaitingBytes = std::size_t{16} << 20;
constexpr auto kLatest_ns = static_cast<std::uint64_t>(std::numeric_limits<std::int64_t>::max());

bool is_frame_part(Stream stream) {
  return stream == Stream::kPose || stream == Stream::kColliders;
}

}  // namespace

void FrameGate::take(const mcap::Message& message, Trust trust) {
  const Stream stream = streams_.stream_of(message.channel_id);
  if (stream == Stream::kForeign && group_.messages.empty() && waiting_.empty()) {
    if (trust == Trust::kUnverified) ++unverified_;
    write_(message);
    return;
  }
  const bool other_frame = stream != Stream::kForeign && message.sequence != group_.sequence;
  if (!group_.messages.empty() && (other_frame || trust != group_.trust)) end_group();
  if (group_.messages.empty()) {
    group_.sequence = message.sequence;
    group_.trust = trust;
  }
  if (is_frame_part(stream)) group_.has_frame = true;
  Held& held = group_.messages.emplace_back();
  held.message = message;
  held.stream = stream;
  held.data.assign(message.data.begin(), message.data.end());
  group_.bytes += held.data.size() + sizeof held;
}

void FrameGate::finish() {
  end_group();
  release(nullptr);
}

void FrameGate::end_group() {
  Group group = std::exchange(group_, {});
  if (group.messages.empty()) return;
  const bool good_frame = clean(group);
  const bool follows = !last_sequence_ || (group.sequence > *last_sequence_ && group.time_ns >= last_time_ns_);
  const bool verified = group.trust == Trust::kVerified;
  if (verified && good_frame && !follows) leave_out_frame(group);
  if (verified && group.has_frame) {
    release(&group);
    write(group);
  } else if (verified && waiting_.empty()) {
    write(group);
  } else {
    waiting_bytes_ += group.bytes;
    waiting_.push_back(std::move(group));
    if (waiting_bytes_ > kMostWaitingBytes) release(nullptr);
  }
}

bool FrameGate::is_readable(const Held& held) {
  try {
    switch (held.stream) {
      case Stream::kPose: {
        const std::size_t nodes = decoder_.pose_node_count(held.data);
        return held.message.log_time <= kLatest_ns && (!node_count_ || nodes == *node_count_);
      }
      case Stream::kColliders:
        decoder_.colliders(held.data, colliders_);
        return true;
      case Stream::kEvents:
        decoder_.event(held.data);
        return true;
      case Stream::kForeign:
        return true;
    }
  } catch (const Malformed&) {
    return false;
  }
  return true;
}

bool FrameGate::clean(Group& group) {
  std::size_t poses = 0;
  std::size_t colliders = 0;
  std::uint64_t colliders_time_ns = 0;
  bool readable = true;
  std::erase_if(group.messages, [&](const Held& held) {
    const bool keep = is_readable(held) && !(held.stream == Stream::kPose && poses > 0) &&
                      !(held.stream == Stream::kColliders && colliders > 0);
    if (keep && held.stream == Stream::kPose) {
      ++poses;
      group.time_ns = held.message.log_time;
    }
    if (keep && held.stream == Stream::kColliders) {
      ++colliders;
      colliders_time_ns = held.message.log_time;
    }
    if (!keep) {
      ++left_out_;
      if (is_frame_part(held.stream)) readable = false;
    }
    return !keep;
  });
  if (!group.has_frame) return false;
  // A frame with two poses, or one pose and no colliders, is whole as long as one of each that there are is good.
  const bool agrees = group.trust == Trust::kVerified || (colliders == 1 && colliders_time_ns == group.time_ns);
  const bool good = poses == 1 && agrees && (readable || colliders == 1);
  if (!good) leave_out_frame(group);
  return good;
}

void FrameGate::leave_out_frame(Group& group) {
  left_out_ += std::erase_if(group.messages, [](const Held& held) { return is_frame_part(held.stream); });
  group.has_frame = false;
}

void FrameGate::release(const Group* next) {
  for (Group& group : waiting_) {
    const bool after_last = !last_sequence_ || (group.sequence > *last_sequence_ && group.time_ns >= last_time_ns_);
    const bool before_next = next == nullptr || (group.sequence < next->sequence && group.time_ns <= next->time_ns);
    if (group.has_frame && !(after_last && before_next)) leave_out_frame(group);
    write(group);
  }
  waiting_.clear();
  waiting_bytes_ = 0;
}

void FrameGate::write(Group& group) {
  // A definition behind a message that has waited does not change what the message was taken for.
  left_out_ += std::erase_if(
      group.messages, [&](const Held& held) { return streams_.stream_of(held.message.channel_id) != held.stream; });
  if (group.trust == Trust::kUnverified) unverified_ += group.messages.size();
  for (const Held& held : group.messages) {
    mcap::Message message = held.message;
    message.data = held.data;
    write_(message);
  }
  if (!group.has_frame) return;
  last_sequence_ = group.sequence;
  last_time_ns_ = group.time_ns;
}

}  // namespace vestige
