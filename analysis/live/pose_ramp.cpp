#include "analysis/live/pose_ramp.hpp"

#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>
#include <utility>

#include "analysis/base/clocks.hpp"

namespace vestige {

Pose pose_between(const Pose& a, const Pose& b, double share) {
  if (!(share > 0)) return a;
  if (share >= 1) return b;
  Pose pose = b;
  pose.origin_m = glm::mix(a.origin_m, b.origin_m, share);
  for (std::size_t i = 0; i < pose.nodes.size(); ++i) {
    const NodeLocal& from = a.nodes[i];
    NodeLocal& node = pose.nodes[i];
    node.translation = glm::vec3(glm::mix(glm::dvec3(from.translation), glm::dvec3(node.translation), share));
    node.scale = glm::vec3(glm::mix(glm::dvec3(from.scale), glm::dvec3(node.scale), share));
    node.rotation = glm::quat(
        glm::slerp(glm::normalize(glm::dquat(from.rotation)), glm::normalize(glm::dquat(node.rotation)), share));
  }
  return pose;
}

void PoseRamp::lead_to(const Pose& pose, Clock::time_point from, Clock::duration length) {
  from_pose_ = to_pose_.nodes.empty() ? pose : at(from);
  to_pose_ = pose;
  from_ = from;
  length_ = length;
}

Pose PoseRamp::at(Clock::time_point time) const {
  const double share = length_ <= Clock::duration(0) ? 1 : seconds(time - from_) / seconds(length_);
  return pose_between(from_pose_, to_pose_, share);
}

PoseRamp::Clock::duration PoseRamp::delay_at(Clock::time_point time) const {
  return time < from_ + length_ ? length_ : Clock::duration(0);
}

}  // namespace vestige
