#pragma once

#include <cstdint>
#include <functional>
#include <glm/vec3.hpp>
#include <map>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "traces/live/osc_packet.hpp"
#include "traces/live/vmc_skeleton.hpp"
#include "traces/recording/frame_ring.hpp"
#include "traces/scene/avatar.hpp"
#include "traces/scene/stance.hpp"
#include "traces/scene/trace.hpp"

namespace vestige {

/// What the messages of a datagram are about.
struct VmcContent {
  bool pose = false;       ///< of a bone or the root
  bool colliders = false;  ///< where they are, that they are gone, or that they jumped
  bool ends = false;       ///< /VMC/Ext/OK, unless it says 0: a frame ends with this datagram
};

/// The pose of the avatar, as a VR program sends it by the Virtual Motion Capture protocol (https://protocol.vmc.info),
/// and the positions of the colliders. Datagrams change the state; a frame shows the current state.
///
///     /VMC/Ext/Root/Pos  ,sfffffff(fff fff)  name, position, rotation x y z w; scale and offset of 2.1 are ignored
///     /VMC/Ext/Bone/Pos  ,sfffffff           Unity's HumanBodyBones, position, rotation x y z w, in its parent
///     /VMC/Ext/OK        ,i and more         a frame ends; 0: there is none yet
///
///     /vestige/collider  ,ifff or ,iddd      id, x, y, z: its position, in metres, in glTF's axes
///                        ,iffff or ,idddd    the same, then its radius in metres; without it, it is a point
///     /vestige/collider/remove  ,i           the collider is gone
///     /vestige/teleport  ,i                  its path since the last frame is not a motion
///     /vestige/marker    ,s                  a place to find again
///
/// VMC's axes are Unity's (left-handed, +Y up, +Z forward). Its rotations assume a skeleton whose bones have no
/// rotation in the T-pose, so they are converted to each node's own rest frame. The positions of bones reflect the
/// sender's proportions. Only the position of the hips moves the avatar, which keeps its own proportions. Other
/// addresses are ignored.
class VmcState {
 public:
  /// All that the sender says is placed by `stance`, from `origin_m` on. Keeps a reference to the avatar. Throws
  /// `Error` if the avatar has no bone of a human body, or does not stand (`AvatarFacing::lies_deg`).
  VmcState(const Avatar& avatar, const glm::dvec3& origin_m, const Stance& stance = {});

  /// Returns whether a valid datagram counts. It is called before the datagram changes anything.
  using Admit = std::function<bool(const VmcContent&)>;

  /// Takes one datagram. A malformed datagram changes nothing and is counted. Nor does one change anything for which
  /// `admit` returns false. Returns whether the datagram changed the state.
  bool take(std::span<const std::byte> datagram, const Admit& admit = {});

  /// Returns in `frame` the state, with one pose and by ascending ids, without number and time. Reports each teleport
  /// once. A collider that is removed and comes back has jumped, until `forget_removed`.
  void show(TraceFrame& frame);
  /// To be called when a frame without the removed colliders was shown.
  void forget_removed() { removed_.clear(); }
  /// All colliders are gone.
  void remove_colliders();
  /// The markers since `forget_markers`; 1000 at most, further ones count as malformed.
  const std::vector<RecordingNote>& markers() const { return markers_; }
  void forget_markers() { markers_.clear(); }

  std::uint64_t malformed() const { return malformed_; }
  const std::vector<std::string>& problems() const { return problems_; }  ///< of the first few malformed ones
  /// Bones that were sent but do not exist in the avatar; the first 64.
  const std::set<std::string>& unknown_bones() const { return unknown_bones_; }
  /// Bones that moved the avatar.
  const std::set<std::string>& bones() const { return bones_; }

 private:
  /// Returns what the messages are about. Throws `mcap::Malformed` unless all of them are valid.
  VmcContent check(std::span<const OscMessage> messages) const;
  bool apply(const OscMessage& message);
  VmcPlacement placement_of(const OscMessage& message) const;
  bool move_bone(const std::string& name, const VmcPlacement& placement);

  const Avatar& avatar_;
  glm::dvec3 origin_m_;
  Stance stance_;
  VmcSkeleton skeleton_;
  Pose pose_;            ///< before the stance
  NodeLocal top_local_;  ///< transform of the skeleton's top without the root
  VmcPlacement root_;
  std::map<std::uint32_t, ColliderSample> colliders_;
  std::set<std::uint32_t> removed_;  ///< ids
  std::set<std::uint32_t> teleported_;
  std::vector<RecordingNote> markers_;
  std::set<std::string> bones_;
  std::set<std::string> unknown_bones_;
  std::uint64_t malformed_ = 0;
  std::vector<std::string> problems_;
};

}  // namespace vestige
