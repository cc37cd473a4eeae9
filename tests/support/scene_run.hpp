#pragma once

#include <cmath>
#include <cstdint>
#include <numeric>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "detector/detector.hpp"
#include "detector/frame.hpp"
#include "detector/output/texture_hash.hpp"
#include "traces/scenarios/scenarios.hpp"
#include "traces/scene/avatar.hpp"
#include "traces/scene/colliders.hpp"
#include "traces/scene/trace.hpp"

namespace vestige::test {

/// Returns `frames` frames of a built-in scenario around `avatar`, which plays its first animation. Everything is
/// shifted by `origin_m`.
inline std::vector<TraceFrame> scene(std::string_view scenario, const Avatar& avatar, std::uint32_t colliders,
                                     int frames, double rate_hz, const glm::dvec3& origin_m = glm::dvec3(0)) {
  const Animation* animation = avatar.animations.empty() ? nullptr : &avatar.animations.front();
  const auto source = find_scenario(scenario)->make(avatar, animation, {colliders, 1});
  std::vector<TraceFrame> scene(static_cast<std::size_t>(frames));
  for (std::size_t k = 0; k < scene.size(); ++k) {
    const double time_s = static_cast<double>(k) / rate_hz;
    TraceFrame& frame = scene[k];
    frame.index = k;
    frame.time_ns = std::llround(time_s * 1e9);
    frame.poses.front() = looped_pose(avatar, animation, time_s);
    frame.poses.front().origin_m += origin_m;
    source->sample(time_s, frame.colliders);
    for (ColliderSample& collider : frame.colliders) collider.position_m += origin_m;
    frame.teleported = source->teleported();
  }
  return scene;
}

/// The result of a run of frames through one detector.
struct SceneRun {
  std::vector<ContactRow> rows;  ///< one for each frame
  std::uint64_t non_finite_frames = 0;
  std::uint64_t non_finite_segments = 0;
  std::optional<std::uint64_t> first_non_finite;

  std::size_t contacts_in(std::size_t frame) const { return rows[frame].hits(); }
  std::size_t contacts() const {
    std::size_t sum = 0;
    for (std::size_t frame = 0; frame < rows.size(); ++frame) sum += contacts_in(frame);
    return sum;
  }
};

inline std::string hash_of(const SceneRun& run) {
  TextureHash hash;
  for (const ContactRow& row : run.rows) hash.add(row);
  return hash.hex();
}

/// Returns a frame builder for a scene with this number of colliders.
inline FrameBuilder frame_builder(const Avatar& avatar, std::uint32_t colliders, Method method) {
  std::vector<std::uint32_t> ids(colliders);
  std::iota(ids.begin(), ids.end(), 0U);
  return {avatar, ids, method};
}

inline SceneRun run_scene(const std::vector<TraceFrame>& scene, const Avatar& avatar, std::uint32_t colliders,
                          Detector& detector) {
  FrameBuilder builder = frame_builder(avatar, colliders, detector.method());
  SceneRun run;
  run.rows.resize(scene.size());
  for (std::size_t k = 0; k < scene.size(); ++k) detector.detect(builder.next(scene[k]), run.rows[k]);
  run.non_finite_frames = builder.non_finite_frames();
  run.non_finite_segments = builder.non_finite_segments();
  run.first_non_finite = builder.first_non_finite();
  return run;
}

}  // namespace vestige::test
