#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "traces/live/vmc_skeleton.hpp"
#include "traces/scene/avatar.hpp"
#include "traces/scene/trace.hpp"

namespace vestige {

/// An encoded message of OSC.
using OscBytes = std::vector<std::byte>;

/// Says a pose by the VMC protocol (https://protocol.vmc.info): where the root is, then each bone, in single precision.
/// A `VmcState` of the same avatar then shows this pose, except for what the protocol does not say: the motion of nodes
/// that are neither a bone nor the skeleton's top, translations other than those of the hips and the top, and scales.
/// Precondition: the pose is finite, and has a node for each of the avatar's.
std::vector<OscBytes> pose_messages(const VmcSkeleton& skeleton, const Avatar& avatar, const Pose& pose);

/// Ends a frame: the time in seconds, and that the sender has an avatar.
std::vector<OscBytes> end_of_frame(double time_s);
/// Changes nothing in any receiver: the sender has no avatar yet.
OscBytes not_ready_message();

/// Says where a collider is, exactly. Precondition: its id has 31 bits.
OscBytes collider_message(const ColliderSample& collider);
OscBytes removal_message(std::uint32_t id);
OscBytes teleport_message(std::uint32_t id);

}  // namespace vestige
