#include "traces/recording/sampled_scene.hpp"

#include <algorithm>
#include <cmath>

#include "traces/places/body.hpp"

namespace vestige {

std::uint64_t frame_count(const RecordingSettings& settings) {
  return static_cast<std::uint64_t>(std::max(1.0, std::round(settings.rate_hz * settings.duration_s)));
}

void sample_frame(const SampledScene& scene, double rate_hz, std::uint64_t index, TraceFrame& out) {
  const double time_s = static_cast<double>(index) / rate_hz;
  out.index = index;
  out.time_ns = std::llround(time_s * 1e9);
  out.poses.resize(scene.people.size());
  for (std::size_t k = 0; k < scene.people.size(); ++k) {
    const SampledPerson& person = scene.people[k];
    out.poses[k] = looped_pose(person.avatar, person.animation, time_s);
    out.poses[k].origin_m = scene.origin_m;
    move_to(person.stance, person.avatar, out.poses[k]);
  }
  scene.colliders.sample(time_s, out.colliders);
  out.teleported = scene.colliders.teleported();
  for (ColliderSample& sample : out.colliders) sample.position_m += scene.origin_m;
}

void record(const FrameSink& write, const std::vector<SampledPerson>& people, ColliderSource& colliders,
            const RecordingSettings& settings, const std::function<bool(double)>& progress) {
  const std::uint64_t frames = frame_count(settings);
  const SampledScene scene = {people, colliders, on_grid(settings.origin_m)};
  TraceFrame frame;
  for (std::uint64_t index = 0; index < frames; ++index) {
    sample_frame(scene, settings.rate_hz, index, frame);
    if (!write(frame)) return;
    if (!progress(static_cast<double>(index + 1) / static_cast<double>(frames))) return;
  }
}

}  // namespace vestige
