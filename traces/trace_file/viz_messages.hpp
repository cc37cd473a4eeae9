#pragma once

#include <cstdint>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "traces/mcap/record.hpp"
#include "traces/scene/avatar.hpp"
#include "traces/scene/trace.hpp"

namespace vestige {

/// What viewers draw of a trace: foxglove.FrameTransforms on /viz/tf, foxglove.SceneUpdate on /viz/scene
/// (traces/FORMAT.md). Readers of traces pass them over.
namespace viz_format {
inline constexpr std::uint16_t kTransformsId = 16;
inline constexpr std::uint16_t kSceneId = 17;
inline constexpr const char* kTransformsTopic = "/viz/tf";
inline constexpr const char* kSceneTopic = "/viz/scene";
inline constexpr double kRate_hz = 60;

std::vector<mcap::Schema> schemas();
std::vector<mcap::Channel> channels();
}  // namespace viz_format

/// Makes those messages. What each call returns is valid until the next.
class VizEncoder {
 public:
  /// Names and tree of the avatar's nodes are copied.
  explicit VizEncoder(const Avatar& avatar);
  ~VizEncoder();
  VizEncoder(const VizEncoder&) = delete;
  VizEncoder& operator=(const VizEncoder&) = delete;

  /// Where the avatar stands in `world`, and every node in its parent; parents before children. Frames are named like
  /// the nodes; one without a name, or with that of another, gets its number added. Scale moves what it must: a frame
  /// has none.
  mcap::Bytes transforms(const TraceFrame& frame);
  /// The skeleton as lines between its nodes, and a sphere named by its id for every collider; those of the message
  /// before that are gone are deleted.
  mcap::Bytes scene(const TraceFrame& frame);

  /// More than both messages take.
  std::uint64_t most_bytes(const TraceFrame& frame) const;

 private:
  struct Builder;
  void place_nodes(const TraceFrame& frame);

  std::unique_ptr<Builder> builder_;
  Avatar skeleton_;  ///< nodes and their order only
  std::vector<std::string> frames_;
  std::vector<glm::dmat4> world_;
  std::set<std::uint32_t> shown_;  ///< colliders of the last message
  std::uint64_t name_bytes_ = 0;
};

}  // namespace vestige
