// People in motion, written as BVH files of many conventions: which axis is up, and how the skeleton lies while all
// rotations are zero.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <glm/gtc/constants.hpp>
#include <glm/gtc/quaternion.hpp>
#include <map>
#include <string>
#include <vector>

#include "traces/scene/avatar.hpp"

namespace vestige::test {

/// A joint of the person: in a T pose, facing +Z, with +Y up and the left side at +X. Metres.
struct MadeJoint {
  const char* name;
  int parent;
  glm::dvec3 offset;  ///< from the parent
  glm::dvec3 end;     ///< of the last bone, or 0
};

/// Motion-capture names with sides at the end, and a root under the body.
inline const std::vector<MadeJoint>& made_person() {
  static const std::vector<MadeJoint> joints = {{"joint_Root", -1, {0, 0, 0}, {}},
                                                {"Hips", 0, {0, 0.95, 0}, {}},
                                                {"Spine", 1, {0, 0.1, 0}, {}},
                                                {"Chest", 2, {0, 0.18, 0}, {}},
                                                {"Neck", 3, {0, 0.22, 0}, {}},
                                                {"Head", 4, {0, 0.1, 0}, {0, 0.18, 0}},
                                                {"Shoulder_L", 3, {0.06, 0.16, 0}, {}},
                                                {"UpperArm_L", 6, {0.12, 0, 0}, {}},
                                                {"LowerArm_L", 7, {0.28, 0, 0}, {}},
                                                {"Hand_L", 8, {0.25, 0, 0}, {0.16, 0, 0}},
                                                {"Shoulder_R", 3, {-0.06, 0.16, 0}, {}},
                                                {"UpperArm_R", 10, {-0.12, 0, 0}, {}},
                                                {"LowerArm_R", 11, {-0.28, 0, 0}, {}},
                                                {"Hand_R", 12, {-0.25, 0, 0}, {-0.16, 0, 0}},
                                                {"UpperLeg_L", 1, {0.09, -0.04, 0}, {}},
                                                {"LowerLeg_L", 14, {0, -0.42, 0}, {}},
                                                {"Foot_L", 15, {0, -0.41, 0}, {}},
                                                {"Toes_L", 16, {0, -0.06, 0.13}, {0, 0, 0.07}},
                                                {"UpperLeg_R", 1, {-0.09, -0.04, 0}, {}},
                                                {"LowerLeg_R", 18, {0, -0.42, 0}, {}},
                                                {"Foot_R", 19, {0, -0.41, 0}, {}},
                                                {"Toes_R", 20, {0, -0.06, 0.13}, {0, 0, 0.07}}};
  return joints;
}

/// Rotations of joints in the world, from the T pose, by name; joints that are not named turn with their parent.
using MadePose = std::map<std::string, glm::dquat>;

inline glm::dquat about(const glm::dvec3& axis, double degrees) {
  return glm::angleAxis(glm::radians(degrees), axis);
}

/// Returns the pose of a person who walks, lies, crawls or stands on their hands, at `phase` of a cycle from 0 to 1.
inline MadePose made_pose(const std::string& motion, double phase) {
  const glm::dvec3 x(1, 0, 0);
  const glm::dvec3 z(0, 0, 1);
  const double swing = std::sin(2 * glm::pi<double>() * phase);
  const auto bent = [](double s) { return std::max(0.0, s); };
  const auto arms_down = [&](MadePose& pose, const glm::dquat& body, double left, double right) {
    pose["UpperArm_L"] = body * about(x, left) * about(z, -80);
    pose["UpperArm_R"] = body * about(x, right) * about(z, 80);
  };
  MadePose pose;
  if (motion == "walk") {
    pose = {{"UpperLeg_L", about(x, -25 * swing)},
            {"LowerLeg_L", about(x, -25 * swing + 40 * bent(swing))},
            {"UpperLeg_R", about(x, 25 * swing)},
            {"LowerLeg_R", about(x, 25 * swing + 40 * bent(-swing))},
            {"Foot_L", about(x, 0)},
            {"Foot_R", about(x, 0)}};
    arms_down(pose, about(x, 0), 20 * swing, -20 * swing);
  } else if (motion == "lie") {  // on the back, head at -Z; an arm is raised now and then
    const glm::dquat body = about(x, -90);
    pose = {{"Hips", body}};
    arms_down(pose, body, -60 * bent(swing), 0);
  } else if (motion == "crawl") {  // face down, head at +Z, on hands and knees
    const glm::dquat body = about(x, 80);
    pose = {{"Hips", body},
            {"UpperLeg_L", about(x, -10 * swing)},
            {"LowerLeg_L", about(x, 88)},
            {"UpperLeg_R", about(x, 10 * swing)},
            {"LowerLeg_R", about(x, 88)},
            {"Head", body * about(x, -30)}};
    pose["UpperArm_L"] = about(x, 15 * swing) * about(z, -88);
    pose["UpperArm_R"] = about(x, -15 * swing) * about(z, 88);
  } else {  // a handstand: the legs wave
    const glm::dquat body = about(x, 180);
    pose = {{"Hips", body},
            {"UpperLeg_L", body * about(x, 20 * swing)},
            {"UpperLeg_R", body * about(x, -20 * swing)},
            {"UpperArm_L", body * about(z, 85)},
            {"UpperArm_R", body * about(z, -85)}};
  }
  return pose;
}

/// Where the person's joints are, and how they are turned in the world from the T pose.
struct MadeFrame {
  std::vector<glm::dvec3> position;
  std::vector<glm::dquat> turned;
};

/// Returns one second of a motion at 30 Hz, the lowest end of a bone always 2 cm over the floor.
inline std::vector<MadeFrame> made_motion(const std::string& motion) {
  constexpr int kFrames = 31;
  const auto& joints = made_person();
  std::vector<MadeFrame> frames;
  for (int k = 0; k < kFrames; ++k) {
    const double time_s = k / 30.0;
    const MadePose pose = made_pose(motion, time_s);
    const double travel = motion == "walk" ? 1.2 * time_s : motion == "crawl" ? 0.4 * time_s : 0;
    MadeFrame frame;
    double lowest = 1e9;
    for (std::size_t i = 0; i < joints.size(); ++i) {
      const auto parent = static_cast<std::size_t>(std::max(joints[i].parent, 0));
      const auto known = pose.find(joints[i].name);
      frame.turned.push_back(known != pose.end() ? known->second
                             : i == 0            ? glm::dquat(1, 0, 0, 0)
                                                 : frame.turned[parent]);
      frame.position.push_back(i < 2 ? glm::dvec3(0, 0, travel)
                                     : frame.position[parent] + frame.turned[parent] * joints[i].offset);
      for (const glm::dvec3& end : {frame.position[i], frame.position[i] + frame.turned[i] * joints[i].end})
        if (i > 0) lowest = std::min(lowest, end.y);
    }
    for (std::size_t i = 1; i < joints.size(); ++i) frame.position[i].y += 0.02 - lowest;
    frame.position[0].z = 0;
    frames.push_back(frame);
  }
  return frames;
}

/// Returns the rotation that takes +Y to the axis that is up: "y", "-y", "z" or "-z".
inline glm::dquat made_up(const std::string& up) {
  return about({1, 0, 0}, up == "y" ? 0 : up == "z" ? 90 : up == "-y" ? 180 : -90);
}

/// Returns how a joint's axes lie in the T pose if its rotation is zero in the shape `rest`: "T", "A", "standing",
/// "lying", "x" (each bone along +X) or "mirrored" (the same, with the right side along -X).
inline glm::dquat made_axes(const std::string& rest, std::size_t joint) {
  const auto& joints = made_person();
  const std::string name = joints[joint].name;
  const bool is_left = name.ends_with("_L");
  const bool is_arm = name.find("Arm") != std::string::npos || name.find("Hand") != std::string::npos;
  if (rest == "lying") return about({1, 0, 0}, 90);
  if (rest == "T" || ((rest == "A" || rest == "standing") && !is_arm)) return {1, 0, 0, 0};
  if (rest == "A" || rest == "standing") return about({0, 0, 1}, (rest == "A" ? 45 : 85) * (is_left ? 1 : -1));
  if (joint == 0) return {1, 0, 0, 0};
  glm::dvec3 bone = joints[joint].end;
  for (std::size_t i = joints.size(); i-- > 0;)
    if (joints[i].parent == static_cast<int>(joint)) bone = joints[i].offset;
  if (name == "Hips") bone = {0, 1, 0};
  if (name == "Chest") bone = {0, 1, 0};
  const double side = rest == "mirrored" && name.ends_with("_R") ? -1 : 1;
  const glm::dvec3 x = side * glm::normalize(bone);
  const glm::dvec3 other = std::abs(x.z) < 0.9 ? glm::dvec3(0, 0, 1) : glm::dvec3(0, 1, 0);
  const glm::dvec3 y = glm::normalize(glm::cross(other, x));
  return glm::normalize(glm::quat_cast(glm::dmat3(x, y, glm::cross(x, y))));
}

/// Writes frames as a BVH file in centimetres.
inline std::string made_bvh(const std::vector<MadeFrame>& frames, const std::string& up, const std::string& rest) {
  const auto& joints = made_person();
  const glm::dquat world = made_up(up);
  std::vector<glm::dquat> axes;
  // A person who stands at rest does so in the file's world.
  const bool stands = rest == "T" || rest == "A" || rest == "standing";
  for (std::size_t i = 0; i < joints.size(); ++i)
    axes.push_back(made_axes(rest, i) * (stands ? glm::conjugate(world) : glm::dquat(1, 0, 0, 0)));
  const auto local = [&](std::size_t joint, const glm::dvec3& offset) {
    const glm::dvec3 v = glm::conjugate(axes[joint]) * offset * 100.0;
    return fmt::format("{:.9f} {:.9f} {:.9f}", v.x, v.y, v.z);
  };
  const std::function<std::string(std::size_t)> joint = [&](std::size_t i) {
    const auto parent = static_cast<std::size_t>(std::max(joints[i].parent, 0));
    std::string text = fmt::format(
        "{} {}\n{{\nOFFSET {}\nCHANNELS {}Zrotation Xrotation Yrotation\n", i == 0 ? "ROOT" : "JOINT", joints[i].name,
        i == 0 ? "0 0 0" : local(parent, joints[i].offset), i < 2 ? "6 Xposition Yposition Zposition " : "3 ");
    for (std::size_t child = 0; child < joints.size(); ++child)
      if (joints[child].parent == static_cast<int>(i)) text += joint(child);
    if (joints[i].end != glm::dvec3(0)) text += fmt::format("End Site\n{{\nOFFSET {}\n}}\n", local(i, joints[i].end));
    return text + "}\n";
  };
  // Depth first, as the file's channels are.
  std::vector<std::size_t> order;
  const std::function<void(std::size_t)> visit = [&](std::size_t i) {
    order.push_back(i);
    for (std::size_t child = 0; child < joints.size(); ++child)
      if (joints[child].parent == static_cast<int>(i)) visit(child);
  };
  visit(0);
  std::string text =
      "HIERARCHY\n" + joint(0) + fmt::format("MOTION\nFrames: {}\nFrame Time: 0.0333333\n", frames.size());
  for (const MadeFrame& frame : frames) {
    std::vector<glm::dquat> turned;
    for (std::size_t i = 0; i < joints.size(); ++i) turned.push_back(world * frame.turned[i] * axes[i]);
    for (const std::size_t i : order) {
      const auto parent = static_cast<std::size_t>(std::max(joints[i].parent, 0));
      const glm::dquat above = i == 0 ? glm::dquat(1, 0, 0, 0) : turned[parent];
      if (i < 2) {
        const glm::dvec3 from = i == 0 ? glm::dvec3(0) : world * frame.position[0];
        const glm::dvec3 p = glm::conjugate(above) * (world * frame.position[i] - from) * 100.0;
        text += fmt::format("{:.7f} {:.7f} {:.7f} ", p.x, p.y, p.z);
      }
      const glm::dmat3 m = glm::mat3_cast(glm::conjugate(above) * turned[i]);  // m[column][row], = Rz Rx Ry
      const double turn_x = std::asin(std::clamp(m[1][2], -1.0, 1.0));
      text += fmt::format("{:.7f} {:.7f} {:.7f} ", glm::degrees(std::atan2(-m[1][0], m[1][1])), glm::degrees(turn_x),
                          glm::degrees(std::atan2(-m[0][2], m[2][2])));
    }
    text += "\n";
  }
  return text;
}

/// Returns an avatar with the person's own proportions, in the T pose, whose ground is at 0.
inline Avatar made_avatar() {
  Avatar avatar;
  for (const MadeJoint& joint : made_person()) {
    Node node;
    node.name = joint.name;
    node.parent = joint.parent;
    node.rest.translation = glm::vec3(joint.offset);
    avatar.node_order.push_back(static_cast<int>(avatar.nodes.size()));
    avatar.palette.push_back({static_cast<int>(avatar.nodes.size()), glm::dmat4(1)});
    avatar.nodes.push_back(node);
  }
  return avatar;
}

}  // namespace vestige::test
