#pragma once

#include <cstdint>
#include <functional>
#include <glm/vec3.hpp>

#include "traces/scene/avatar.hpp"
#include "traces/scene/colliders.hpp"
#include "traces/scene/trace.hpp"

namespace vestige {

struct RecordingSettings {
  double rate_hz = 1000;
  double duration_s = 2;
  glm::dvec3 origin_m = glm::dvec3(0);  ///< where the whole scene stands; rounded to the grid of 2^-20 m
};

/// How many frames a recording has: rate times duration, rounded, at least 1.
std::uint64_t frame_count(const RecordingSettings& settings);

/// What frames are sampled from. Times asked of one `colliders` must not decrease.
struct SampledScene {
  const Avatar& avatar;
  const Animation* animation;  ///< loops; null: the avatar rests
  ColliderSource& colliders;
  glm::dvec3 origin_m = glm::dvec3(0);
};

/// Pose and colliders at index / rate.
void sample_frame(const SampledScene& scene, double rate_hz, std::uint64_t index, TraceFrame& out);

/// Where frames go; false: it takes no more.
using FrameSink = std::function<bool(const TraceFrame&)>;

/// Samples pose and colliders at k / rate and writes them. The animation (null: the avatar rests) loops. `progress` is
/// told the share done and returns false to stop.
void record(const FrameSink& write, const Avatar& avatar, const Animation* animation, ColliderSource& colliders,
            const RecordingSettings& settings, const std::function<bool(double)>& progress);

}  // namespace vestige
