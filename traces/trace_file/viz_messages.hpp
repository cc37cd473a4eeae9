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

/// The messages that viewers draw: foxglove.FrameTransforms on /viz/tf and foxglove.SceneUpdate on /viz/scene
/// (traces/FORMAT.md). Readers of traces ignore them.
namespace viz_format {
inline constexpr std::uint16_t kTransformsId = 16;
inline constexpr std::uint16_t kSceneId = 17;
inline constexpr const char* kTransformsTopic = "/viz/tf";
inline constexpr const char* kSceneTopic = "/viz/scene";
inline constexpr double kRate_hz = 60;

std::vector<mcap::Schema> schemas();
std::vector<mcap::Channel> channels();
}  // namespace viz_format

/// Encodes these messages. The result of a call is valid until the next call.
class VizEncoder {
 public:
  /// Copies the names and the trees of the avatars' nodes, one avatar for each person.
  explicit VizEncoder(const std::vector<const Avatar*>& avatars);
  ~VizEncoder();
  VizEncoder(const VizEncoder&) = delete;
  VizEncoder& operator=(const VizEncoder&) = delete;

  /// Returns the transform of each avatar in `world`, and of every node in its parent, parents before children. Frames
  /// have the names of the nodes; with a later person, its number stands before them: "2/hips". A frame gets its number
  /// appended if its node has no name or shares its name with another frame. Frames have no scale, so scale only
  /// affects positions.
  mcap::Bytes transforms(const TraceFrame& frame);
  /// Returns each skeleton as lines between its nodes, and each collider as a sphere of its size (a point: 2 cm wide)
  /// named by the collider's id. Deletes the spheres of colliders that have gone since the last message.
  mcap::Bytes scene(const TraceFrame& frame);

  /// Upper bound of the size of both messages together.
  std::uint64_t most_bytes(const TraceFrame& frame) const;

 private:
  struct Builder;
  /// A person's nodes.
  struct Body {
    Avatar skeleton;  ///< only its nodes and their order
    std::string frame;
    std::string entity;
    std::vector<std::string> frames;  ///< of the nodes
    std::vector<glm::dmat4> world;
  };

  std::unique_ptr<Builder> builder_;
  std::vector<Body> bodies_;
  std::set<std::uint32_t> shown_;  ///< colliders of the last message
  std::uint64_t name_bytes_ = 0;
  std::uint64_t frame_count_ = 0;
};

}  // namespace vestige
