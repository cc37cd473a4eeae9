#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "traces/scene/avatar.hpp"
#include "traces/scene/colliders.hpp"
#include "traces/scene/trace.hpp"

namespace vestige {

/// An avatar and colliders as functions of time, to be sampled at any rate.
struct MovingScene {
  const Avatar& avatar;
  const Animation* animation = nullptr;                             ///< loops; null: the avatar rests
  std::function<std::unique_ptr<ColliderSource>()> make_colliders;  ///< each the same; called from several threads
  std::vector<std::uint32_t> collider_ids;                          ///< ascending
  double duration_s = 0;
};

/// Frames of a scene at a rate, from frame `first` on.
class SceneSampler {
 public:
  SceneSampler(const MovingScene& scene, double rate_hz, std::uint64_t first = 0)
      : scene_(scene), colliders_(scene.make_colliders()), rate_hz_(rate_hz), next_(first) {}

  /// Good until the next call.
  const TraceFrame& next();

 private:
  const MovingScene& scene_;
  std::unique_ptr<ColliderSource> colliders_;
  double rate_hz_;
  std::uint64_t next_;
  TraceFrame frame_;
};

/// The last frame of a scene at a rate: the last within its duration.
std::uint64_t last_frame_within(const MovingScene& scene, double rate_hz);

}  // namespace vestige
