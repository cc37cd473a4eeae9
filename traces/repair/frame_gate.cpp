#include "traces/repair/frame_gate.hpp"

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>
#include <limits>
#include <set>
#include <utility>

#include "traces/scene/people.hpp"

namespace vestige {

using mcap::Malformed;
using mcap::Trust;
using trace_format::Stream;

namespace {

constexpr std::size_t kMostWaitingBytes = std::size_t{16} << 20;
constexpr auto kLatest_ns = static_cast<std::uint64_t>(std::numeric_limits<std::int64_t>::max());

// Unverified messages with values beyond these limits are rejected.
constexpr float kLargestScale = 1e6F;
constexpr float kRotationTolerance = 0.1F;
constexpr std::uint64_t kShortestFrame_ns = 1000;
constexpr std::size_t kLookedBack = 64;  ///< most consecutive wrong frames that do not end a sequence

bool is_near(const glm::dvec3& position_m) {
  return glm::all(glm::lessThanEqual(glm::abs(position_m), glm::dvec3(trace_format::kFarthest_m)));  // false for NaN
}

bool is_plausible_node(const NodeLocal& node) {
  return is_near(node.translation) && glm::all(glm::lessThanEqual(glm::abs(node.scale), glm::vec3(kLargestScale))) &&
         std::abs(glm::dot(node.rotation, node.rotation) - 1) <= kRotationTolerance;
}

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
  held.person = streams_.person_of(message.channel_id);
  held.data.assign(message.data.begin(), message.data.end());
  group_.bytes += held.data.size() + sizeof held;
  if (group_.bytes > kMostWaitingBytes) end_group();
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
        return held.message.log_time <= kLatest_ns && has_nodes(held.person, nodes);
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

bool FrameGate::has_nodes(std::size_t person, std::size_t nodes) const {
  const auto expected = node_counts_.find(person);
  return expected == node_counts_.end() || nodes == expected->second;
}

/// Whether each collider of the message that was decoded last has the owner that it had before.
bool FrameGate::keeps_owners() {
  if (streams_.knows_one_person()) return true;
  const auto contradicts = [&](const ColliderSample& collider) {
    const auto known = owners_.find(collider.id);
    return known != owners_.end() && known->second != collider.owner;
  };
  if (std::ranges::any_of(colliders_, contradicts)) return false;
  for (const ColliderSample& collider : colliders_) {
    if (owners_.size() >= kMostColliders) break;  // readers refuse so many colliders
    owners_.emplace(collider.id, collider.owner);
  }
  return true;
}

/// Whether a recorder could have written a readable message.
bool FrameGate::is_plausible(const Held& held) {
  const auto time_ns = static_cast<std::int64_t>(held.message.log_time);
  if (held.stream == Stream::kPose) {
    decoder_.pose(held.data, pose_);
    return decoder_.pose_time_ns(held.data) == time_ns && is_near(pose_.origin_m) &&
           std::all_of(pose_.nodes.begin(), pose_.nodes.end(), is_plausible_node);
  }
  if (held.stream == Stream::kColliders) {
    decoder_.colliders(held.data, colliders_);
    return decoder_.colliders_time_ns(held.data) == time_ns &&
           std::all_of(colliders_.begin(), colliders_.end(), [](const ColliderSample& collider) {
             return is_near(collider.position_m) && collider.owner <= trace_format::kMostPeople;
           });
  }
  return true;
}

bool FrameGate::clean(Group& group) {
  std::set<std::size_t> poses;  // of these people
  std::size_t colliders = 0;
  std::uint64_t colliders_time_ns = 0;
  bool readable = true;
  std::erase_if(group.messages, [&](const Held& held) {
    const bool is_good = is_readable(held) && (group.trust == Trust::kVerified || is_plausible(held)) &&
                         (held.stream != Stream::kColliders || keeps_owners());
    const bool is_pose = held.stream == Stream::kPose;
    const bool is_other_time = is_pose && !poses.empty() && held.message.log_time != group.time_ns;
    const bool keep = is_good && !(is_pose && poses.contains(held.person)) && !is_other_time &&
                      !(held.stream == Stream::kColliders && colliders > 0);
    if (keep && is_pose) {
      poses.insert(held.person);
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
  // A frame with two poses of a person, or without colliders, counts as whole if one good message of each kind present
  // is left.
  const bool agrees = group.trust == Trust::kVerified || (colliders == 1 && colliders_time_ns == group.time_ns);
  const bool good = !poses.empty() && agrees && (readable || colliders == 1);
  if (!good) leave_out_frame(group);
  return good;
}

void FrameGate::leave_out_frame(Group& group) {
  left_out_ += std::erase_if(group.messages, [](const Held& held) { return is_frame_part(held.stream); });
  group.has_frame = false;
}

std::vector<bool> FrameGate::longest_sequence(const Group* next) const {
  const auto can_follow = [](std::uint32_t sequence, std::uint64_t time_ns, const Group& after) {
    return after.sequence > sequence && after.time_ns >= time_ns &&
           after.sequence - sequence - 1 <= (after.time_ns - time_ns) / kShortestFrame_ns;
  };
  std::vector<std::size_t> length(waiting_.size(), 0);
  std::vector<std::size_t> before(waiting_.size());
  std::size_t last = 0;
  for (std::size_t i = 0; i < waiting_.size(); ++i) {
    const Group& group = waiting_[i];
    before[i] = i;
    const bool precedes = next == nullptr || (group.sequence < next->sequence && group.time_ns <= next->time_ns);
    if (!group.has_frame || !precedes) continue;
    if (!last_sequence_ || can_follow(*last_sequence_, last_time_ns_, group)) length[i] = 1;
    for (std::size_t j = i - std::min(i, kLookedBack); j < i; ++j) {
      if (length[j] < std::max<std::size_t>(length[i], 1)) continue;
      if (!can_follow(waiting_[j].sequence, waiting_[j].time_ns, group)) continue;
      length[i] = length[j] + 1;
      before[i] = j;
    }
    if (length[i] > length[last]) last = i;
  }
  std::vector<bool> chosen(waiting_.size(), false);
  if (chosen.empty() || length[last] == 0) return chosen;
  chosen[last] = true;
  for (std::size_t i = last; before[i] != i; i = before[i]) chosen[before[i]] = true;
  return chosen;
}

void FrameGate::release(const Group* next) {
  const std::vector<bool> chosen = longest_sequence(next);
  for (std::size_t i = 0; i < waiting_.size(); ++i) {
    if (waiting_[i].has_frame && !chosen[i]) leave_out_frame(waiting_[i]);
    write(waiting_[i]);
  }
  waiting_.clear();
  waiting_bytes_ = 0;
}

void FrameGate::write(Group& group) {
  // A definition that came after a waiting message does not change the stream that the message was assigned to.
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
