#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "traces/scene/avatar.hpp"
#include "traces/scene/colliders.hpp"
#include "traces/scene/trace.hpp"

namespace vestige {

/// An avatar and colliders as functions of time. They can be sampled at any rate.
struct MovingScene {
  const Avatar& avatar;
  const Animation* animation = nullptr;  ///< loops; null: the avatar stays in its rest pose
  /// Each call returns the same colliders. Several threads call it at a time.
  std::function<std::unique_ptr<ColliderSource>()> make_colliders;
  std::vector<std::uint32_t> collider_ids;  ///< ascending
  double duration_s = 0;
  std::vector<bool> is_sphere;  ///< by rank: whether the collider has a radius at some time

  bool has_spheres() const { return std::ranges::find(is_sphere, true) != is_sphere.end(); }
};

/// Samples a scene at a rate, beginning with frame `first`.
class SceneSampler {
 public:
  SceneSampler(const MovingScene& scene, double rate_hz, std::uint64_t first = 0)
      : scene_(scene), colliders_(scene.make_colliders()), rate_hz_(rate_hz), next_(first) {}

  /// Returns the next frame. The reference is valid until the next call.
  const TraceFrame& next();

 private:
  const MovingScene& scene_;
  std::unique_ptr<ColliderSource> colliders_;
  double rate_hz_;
  std::uint64_t next_;
  TraceFrame frame_;
};

/// Returns the index of the last frame that lies within the scene's duration, sampled at `rate_hz`.
std::uint64_t last_frame_within(const MovingScene& scene, double rate_hz);

}  // namespace vestige
