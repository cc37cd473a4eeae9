#include <cmath>
#include <cstdint>
#include <cstring>
#include <string_view>

#include "tests/fuzz/require.hpp"
#include "traces/base/error.hpp"
#include "traces/motion/retarget.hpp"

// Whatever a BVH file holds, reading it and putting it on an avatar ends in an error that says something, or in an
// animation that can be played and is finite.

using vestige::fuzz::require;

namespace vestige {
namespace {

/// The skeleton of a person; motion looks at nothing else of an avatar.
Avatar skeleton() {
  struct Bone {
    const char* name;
    int parent;
    glm::vec3 translation;
  };
  const Bone bones[] = {
      {"hips", -1, {0, 1, 0}},           {"spine", 0, {0, 0.1F, 0}},           {"neck", 1, {0, 0.4F, 0}},
      {"head", 2, {0, 0.1F, 0}},         {"leftUpperArm", 1, {0.2F, 0.3F, 0}}, {"leftLowerArm", 4, {0.2F, -0.2F, 0}},
      {"leftHand", 5, {0.2F, -0.1F, 0}}, {"leftUpperLeg", 0, {0.1F, 0, 0}},    {"leftLowerLeg", 7, {0, -0.4F, 0}},
      {"leftFoot", 8, {0, -0.4F, 0}},    {"rightUpperLeg", 0, {-0.1F, 0, 0}},  {"rightFoot", 10, {0, -0.8F, 0}}};
  Avatar avatar;
  for (const Bone& bone : bones) {
    avatar.node_order.push_back(static_cast<int>(avatar.nodes.size()));
    Node& node = avatar.nodes.emplace_back();
    node.name = bone.name;
    node.parent = bone.parent;
    node.rest.translation = bone.translation;
  }
  return avatar;
}

void check(std::string_view text) {
  static const Avatar avatar = skeleton();
  const BvhMotion motion = parse_bvh(text, "fuzz");
  require(motion.values.size() == motion.frame_count * motion.channel_count, "all frames have all channels");
  require(motion.ends.size() == motion.joints.size(), "one end for each joint");
  for (std::size_t i = 0; i < motion.joints.size(); ++i)
    require(motion.joints[i].parent < static_cast<int>(i), "parents come first");
  RetargetReport report;
  const Animation animation = retarget(motion, avatar, {}, "fuzz", report);
  for (const AnimationChannel& channel : animation.channels) {
    require(channel.times_s.size() == motion.frame_count, "a key a frame");
    for (const float value : channel.values) require(std::isfinite(value), "keys are finite");
  }
}

}  // namespace
}  // namespace vestige

// NOLINTNEXTLINE(readability-identifier-naming): libFuzzer's hook
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    vestige::check({reinterpret_cast<const char*>(data), size});
  } catch (const vestige::Error& error) {
    require(std::strlen(error.what()) > 0, "errors say something");
  }
  return 0;
}
