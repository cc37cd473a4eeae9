#pragma once

#include <cstdint>
#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>
#include <map>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "traces/live/osc_packet.hpp"
#include "traces/motion/humanoid.hpp"
#include "traces/recording/frame_ring.hpp"
#include "traces/scene/avatar.hpp"
#include "traces/scene/trace.hpp"

namespace vestige {

/// Who moves how, as a VR program says it by the Virtual Motion Capture protocol (https://protocol.vmc.info), and where
/// the colliders are. Datagrams change the state; a frame shows it as it is.
///
///     /VMC/Ext/Root/Pos  ,sfffffff(fff fff)  name, position, rotation x y z w; scale and offset of 2.1 are left out
///     /VMC/Ext/Bone/Pos  ,sfffffff           Unity's HumanBodyBones, position, rotation x y z w, in its parent
///
///     /vestige/collider  ,ifff or ,iddd      id, x, y, z: there it is, in metres, in glTF's axes
///     /vestige/collider/remove  ,i           it is gone
///     /vestige/teleport  ,i                  its way since the last frame is no motion
///     /vestige/marker    ,s                  something to find again
///
/// VMC's axes are Unity's (left-handed, +Y up, +Z forward). Its rotations are of a skeleton whose bones all have no
/// rotation in the T-pose, so they are turned into each node's own rest frame. Positions of bones are the sender's
/// proportions: only that of the hips moves the avatar, which keeps its own. Other addresses are ignored.
class VmcState {
 public:
  /// Throws `Error` for an avatar without any bone of a human body.
  VmcState(const Avatar& avatar, const Humanoid& humanoid, const glm::dvec3& origin_m);

  /// One datagram; a malformed one changes nothing and is counted. Returns whether it changed the state.
  bool take(std::span<const std::byte> datagram);

  /// The state as a frame, without number and time. Marks of teleports are given once.
  void show(TraceFrame& frame);
  /// Marks that could not be given on, for the next frame.
  void mark_teleported(std::vector<std::uint32_t> ids) { teleported_ = std::move(ids); }
  /// What was marked since `forget_markers`; 1000 at most, further ones are malformed.
  const std::vector<RecordingNote>& markers() const { return markers_; }
  void forget_markers() { markers_.clear(); }

  std::uint64_t malformed() const { return malformed_; }
  const std::vector<std::string>& problems() const { return problems_; }  ///< why the first few were
  /// Bones that were sent but that the avatar lacks; the first 64.
  const std::set<std::string>& unknown_bones() const { return unknown_bones_; }
  /// Bones that moved the avatar.
  const std::set<std::string>& bones() const { return bones_; }

 private:
  struct Bone {
    std::size_t node = 0;
    glm::dquat parent_rest = glm::dquat(1, 0, 0, 0);  ///< rotation of its parent in the rest pose
    glm::dmat4 parent_from_avatar = glm::dmat4(1);    ///< position in the avatar's frame to one relative to its parent
  };
  struct Placement {
    glm::dvec3 position = glm::dvec3(0);
    glm::dquat rotation = glm::dquat(1, 0, 0, 0);
  };

  bool apply(const OscMessage& message);
  Placement placement_of(const OscMessage& message) const;
  bool move_bone(const std::string& name, const Placement& placement);

  Pose pose_;
  std::vector<glm::dquat> rest_;  ///< each node's own rotation in the rest pose
  std::map<std::string, Bone, std::less<>> bone_of_;
  Humanoid::Facing facing_;
  std::size_t top_ = 0;  ///< the outermost node above the hips, which the root moves
  NodeLocal top_local_;  ///< without the root
  Placement root_;
  std::map<std::uint32_t, glm::dvec3> colliders_;
  std::vector<std::uint32_t> teleported_;
  std::vector<RecordingNote> markers_;
  std::set<std::string> bones_;
  std::set<std::string> unknown_bones_;
  std::uint64_t malformed_ = 0;
  std::vector<std::string> problems_;
};

}  // namespace vestige
