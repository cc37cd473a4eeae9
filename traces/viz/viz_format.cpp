#include "traces/viz/viz_format.hpp"

#include "traces/base/embed.hpp"

VESTIGE_EMBED(vestige_schema_frame_transforms, VESTIGE_SCHEMA_DIR "/frame_transforms.bfbs");
VESTIGE_EMBED(vestige_schema_scene_update, VESTIGE_SCHEMA_DIR "/scene_update.bfbs");

namespace vestige::viz_format {

mcap::Schema transforms_schema() {
  return {.id = kTransformsId,
          .name = "foxglove.FrameTransforms",
          .encoding = kEncoding,
          .data = VESTIGE_EMBEDDED(vestige_schema_frame_transforms)};
}

mcap::Schema scene_schema() {
  return {.id = kSceneId,
          .name = "foxglove.SceneUpdate",
          .encoding = kEncoding,
          .data = VESTIGE_EMBEDDED(vestige_schema_scene_update)};
}

std::vector<mcap::Channel> channels() {
  return {{.id = kTransformsId,
           .schema_id = kTransformsId,
           .topic = kTransformsTopic,
           .message_encoding = kEncoding,
           .metadata = {}},
          {.id = kSceneId, .schema_id = kSceneId, .topic = kSceneTopic, .message_encoding = kEncoding, .metadata = {}}};
}

}  // namespace vestige::viz_format
