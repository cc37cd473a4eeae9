#include "analysis/stress/stress_scene.hpp"

#include <numeric>

#include "analysis/stress/loose_triangles.hpp"
#include "traces/gltf/avatar_gltf.hpp"
#include "traces/scene/builtin_avatar.hpp"

namespace vestige {

StressSubject make_subject(StressBody body) {
  StressSubject subject;
  if (body == StressBody::kLoose) {
    subject.avatar = loose_triangles(kFanTriangles);
    subject.map.width = kTexels;
    subject.map.height = kTexels;
    subject.map.actuator_count = kTexels * kTexels;
    subject.map.actuator.resize(kTexels * kTexels);
    std::iota(subject.map.actuator.begin(), subject.map.actuator.end(), std::uint16_t{1});
    return subject;
  }
  subject.avatar = parse_avatar_glb(builtin_avatar_glb(), "builtin");
  subject.map = parse_actuator_map(builtin_actuator_map_png(), builtin_actuator_map_json(), "builtin");
  return subject;
}

DetectorFrame frame_after(const TraceFrame& before, const TraceFrame& now, const Avatar& avatar, std::size_t columns,
                          Method method) {
  std::vector<std::uint32_t> ids(columns);
  std::iota(ids.begin(), ids.end(), 0U);
  FrameBuilder builder(avatar, ids, method);
  builder.next(before);
  return builder.next(now);
}

}  // namespace vestige
