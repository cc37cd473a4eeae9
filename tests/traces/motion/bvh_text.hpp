#pragma once

#include <fmt/format.h>

#include <string>

namespace vestige::test {

/// A person of Mixamo's names in a T pose, in centimetres, without fingers: 16 joints, 51 channels. `motion` is what
/// follows the word MOTION.
inline std::string bvh_person(const std::string& motion) {
  const auto joint = [](const char* name, const char* offset, const std::string& below) {
    return fmt::format("JOINT mixamorig:{}\n{{\nOFFSET {}\nCHANNELS 3 Zrotation Xrotation Yrotation\n{}}}\n", name,
                       offset, below);
  };
  const std::string site = "End Site\n{\nOFFSET 0 1 0\n}\n";
  std::string limbs;
  for (const auto& [side, x] : {std::pair("Left", 1), std::pair("Right", -1)}) {
    const auto name = [begin = std::string(side)](const char* bone) { return begin + bone; };
    limbs += joint(name("UpLeg").c_str(), fmt::format("{} -5 0", 10 * x).c_str(),
                   joint(name("Leg").c_str(), "0 -45 0", joint(name("Foot").c_str(), "0 -45 0", site)));
  }
  std::string arms;
  for (const auto& [side, x] : {std::pair("Left", 1), std::pair("Right", -1)}) {
    const auto name = [begin = std::string(side)](const char* bone) { return begin + bone; };
    arms += joint(name("Arm").c_str(), fmt::format("{} 35 0", 18 * x).c_str(),
                  joint(name("ForeArm").c_str(), fmt::format("{} 0 0", 28 * x).c_str(),
                        joint(name("Hand").c_str(), fmt::format("{} 0 0", 25 * x).c_str(), site)));
  }
  return "HIERARCHY\nROOT mixamorig:Hips\n{\nOFFSET 0 95 0\n"
         "CHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation\n" +
         joint("Spine", "0 10 0", arms + joint("Neck", "0 40 0", joint("Head", "0 10 0", site))) + limbs + "}\nMOTION" +
         motion;
}

/// A frame of such a person: the hips' position, then zeros, of which one is `degrees`.
inline std::string bvh_frame(const std::string& hips, std::size_t turned = 0, double degrees = 0) {
  std::string line = hips;
  for (std::size_t channel = 3; channel < 51; ++channel) line += fmt::format(" {}", channel == turned ? degrees : 0.0);
  return line + "\n";
}

// Channels of the person above: Xrotation of the spine, Zrotation of the left arm, and Xrotation of the left thigh.
inline constexpr std::size_t kSpineX = 7;
inline constexpr std::size_t kLeftArmZ = 9;
inline constexpr std::size_t kLeftThighX = 34;

}  // namespace vestige::test
