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
  std::vector<BvhChannel> channels;  ///< each at most once; rotations are multiplied in this order, first leftmost
  std::size_t first_channel = 0;     ///< of a frame's numbers
};

/// Motion capture as Biovision's BVH has it: a skeleton whose rest has no rotation, and channels for each frame.
struct BvhMotion {
  std::vector<BvhJoint> joints;  ///< parents before children
  std::vector<glm::dvec3> ends;  ///< of joints that end in a site: its offset; one for each joint, else (0, 0, 0)
  double frame_time_s = 0;
  std::size_t frame_count = 0;
  std::size_t channel_count = 0;  ///< numbers in a frame
  std::vector<float> values;      ///< frame after frame

  float value(std::size_t frame, std::size_t channel) const { return values[frame * channel_count + channel]; }
};

/// Where a joint is and how it is turned, in the file's own axes and unit.
struct BvhPlace {
  glm::dvec3 position = glm::dvec3(0);
  glm::dquat rotation = glm::dquat(1, 0, 0, 0);
};

/// Of all joints in a frame. Position channels take the place of the joint's offset.
void bvh_places(const BvhMotion& motion, std::size_t frame, std::vector<BvhPlace>& out);

/// Of all joints at rest, roots at their offset.
std::vector<BvhPlace> bvh_rest(const BvhMotion& motion);

/// A word of such a file as messages show it: 40 bytes at most.
std::string shown_word(std::string_view word);

/// Throws `Error` naming file and line for whatever is not a BVH: an unknown word, a missing brace or MOTION, joints
/// nested deeper than 256, channels that do not exist or stand twice, a frame with another number of numbers than there
/// are channels, more or fewer frames than the file says, numbers that are none or not finite, a frame time that is not
/// positive. Memory is bounded by the file's size.
BvhMotion parse_bvh(std::string_view text, const std::string& name);

/// The same of a file of 512 MiB at most; "-" is standard input.
BvhMotion read_bvh(const std::filesystem::path& path);

}  // namespace vestige
