#include "transport/vmc/vmc_sender.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <thread>
#include <utility>

#include "transport/actuator_sink.hpp"
#include "transport/sinks/osc_message.hpp"

namespace vestige {

namespace {

bool is_finite(const Pose& pose) {
  const auto all = [](const auto&... values) { return (std::isfinite(values) && ...); };
  return all(pose.origin_m.x, pose.origin_m.y, pose.origin_m.z) &&
         std::ranges::all_of(pose.nodes, [&](const NodeLocal& node) {
           const auto& [t, r, s] = node;
           return all(t.x, t.y, t.z, r.x, r.y, r.z, r.w, s.x, s.y, s.z);
         });
}

}  // namespace

VmcStatistics& VmcStatistics::operator+=(const VmcStatistics& other) {
  sent += other.sent;
  unsent += other.unsent;
  links_lost += other.links_lost;
  poses_left_out += other.poses_left_out;
  if (other.deviation.most_m > deviation.most_m) deviation = other.deviation;
  written += other.written;
  return *this;
}

VmcSender::VmcSender(const HostPort& place, const PlayedPerson& person,
                     std::optional<std::span<const std::uint32_t>> collider_ids,
                     std::function<void(const std::string&)> tell)
    : person_(person),
      tell_(std::move(tell)),
      skeleton_(vmc_skeleton(person.avatar, person.name)),
      receiver_(person.avatar, glm::dvec3(0)),
      difference_(person.avatar),
      out_(place, host_port_url("vmc", place)) {
  if (collider_ids) colliders_.emplace(*collider_ids);
}

bool VmcSender::is_refused() {
  const OscBytes probe = not_ready_message();
  return out_.is_refused({&probe, 1});
}

void VmcSender::send(const TraceFrame& frame, double time_s, Clock::time_point due) {
  std::vector<OscBytes> messages;
  append_pose(frame, messages);
  if (colliders_) {
    const auto tell = [this](const std::string& text) { tell_(person_.name + ": " + text); };
    colliders_->append(frame, follows_ ? ColliderTeller::Path::kMotion : ColliderTeller::Path::kTeleports, tell,
                       messages);
  }
  for (OscBytes& message : end_of_frame(time_s)) messages.push_back(std::move(message));
  follows_ = send_messages(messages);
  if (!follows_) {
    ++statistics_.unsent;
    return;
  }
  ++statistics_.sent;
  statistics_.written.add(std::chrono::duration<double>(Clock::now() - due).count());
}

void VmcSender::append_pose(const TraceFrame& frame, std::vector<OscBytes>& out) {
  const Pose& pose = frame.poses[person_.person];
  if (pose.nodes.empty()) return;
  const auto leave_out = [&] {
    if (statistics_.poses_left_out++ == 0)
      tell_(
          fmt::format("{}: the pose of frame {} is not finite, or beyond what a receiver takes; such poses are left "
                      "out",
                      person_.name, frame.index));
  };
  if (!is_finite(pose)) {
    leave_out();
    return;
  }
  std::vector<OscBytes> messages = pose_messages(skeleton_, person_.avatar, pose);
  const std::uint64_t refused = receiver_.malformed();
  for (const OscBytes& message : messages) receiver_.take(message);
  if (receiver_.malformed() != refused) {
    leave_out();
    return;
  }
  note_deviation(frame, pose);
  std::ranges::move(messages, std::back_inserter(out));
}

void VmcSender::note_deviation(const TraceFrame& frame, const Pose& pose) {
  TraceFrame shown;
  receiver_.show(shown);
  const SkinDifference::Bound bound = difference_.between(pose, shown.poses.front());
  SkinDifference::Bound& most = statistics_.deviation;
  if (bound.most_m > kToldDeviation_m && most.most_m <= kToldDeviation_m)
    tell_(
        fmt::format("{}: VMC cannot say the whole pose: in frame {}, the skin that is sent lies up to {:.1f} mm from "
                    "the trace's, at joint '{}'\n  VMC says rotations of a human body's bones, and where root and hips "
                    "are, in single precision. It moves no other joint, and scales none.",
                    person_.name, frame.index, bound.most_m * 1e3, person_.avatar.nodes[bound.node].name));
  if (bound.most_m > most.most_m) most = bound;
}

bool VmcSender::send_messages(std::span<const OscBytes> messages) {
  try {
    for (const OscBytes& datagram : pack_osc(messages)) out_.send(datagram);
    if (!std::exchange(linked_, true)) tell_(name() + ": the link is back");
    return true;
  } catch (const LinkLost& lost) {
    if (std::exchange(linked_, false)) {
      ++statistics_.links_lost;
      tell_(lost.what());
    }
    return false;
  }
}

void VmcSender::finish() {
  if (!colliders_) return;
  const std::vector<OscBytes> messages = colliders_->removals();
  for (int i = 0; i < kFinalTries; ++i) {
    if (i != 0) std::this_thread::sleep_for(kBetweenFinalTries);
    send_messages(messages);
  }
}

}  // namespace vestige
