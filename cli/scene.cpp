#include "cli/scene.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "analysis/mapping/body_surface.hpp"
#include "analysis/mapping/layouts.hpp"
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
  Scene scene;
  scene.avatar_glb = avatar == "builtin" ? builtin_avatar_glb() : read_avatar_glb(avatar);
  scene.avatar = parse_avatar_glb(scene.avatar_glb, avatar);
  warn_all(scene.avatar.warnings, verbosity);
  const std::string default_map = avatar == "builtin" ? "builtin" : "none";
  const std::string& chosen_map = map.empty() ? default_map : map;
  ActuatorMapFiles files = read_map_files(scene.avatar, chosen_map);
  if (!files.png.empty()) scene.map = parse_actuator_map(files.png, files.json, chosen_map);
  scene.map_png = std::move(files.png);
  scene.map_json = std::move(files.json);
  warn_all(scene.map.warnings, verbosity);
  if (!scene.map_png.empty() && !has_texture_coordinates(scene.avatar))
    warn(fmt::format("{}: has no texture coordinates, so the map cannot tell its regions apart", avatar), verbosity);
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
