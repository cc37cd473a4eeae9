#pragma once

#include <cstdint>
#include <vector>

#include "traces/mcap/record.hpp"

/// The messages that viewers draw: foxglove.FrameTransforms on /viz/tf and foxglove.SceneUpdate on /viz/scene
/// (traces/FORMAT.md). Readers of traces ignore them.
namespace vestige::viz_format {

inline constexpr std::uint16_t kTransformsId = 16;
inline constexpr std::uint16_t kSceneId = 17;
inline constexpr const char* kTransformsTopic = "/viz/tf";
inline constexpr const char* kSceneTopic = "/viz/scene";
inline constexpr const char* kEncoding = "flatbuffer";  ///< of schemas and of messages
inline constexpr double kRate_hz = 60;

inline constexpr const char* kWorld = "world";      ///< the frame of the trace's coordinates
inline constexpr const char* kUpright = "upright";  ///< a frame whose z axis is the trace's y axis, as viewers want it

mcap::Schema transforms_schema();
mcap::Schema scene_schema();
/// Returns the channels of both topics. A channel has the id of its schema.
std::vector<mcap::Channel> channels();

}  // namespace vestige::viz_format
