#include "analysis/accuracy/moving_scene.hpp"

#include <cmath>

#include "traces/recording/sampled_scene.hpp"

namespace vestige {

const TraceFrame& SceneSampler::next() {
  const SampledPerson person = {scene_.avatar, scene_.animation};
  sample_frame({{&person, 1}, *colliders_}, rate_hz_, next_++, frame_);
  return frame_;
}

std::uint64_t last_frame_within(const MovingScene& scene, double rate_hz) {
  // 0.1 s at 90 Hz must give 9 frames, however the product is rounded.
  constexpr double kSlack = 1e-6;
  return static_cast<std::uint64_t>(std::floor(scene.duration_s * rate_hz + kSlack));
}

}  // namespace vestige
