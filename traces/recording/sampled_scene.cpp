#include "traces/recording/sampled_scene.hpp"

#include <algorithm>
#include <cmath>

#include "traces/scenarios/body.hpp"

namespace vestige {

std::uint64_t frame_count(const RecordingSettings& settings) {
  return static_cast<std::uint64_t>(std::max(1.0, std::round(settings.rate_hz * settings.duration_s)));
}

void sample_frame(const SampledScene& scene, double rate_hz, std::uint64_t index, TraceFrame& out) {
  const double time_s = static_cast<double>(index) / rate_hz;
  out.index = index;
  out.time_ns = std::llround(time_s * 1e9);
  out.pose = looped_pose(scene.avatar, scene.animation, time_s);
  out.pose.origin_m = scene.origin_m;
  scene.colliders.sample(time_s, out.colliders);
  out.teleported = scene.colliders.teleported();
  for (ColliderSample& sample : out.colliders) sample.position_m += scene.origin_m;
}

void record(const FrameSink& write, const Avatar& avatar, const Animation* animation, ColliderSource& colliders,
            const RecordingSettings& settings, const std::function<bool(double)>& progress) {
  const std::uint64_t frames = frame_count(settings);
  const SampledScene scene = {avatar, animation, colliders, on_grid(settings.origin_m)};
  TraceFrame frame;
  for (std::uint64_t index = 0; index < frames; ++index) {
    sample_frame(scene, settings.rate_hz, index, frame);
    if (!write(frame)) return;
    if (!progress(static_cast<double>(index + 1) / static_cast<double>(frames))) return;
  }
}

}  // namespace vestige
