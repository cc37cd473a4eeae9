#include "traces/questions/pose_question.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace vestige {

namespace {

/// Frames to look at: a convention does not change within a file.
constexpr std::uint64_t kEnough = 64;
/// A joint stands as at rest if it is no farther away from there than this share of its distance from its parent.
constexpr float kSame = 0.05F;
/// A joint nearer to its parent than this tells nothing.
constexpr float kLeast_m = 0.005F;
/// What is named: nine joints in ten would stand as at rest, and fewer than nine in ten of these do so now. A mirror
/// leaves those in the body's middle as they are.
constexpr double kConvincing = 0.9;
constexpr double kDoubtful = 0.9;
/// Cosines of half the angles by which joints are turned from rest: further than 120 degrees, less than 90, at all.
constexpr float kFarTurned = 0.5F;
constexpr float kLittleTurned = 0.707F;
constexpr float kTurned = 0.9999F;
/// Fewer joints than these tell nothing about the order of a quaternion's numbers.
constexpr std::size_t kLeastTurned = 3;
/// Frames farther apart than this are likely in milliseconds.
constexpr double kLongStep_s = 0.5;

bool stands_as_at_rest(const NodeLocal& node, const NodeLocal& rest) {
  return glm::distance(node.translation, rest.translation) <= kSame * glm::length(rest.translation);
}

/// The cosine of half the angle between two rotations.
float closeness(const glm::quat& a, const glm::quat& b) {
  return std::abs(glm::dot(a, b));
}

std::size_t count_most(const std::vector<std::uint64_t>& frames_of_each, std::uint64_t frames) {
  return static_cast<std::size_t>(
      std::ranges::count_if(frames_of_each, [&](std::uint64_t some) { return 2 * some > frames; }));
}

}  // namespace

PoseQuestion::PoseQuestion(const Avatar& avatar, const Convention& convention, const std::vector<bool>& placed)
    : avatar_(avatar), convention_(convention), turned_(avatar.nodes.size()), wrong_order_(avatar.nodes.size()) {
  for (std::size_t i = 0; i < avatar.nodes.size(); ++i) {
    const Node& node = avatar.nodes[i];
    if (placed[i] && node.parent >= 0 && !node.fixed_matrix && glm::length(node.rest.translation) >= kLeast_m)
      joints_.push_back(static_cast<int>(i));
  }
  readings_.push_back({convention, "", std::vector<std::uint64_t>(joints_.size())});
  for (const AxisPreset& preset : kAxisPresets)
    for (const Unit& unit : kLengthUnits) {
      Convention other = convention;
      other.metres_per_unit = unit.size;
      other.axes = axes_named(preset.name);
      if (std::ranges::find(readings_, other, &Reading::convention) != readings_.end()) continue;
      std::string flags;
      if (other.axes != convention.axes) flags = fmt::format("--pose-axes {}", preset.name);
      if (flags.empty() || unit.name != preset.unit)
        flags += fmt::format("{}--pose-unit {}", flags.empty() ? "" : " ", unit.name);
      readings_.push_back({other, flags, std::vector<std::uint64_t>(joints_.size())});
    }
}

void PoseQuestion::see(const TraceFrame& frame) {
  if (frames_ == kEnough) return;
  if (frames_ == 0) first_ns_ = frame.time_ns;
  last_ns_ = frame.time_ns;
  ++frames_;
  for (std::size_t k = 0; k < joints_.size(); ++k) {
    const auto node = static_cast<std::size_t>(joints_[k]);
    const NodeLocal given = convention_.given_node(frame.poses.front().nodes[node]);
    for (Reading& reading : readings_)
      if (stands_as_at_rest(reading.convention.node(given), avatar_.nodes[node].rest)) ++reading.as_at_rest[k];
  }
  for (std::size_t i = 0; i < avatar_.nodes.size(); ++i) {
    const glm::quat& rest = avatar_.nodes[i].rest.rotation;
    NodeLocal given = convention_.given_node(frame.poses.front().nodes[i]);
    const float now = closeness(convention_.node(given).rotation, rest);
    if (now < kTurned) ++turned_[i];
    given.rotation = glm::quat(given.rotation.x, given.rotation.y, given.rotation.z, given.rotation.w);
    if (now < kFarTurned && closeness(convention_.node(given).rotation, rest) > kLittleTurned) ++wrong_order_[i];
  }
}

std::string PoseQuestion::doubt_of_joints() const {
  if (joints_.empty()) return {};
  const auto joints_at_rest = [&](const Reading& reading) { return count_most(reading.as_at_rest, frames_); };
  const std::size_t now = joints_at_rest(readings_.front());
  const Reading& best = *std::ranges::max_element(readings_, {}, joints_at_rest);
  const std::size_t then = joints_at_rest(best);
  if (static_cast<double>(then) < kConvincing * static_cast<double>(joints_.size())) return {};
  if (static_cast<double>(now) >= kDoubtful * static_cast<double>(then)) return {};
  return fmt::format("{} of {} joints do not stand in their parents as at rest; {} of them would with {}",
                     joints_.size() - now, joints_.size(), then, best.flags);
}

std::string PoseQuestion::doubt_of_quaternions() const {
  const std::size_t turned = count_most(turned_, frames_);
  const std::size_t wrong = count_most(wrong_order_, frames_);
  if (wrong < kLeastTurned || static_cast<double>(wrong) < kConvincing * static_cast<double>(turned)) return {};
  return fmt::format(
      "{} of {} joints that turn are turned by more than 120 degrees; if their quaternions are written "
      "w,x,y,z, name the columns NODE.rw, NODE.rx, NODE.ry, NODE.rz",
      wrong, turned);
}

std::string PoseQuestion::doubt_of_times() const {
  if (frames_ < 2 || convention_.seconds_per_unit != 1) return {};
  const double step_s = static_cast<double>(last_ns_ - first_ns_) / 1e9 / static_cast<double>(frames_ - 1);
  if (step_s <= kLongStep_s) return {};
  return fmt::format("the frames are {:.4g} s apart; if these are milliseconds: --time-unit ms", step_s);
}

std::vector<std::string> PoseQuestion::ask() const {
  std::vector<std::string> doubts = {doubt_of_joints(), doubt_of_quaternions(), doubt_of_times()};
  std::erase(doubts, "");
  return doubts;
}

}  // namespace vestige
