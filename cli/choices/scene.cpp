#include "cli/choices/scene.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "analysis/mapping/body_surface.hpp"
#include "analysis/mapping/layouts.hpp"
#include "cli/options.hpp"
#include "traces/base/error.hpp"
#include "traces/files/input_file.hpp"
#include "traces/gltf/avatar_gltf.hpp"
#include "traces/scene/person_name.hpp"
#include "traces/scene/reference_skinning.hpp"
#include "traces/trace_file/trace_format.hpp"

namespace vestige::cli {

namespace {

using trace_format::AttachmentKind;

void warn_all(const std::vector<std::string>& warnings, Verbosity verbosity) {
  for (const std::string& warning : warnings) warn(warning, verbosity);
}

/// Throws `Error` as `require_surfaces`. `name` is the avatar's name.
void require_surface(const Avatar& avatar, const std::string& name) {
  constexpr double kPoint_m = 1e-6;
  const auto scales = [](const Animation& animation) {
    return std::ranges::find(animation.channels, AnimatedProperty::kScale, &AnimationChannel::property) !=
           animation.channels.end();
  };
  if (rest_box(avatar).longest_side() > kPoint_m || std::ranges::any_of(avatar.animations, scales)) return;
  throw Error(
      name, "its whole skin lies in one point at rest, so it has no surface to touch",
      "set the scale of its root node to 1 in the modelling program; an avatar that is hidden at times needs an "
      "animation of that scale");
}

Scene scene_of(std::vector<std::byte> avatar_glb, const std::string& name, Verbosity verbosity) {
  Scene scene;
  scene.avatar_glb = std::move(avatar_glb);
  scene.avatar = parse_avatar_glb(scene.avatar_glb, name);
  require_surface(scene.avatar, name);
  warn_all(scene.avatar.warnings, verbosity);
  return scene;
}

void give_map(Scene& scene, ActuatorMapFiles files, const SceneNames& names, Verbosity verbosity) {
  if (!files.png.empty()) scene.map = parse_actuator_map(files, scene.avatar, names.map);
  scene.map_png = std::move(files.png);
  scene.map_json = std::move(files.json);
  warn_all(scene.map.warnings, verbosity);
  if (!scene.map_png.empty() && scene.map.triangle_count == 0 && !has_texture_coordinates(scene.avatar))
    warn(fmt::format("{}: has no texture coordinates, so the map cannot tell its regions apart", names.avatar),
         verbosity);
  if (scene.map_png.empty())
    warn(fmt::format("{}: there is no actuator map (--map), so no contact will fire an actuator", names.avatar),
         verbosity);
}

/// Gives the scene its map, and settles the facing with what the map records.
void complete(Scene& scene, ActuatorMapFiles map, const SceneNames& names, const FacingChoice& choice,
              Verbosity verbosity) {
  give_map(scene, std::move(map), names, verbosity);
  AvatarFacing& facing = scene.avatar.facing;
  warn_all(vestige::settle_facing(facing, choice.axis, scene.map.facing, names.avatar), verbosity);
  if (const std::string other = other_facing(facing, scene.map.facing, names); !other.empty())
    warn(other + kOrSetFacing, verbosity);
}

/// Returns what errors call an attachment of a trace.
std::string attachment(const std::string& path, AttachmentKind kind, std::size_t person) {
  return fmt::format("{}, {}", path, trace_format::attachment_name(kind, person));
}

}  // namespace

Scene load_scene(const std::string& avatar, const std::string& map, const FacingChoice& facing, Verbosity verbosity,
                 const std::string& recorded_facing) {
  const SceneNames names = {avatar, map_or_default(map, avatar)};
  Scene scene = scene_of(read_builtin_or_file(avatar), avatar, verbosity);
  take_recorded_facing(scene.avatar.facing, recorded_facing);
  if (is_layout(names.map)) {
    settle_facing(scene.avatar, facing, avatar, verbosity);  // the layout follows it
    give_map(scene, read_map_files(scene.avatar, names.map), names, verbosity);
    return scene;
  }
  complete(scene, read_map_files(scene.avatar, names.map), names, facing, verbosity);
  return scene;
}

Scene make_scene(SceneFiles files, const SceneNames& names, const FacingChoice& facing, Verbosity verbosity) {
  Scene scene = scene_of(std::move(files.avatar_glb), names.avatar, verbosity);
  take_recorded_facing(scene.avatar.facing, files.facing);
  complete(scene, std::move(files.map), names, facing, verbosity);
  return scene;
}

std::vector<std::byte> load_avatar(const std::string& avatar) {
  std::vector<std::byte> glb = read_builtin_or_file(avatar);
  static_cast<void>(parse_avatar_glb(glb, avatar));
  return glb;
}

ActuatorMapFiles load_map(const std::string& map) {
  ActuatorMapFiles files = read_actuator_map_files(map);
  static_cast<void>(parse_actuator_map(files.png, files.json, map));
  return files;
}

OpenTrace::OpenTrace(const std::string& path, Verbosity verbosity, People allowed, std::size_t threads)
    : reader(path, allowed, threads) {
  const std::vector<RecordedPerson>& recorded = reader.people();
  std::vector<std::string> names;
  names.reserve(recorded.size());
  for (const RecordedPerson& person : recorded) names.push_back(person.name);
  names = names_of_people(names);
  people.reserve(recorded.size());
  for (std::size_t i = 0; i < recorded.size(); ++i) {
    people.push_back(
        {names[i], parse_avatar_glb(recorded[i].avatar_glb, attachment(path, AttachmentKind::kAvatar, i)), {}});
    auto& [name, avatar, map] = people.back();
    take_recorded_facing(avatar.facing, recorded[i].facing);
    if (!recorded[i].facing.empty() && !avatar.facing.doubt.empty())
      warn(fmt::format("{}: {}; {} is taken", path, avatar.facing.doubt, to_string(avatar.facing.axis)), verbosity);
    if (!recorded[i].actuator_map_png.empty())
      map = parse_actuator_map(actuator_map_files(recorded[i]), avatar, attachment(path, AttachmentKind::kMapImage, i));
    if (verbosity == Verbosity::kVerbose) warn_all(avatar.warnings, verbosity);
  }
  if (!reader.recovered().empty()) warn(fmt::format("{}: {}", path, reader.recovered()), verbosity);
}

void require_surfaces(const OpenTrace& trace, const std::string& file) {
  for (std::size_t i = 0; i < trace.people.size(); ++i)
    require_surface(trace.people[i].avatar, attachment(file, AttachmentKind::kAvatar, i));
}

std::string before_person(const OpenTrace& trace, std::size_t person) {
  return trace.people.size() == 1 ? "" : trace.people[person].name + ": ";
}

int report_damage(const TraceReader& trace, const std::string& path, Verbosity verbosity) {
  if (trace.complete()) return kDone;
  warn_all(damage_of(trace, path), verbosity);
  return kDataLost;
}

}  // namespace vestige::cli
