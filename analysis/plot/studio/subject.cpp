#include "analysis/plot/studio/subject.hpp"

#include <glm/vec2.hpp>

#include "analysis/mapping/layouts.hpp"
#include "traces/files/input_file.hpp"
#include "traces/gltf/avatar_gltf.hpp"
#include "traces/scene/builtin_avatar.hpp"

namespace vestige::plot {

ActuatorMap read_map(const std::string& map, const Avatar& avatar) {
  const ActuatorMapFiles files = read_map_files(avatar, map);
  return files.png.empty() ? ActuatorMap() : parse_actuator_map(files, avatar, map);
}

std::uint16_t actuator_at(const Avatar& avatar, const ActuatorMap& map, std::uint32_t triangle, double u, double v) {
  const glm::uvec3& corner = avatar.triangles[triangle];
  const auto& coordinates = avatar.texture_coordinate;
  return map.at(triangle, (1 - u - v) * glm::dvec2(coordinates[corner.x]) + u * glm::dvec2(coordinates[corner.y]) +
                              v * glm::dvec2(coordinates[corner.z]));
}

Subject read_subject(const std::string& avatar, const std::string& map) {
  const bool is_builtin = avatar == "builtin";
  Subject subject;
  subject.title = is_builtin ? "built-in avatar" : std::filesystem::path(avatar).filename().string();
  subject.avatar = parse_avatar_glb(is_builtin ? builtin_avatar_glb() : read_avatar_glb(avatar), avatar);
  subject.map = read_map(!map.empty() ? map : is_builtin ? "builtin" : "none", subject.avatar);
  if (subject.map.facing) set_facing(subject.avatar.facing, *subject.map.facing, AvatarFacing::By::kMap);
  return subject;
}

Subject read_subject(const TraceReader& trace, const std::filesystem::path& path, const std::string& map) {
  Subject subject;
  subject.title = path.filename().string();
  subject.avatar = parse_avatar_glb(trace.avatar_glb(), path.string() + ", avatar.glb");
  take_recorded_facing(subject.avatar.facing, trace.facing());
  if (!map.empty())
    subject.map = read_map(map, subject.avatar);
  else if (!trace.actuator_map_png().empty())
    subject.map = parse_actuator_map(actuator_map_files(trace), subject.avatar, path.string() + ", actuator_map.png");
  return subject;
}

}  // namespace vestige::plot
