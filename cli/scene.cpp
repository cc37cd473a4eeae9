#include "cli/scene.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "cli/options.hpp"
#include "traces/avatar_gltf.hpp"
#include "traces/builtin_avatar.hpp"
#include "traces/error.hpp"
#include "traces/input_file.hpp"

namespace vestige::cli {

namespace {

void warn_all(const std::vector<std::string>& warnings, Verbosity verbosity) {
  for (const std::string& warning : warnings) warn(warning, verbosity);
}

}  // namespace

Scene load_scene(const std::string& avatar, const std::string& map, Verbosity verbosity) {
  const std::string default_map = avatar == "builtin" ? "builtin" : "none";
  std::vector<std::byte> avatar_glb = avatar == "builtin" ? builtin_avatar_glb() : read_avatar_glb(avatar);
  const std::string& chosen_map = map.empty() ? default_map : map;
  ActuatorMapFiles files = read_actuator_map_files(chosen_map);
  return make_scene(std::move(avatar_glb), std::move(files.png), std::move(files.json), {avatar, chosen_map},
                    verbosity);
}

Scene make_scene(std::vector<std::byte> avatar_glb, std::vector<std::byte> map_png, std::string map_json,
                 const SceneNames& names, Verbosity verbosity) {
  Scene scene;
  scene.avatar_glb = std::move(avatar_glb);
  scene.avatar = parse_avatar_glb(scene.avatar_glb, names.avatar);
  warn_all(scene.avatar.warnings, verbosity);
  if (!map_png.empty()) scene.map = parse_actuator_map(map_png, map_json, names.map);
  scene.map_png = std::move(map_png);
  scene.map_json = std::move(map_json);
  warn_all(scene.map.warnings, verbosity);
  const auto& coordinates = scene.avatar.texture_coordinate;
  if (!scene.map_png.empty() && std::ranges::count(coordinates, coordinates.front()) == std::ssize(coordinates))
    warn(fmt::format("{}: has no texture coordinates, so the map cannot tell its regions apart", names.avatar),
         verbosity);
  if (scene.map_png.empty()) warn("there is no actuator map (--map), so no contact will fire an actuator", verbosity);
  return scene;
}

OpenTrace::OpenTrace(const std::string& path, Verbosity verbosity)
    : reader(path), avatar(parse_avatar_glb(reader.avatar_glb(), path + ", avatar.glb")) {
  if (!reader.actuator_map_png().empty())
    map =
        parse_actuator_map(reader.actuator_map_png(), text_of(reader.actuator_map_json()), path + ", actuator_map.png");
  if (verbosity == Verbosity::kVerbose) warn_all(avatar.warnings, verbosity);
}

int report_damage(const TraceReader& trace, const std::string& path, Verbosity verbosity) {
  if (trace.complete()) return kDone;
  warn_all(damage_of(trace, path), verbosity);
  return kDataLost;
}

}  // namespace vestige::cli
