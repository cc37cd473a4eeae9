#include "traces/questions/pose_question.hpp"

#include <fmt/format.h>

#include <algorithm>
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

bool stands_as_at_rest(const NodeLocal& node, const NodeLocal& rest) {
  return glm::distance(node.translation, rest.translation) <= kSame * glm::length(rest.translation);
}

}  // namespace

PoseQuestion::PoseQuestion(const Avatar& avatar, const Convention& convention, const std::vector<bool>& placed)
    : avatar_(avatar), convention_(convention) {
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
  ++frames_;
  for (std::size_t k = 0; k < joints_.size(); ++k) {
    const auto node = static_cast<std::size_t>(joints_[k]);
    const NodeLocal given = convention_.given_node(frame.pose.nodes[node]);
    for (Reading& reading : readings_)
      if (stands_as_at_rest(reading.convention.node(given), avatar_.nodes[node].rest)) ++reading.as_at_rest[k];
  }
}

std::optional<std::string> PoseQuestion::ask() const {
  if (joints_.empty() || frames_ == 0) return std::nullopt;
  const auto joints_at_rest = [&](const Reading& reading) {
    return static_cast<std::size_t>(
        std::ranges::count_if(reading.as_at_rest, [&](std::uint64_t frames) { return 2 * frames > frames_; }));
  };
  const std::size_t now = joints_at_rest(readings_.front());
  const Reading& best = *std::ranges::max_element(readings_, {}, joints_at_rest);
  const std::size_t then = joints_at_rest(best);
  if (static_cast<double>(then) < kConvincing * static_cast<double>(joints_.size())) return std::nullopt;
  if (static_cast<double>(now) >= kDoubtful * static_cast<double>(then)) return std::nullopt;
  return fmt::format("{} of {} joints do not stand in their parents as at rest; {} of them would with {}",
                     joints_.size() - now, joints_.size(), then, best.flags);
}

}  // namespace vestige
