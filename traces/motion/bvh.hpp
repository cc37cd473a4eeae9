#pragma once

#include <cstddef>
#include <filesystem>
#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace vestige {

/// Positions in the file's unit, rotations in degrees.
enum class BvhChannel { kXPosition, kYPosition, kZPosition, kXRotation, kYRotation, kZRotation };

struct BvhJoint {
  std::string name;
  int parent = -1;  ///< index of an earlier joint, -1 for a root
  glm::dvec3 offset = glm::dvec3(0);
  std::vector<BvhChannel> channels;  ///< each at most once; rotations multiply in this order, first leftmost
  std::size_t first_channel = 0;     ///< index of the joint's first channel in a frame
};

/// Motion capture data of a Biovision BVH file: a skeleton whose rest pose has no rotations, and channels for each
/// frame.
struct BvhMotion {
  std::vector<BvhJoint> joints;  ///< parents before children
  std::vector<glm::dvec3> ends;  ///< one for each joint: offset of its end site, or (0, 0, 0) without one
  double frame_time_s = 0;
  std::size_t frame_count = 0;
  std::size_t channel_count = 0;      ///< count of numbers in a frame
  std::vector<float> values;          ///< frame after frame
  std::vector<std::string> warnings;  ///< oddities of the file that do no harm, one sentence each

  float value(std::size_t frame, std::size_t channel) const { return values[frame * channel_count + channel]; }
};

/// Position and rotation of a joint, in the file's own axes and unit.
struct BvhPlace {
  glm::dvec3 position = glm::dvec3(0);
  glm::dquat rotation = glm::dquat(1, 0, 0, 0);
};

/// Returns in `out` the places of all joints in a frame. Position channels replace the joint's offset.
void bvh_places(const BvhMotion& motion, std::size_t frame, std::vector<BvhPlace>& out);

/// Returns the places of all joints at rest, with roots at their offset.
std::vector<BvhPlace> bvh_rest(const BvhMotion& motion);

/// Returns a word of a BVH file for messages, at most 40 bytes of it.
std::string shown_word(std::string_view word);

/// Parses a BVH file. Throws `Error` with file and line if it is not valid: an unknown word, a missing brace or MOTION,
/// joints nested deeper than 256, channels that do not exist or occur twice, a frame whose count of numbers differs
/// from the count of channels, fewer frames than the file says, numbers that are invalid or not finite, a frame time
/// that is not positive. If the file has more frames than it says, all are read, with a warning; a last one that is cut
/// short is left out. Memory is bounded by the file's size.
BvhMotion parse_bvh(std::string_view text, const std::string& name);

/// Reads and parses a BVH file of at most 512 MiB; "-" is standard input.
BvhMotion read_bvh(const std::filesystem::path& path);

}  // namespace vestige
