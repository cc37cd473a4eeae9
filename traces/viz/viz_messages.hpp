#pragma once

#include <cstdint>
#include <memory>
#include <set>
#include <vector>

#include "traces/mcap/record.hpp"
#include "traces/scene/avatar.hpp"
#include "traces/scene/trace.hpp"
#include "traces/viz/viz_bodies.hpp"

namespace vestige {

struct VizBuilder;

/// Encodes the messages of /viz/tf and /viz/scene. The result of a call is valid until the next call. Leaves out a
/// person whose pose is missing.
class VizEncoder {
 public:
  /// As for `VizBodies`, which names the frames.
  explicit VizEncoder(const std::vector<const Avatar*>& avatars);
  ~VizEncoder();
  VizEncoder(const VizEncoder&) = delete;
  VizEncoder& operator=(const VizEncoder&) = delete;

  /// Returns the transform of each avatar in `world`, and of every node in its parent, parents before children. Frames
  /// have no scale, so scale only affects positions. `upright` is at the first person's root; its z axis is the y axis
  /// of `world`.
  mcap::Bytes transforms(const TraceFrame& frame);
  /// Returns each skeleton as lines between its nodes, and each collider as a sphere of its size (a point: 2 cm wide)
  /// named by the collider's id. Deletes the spheres of colliders that have gone since the last message.
  mcap::Bytes scene(const TraceFrame& frame);

  /// Upper bound of the size of both messages together.
  std::uint64_t most_bytes(const TraceFrame& frame) const;

 private:
  std::unique_ptr<VizBuilder> builder_;
  VizBodies bodies_;
  std::set<std::uint32_t> shown_;  ///< colliders of the last message
};

}  // namespace vestige
