#pragma once

#include <cstddef>
#include <glm/gtc/quaternion.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "traces/scene/avatar.hpp"
#include "traces/scene/trace.hpp"

namespace vestige {

/// Where a frame of a viewer is in the frame above it. Frames have no scale.
struct VizPlacement {
  glm::dvec3 position_m = glm::dvec3(0);
  glm::dquat rotation = glm::dquat(1, 0, 0, 0);
};

/// A person as viewers know them.
struct VizBody {
  Avatar skeleton;                       ///< only its nodes, their order and the root
  std::string frame;                     ///< of the avatar: "avatar", of a later person "avatar 2"
  std::vector<std::string> node_frames;  ///< one for each node
  // Of the frame that `VizBodies::take` took last. Empty if the person's pose is missing or has a number that is not
  // finite.
  std::vector<glm::dmat4> world;             ///< of the nodes, relative to the avatar's frame
  std::vector<VizPlacement> node_placement;  ///< of the nodes, relative to the avatar's frame

  bool is_there() const { return !world.empty(); }
};

/// The people of a trace, the names of their frames, and where their nodes are.
///
/// Frames have the names of the nodes; with a later person, its number stands before them: "2/hips". A frame gets its
/// node's number appended if the node has no name or shares its name with another frame.
class VizBodies {
 public:
  /// Copies the names and the trees of the avatars' nodes, one avatar for each person.
  explicit VizBodies(const std::vector<const Avatar*>& avatars);

  /// Places everybody as in this frame. The placement of a node that is scaled to zero, or mirrored, has no rotation.
  void take(const TraceFrame& frame);

  const std::vector<VizBody>& people() const { return people_; }

 private:
  std::vector<VizBody> people_;
};

/// Whether viewers can draw something here: each number is finite.
bool is_drawable(const glm::dvec3& place);

/// Returns `name` for the first person, who counts from 0, and "NAME 2" for the second.
std::string viz_name(std::string_view name, std::size_t person);

}  // namespace vestige
