#pragma once

#include <cstdint>
#include <functional>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "traces/scene/avatar.hpp"
#include "traces/scene/colliders.hpp"
#include "traces/scene/stance.hpp"
#include "traces/scene/trace.hpp"

namespace vestige {

struct RecordingSettings {
  double rate_hz = 1000;
  double duration_s = 2;
  glm::dvec3 origin_m = glm::dvec3(0);  ///< world position of the whole scene; rounded to the grid of 2^-20 m
};

/// Returns the number of frames of a recording: rate times duration, rounded, at least 1.
std::uint64_t frame_count(const RecordingSettings& settings);

struct SampledPerson {
  const Avatar& avatar;
  const Animation* animation = nullptr;  ///< loops; null means the rest pose
  Stance stance = {};
};

/// A scene that frames are sampled from. The times requested from one `colliders` must not decrease.
struct SampledScene {
  std::span<const SampledPerson> people;
  ColliderSource& colliders;
  glm::dvec3 origin_m = glm::dvec3(0);
};

/// Returns in `out` poses and colliders at time index / rate.
void sample_frame(const SampledScene& scene, double rate_hz, std::uint64_t index, TraceFrame& out);

/// Receives a frame, which it may complete. Returns false if it accepts no more frames.
using FrameSink = std::function<bool(TraceFrame&)>;

/// Samples poses and colliders at the times k / rate and passes them to `write`. Calls `progress` with the fraction
/// done; it returns false to stop.
void record(const FrameSink& write, const std::vector<SampledPerson>& people, ColliderSource& colliders,
            const RecordingSettings& settings, const std::function<bool(double)>& progress);

}  // namespace vestige
