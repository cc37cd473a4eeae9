#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <set>
#include <string>

#include "traces/mcap/record.hpp"
#include "traces/scene/trace.hpp"
#include "traces/viz/viz_bodies.hpp"

namespace vestige {

struct VizBuilder;

/// Encodes the messages of /viz/tf and /viz/scene. The result of a call is valid until the next call. Leaves out people
/// who are not there. Precondition of each call: the bodies have taken the frame.
class VizEncoder {
 public:
  /// Keeps a reference to `bodies`.
  explicit VizEncoder(const VizBodies& bodies);
  ~VizEncoder();
  VizEncoder(const VizEncoder&) = delete;
  VizEncoder& operator=(const VizEncoder&) = delete;

  /// Returns the transform of each avatar in `world`, and of every node in its parent, parents before children. Frames
  /// have no scale, so scale only affects positions. `upright` is at the root of the first person who is there when
  /// anybody first is; its z axis is the y axis of `world`.
  mcap::Bytes transforms(const TraceFrame& frame);
  /// Returns each skeleton as lines between its nodes, and each collider as a sphere of its size (a point: 2 cm wide)
  /// named by the collider's id; leaves out a collider with a number that is not finite. Deletes the skeletons and
  /// spheres of whoever has gone since the last message.
  mcap::Bytes scene(const TraceFrame& frame);

  /// Upper bound of the size of both messages together.
  std::uint64_t most_bytes(const TraceFrame& frame) const;

 private:
  std::unique_ptr<VizBuilder> builder_;
  const VizBodies& bodies_;
  std::optional<std::size_t> upright_;  ///< the person at whose root the frame `upright` is
  std::set<std::string> shown_;         ///< entities of the last message
};

}  // namespace vestige
