#include "analysis/plot/studio/subject.hpp"

#include <fmt/format.h>

#include <glm/vec2.hpp>
#include <utility>

#include "analysis/mapping/layouts.hpp"
#include "traces/gltf/avatar_gltf.hpp"
#include "traces/scene/builtin_avatar.hpp"
#include "traces/trace_file/trace_format.hpp"

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

Subject read_subject(const std::string& avatar, const std::string& map, std::string_view facing) {
  Subject subject;
  subject.title = avatar == kBuiltin ? "built-in avatar" : std::filesystem::path(avatar).filename().string();
  subject.avatar = parse_avatar_glb(read_builtin_or_file(avatar), avatar);
  const std::string chosen_map = map_or_default(map, avatar);
  const auto settle = [&] {
    for (std::string& warning : settle_facing(subject.avatar.facing, facing, subject.map.facing, avatar))
      subject.warnings.push_back(std::move(warning));
  };
  if (is_layout(chosen_map)) settle();
  subject.map = read_map(chosen_map, subject.avatar);
  if (!is_layout(chosen_map)) settle();
  if (const std::string other = other_facing(subject.avatar.facing, subject.map.facing, {avatar, chosen_map});
      !other.empty())
    subject.warnings.push_back(other + kOrSetFacing);
  return subject;
}

Subject read_subject(const TraceReader& trace, const std::filesystem::path& path, const std::string& map,
                     std::size_t person) {
  const RecordedPerson& recorded = trace.people()[person];
  const auto attachment = [&](trace_format::AttachmentKind kind) {
    return fmt::format("{}, {}", path.string(), trace_format::attachment_name(kind, person));
  };
  const std::string map_name = attachment(trace_format::AttachmentKind::kMapImage);
  Subject subject;
  subject.title = path.filename().string();
  subject.avatar = parse_avatar_glb(recorded.avatar_glb, attachment(trace_format::AttachmentKind::kAvatar));
  take_recorded_facing(subject.avatar.facing, recorded.facing);
  if (!map.empty())
    subject.map = read_map(map, subject.avatar);
  else if (!recorded.actuator_map_png.empty())
    subject.map = parse_actuator_map(actuator_map_files(recorded), subject.avatar, map_name);
  if (subject.avatar.facing.lies_deg)
    subject.warnings.push_back(fmt::format("{}: its avatar {}; its left and its front are not known", path.string(),
                                           describe_lying(subject.avatar.facing)));
  if (std::string other =
          other_facing(subject.avatar.facing, subject.map.facing, {path.string(), map.empty() ? map_name : map});
      !other.empty())
    subject.warnings.push_back(std::move(other));
  return subject;
}

}  // namespace vestige::plot
