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
#include "traces/scene/builtin_avatar.hpp"
#include "traces/scene/reference_skinning.hpp"

namespace vestige::cli {

namespace {

void warn_all(const std::vector<std::string>& warnings, Verbosity verbosity) {
  for (const std::string& warning : warnings) warn(warning, verbosity);
}

std::vector<std::byte> read_avatar(const std::string& avatar) {
  return avatar == "builtin" ? builtin_avatar_glb() : read_avatar_glb(avatar);
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
  if (scene.map_png.empty()) warn("there is no actuator map (--map), so no contact will fire an actuator", verbosity);
}

}  // namespace

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

void add_facing_option(CLI::App& verb, FacingChoice& choice) {
  std::vector<std::string> axes(kFacingNames.begin(), kFacingNames.end());
  axes.emplace_back("auto");
  verb.add_option("--facing", choice.axis,
                  "Which way the avatar faces at rest: auto finds it by its joints' names, its feet or VRM; it decides "
                  "what is left and what is front")
      ->capture_default_str()
      ->check(CLI::IsMember(axes));
}

std::string_view in_words(AvatarFacing::By by) {
  switch (by) {
    case AvatarFacing::By::kSides:
      return "by its left and right joints";
    case AvatarFacing::By::kFeet:
      return "by its feet";
    case AvatarFacing::By::kVrm:
      return "by its version of VRM";
    case AvatarFacing::By::kMap:
      return "by its map";
    case AvatarFacing::By::kTrace:
      return "by the trace";
    case AvatarFacing::By::kAsked:
      return "as asked";
    case AvatarFacing::By::kAssumed:
      break;
  }
  return "since nothing tells";
}

void settle_facing(Avatar& avatar, const FacingChoice& choice, const std::string& name, Verbosity verbosity) {
  if (const auto axis = facing_named(choice.axis)) {
    if (avatar.facing.by == AvatarFacing::By::kSides && avatar.facing.axis != *axis)
      warn(fmt::format("{}: its left and right joints say that it faces {}; {} is taken, as asked", name,
                       to_string(avatar.facing.axis), choice.axis),
           verbosity);
    set_facing(avatar.facing, *axis, AvatarFacing::By::kAsked);
  }
  if (avatar.facing.lies_deg)
    warn(fmt::format("{}: {}; its left and its front are not known", name, describe_lying(avatar.facing)), verbosity);
  if (avatar.facing.doubt.empty()) return;
  warn(fmt::format("{}: {}; {} is taken; --facing sets it", name, avatar.facing.doubt, to_string(avatar.facing.axis)),
       verbosity);
  avatar.facing.doubt.clear();  // said once
}

namespace {

/// Settles the facing with what the map of the scene records.
void settle_facing(Scene& scene, const FacingChoice& choice, const SceneNames& names, Verbosity verbosity) {
  const auto& of_map = scene.map.facing;
  if (of_map && scene.avatar.facing.by == AvatarFacing::By::kAssumed)
    set_facing(scene.avatar.facing, *of_map, AvatarFacing::By::kMap);
  settle_facing(scene.avatar, choice, names.avatar, verbosity);
  const Facing axis = scene.avatar.facing.axis;
  if (of_map && *of_map != axis)
    warn(fmt::format("{}: was made for an avatar that faces {}, and {} faces {}, {}; make it anew, or set --facing",
                     names.map, to_string(*of_map), names.avatar, to_string(axis), in_words(scene.avatar.facing.by)),
         verbosity);
}

}  // namespace

Scene load_scene(const std::string& avatar, const std::string& map, const FacingChoice& facing, Verbosity verbosity) {
  const std::string default_map = avatar == "builtin" ? "builtin" : "none";
  const std::string& chosen_map = map.empty() ? default_map : map;
  Scene scene = scene_of(read_avatar(avatar), avatar, verbosity);
  if (is_layout(chosen_map)) settle_facing(scene.avatar, facing, avatar, verbosity);
  give_map(scene, read_map_files(scene.avatar, chosen_map), {avatar, chosen_map}, verbosity);
  settle_facing(scene, facing, {avatar, chosen_map}, verbosity);
  return scene;
}

Scene make_scene(SceneFiles files, const SceneNames& names, const FacingChoice& facing, Verbosity verbosity) {
  Scene scene = scene_of(std::move(files.avatar_glb), names.avatar, verbosity);
  take_recorded_facing(scene.avatar.facing, files.facing);
  give_map(scene, std::move(files.map), names, verbosity);
  settle_facing(scene, facing, names, verbosity);
  return scene;
}

std::vector<std::byte> load_avatar(const std::string& avatar) {
  std::vector<std::byte> glb = read_avatar(avatar);
  static_cast<void>(parse_avatar_glb(glb, avatar));
  return glb;
}

ActuatorMapFiles load_map(const std::string& map) {
  ActuatorMapFiles files = read_actuator_map_files(map);
  static_cast<void>(parse_actuator_map(files.png, files.json, map));
  return files;
}

OpenTrace::OpenTrace(const std::string& path, Verbosity verbosity)
    : reader(path), avatar(parse_avatar_glb(reader.avatar_glb(), path + ", avatar.glb")) {
  take_recorded_facing(avatar.facing, reader.facing());
  if (!reader.facing().empty() && !avatar.facing.doubt.empty())
    warn(fmt::format("{}: {}; {} is taken", path, avatar.facing.doubt, to_string(avatar.facing.axis)), verbosity);
  if (!reader.actuator_map_png().empty())
    map = parse_actuator_map(actuator_map_files(reader), avatar, path + ", actuator_map.png");
  if (!reader.recovered().empty()) warn(fmt::format("{}: {}", path, reader.recovered()), verbosity);
  if (verbosity == Verbosity::kVerbose) warn_all(avatar.warnings, verbosity);
}

int report_damage(const TraceReader& trace, const std::string& path, Verbosity verbosity) {
  if (trace.complete()) return kDone;
  warn_all(damage_of(trace, path), verbosity);
  return kDataLost;
}

}  // namespace vestige::cli
