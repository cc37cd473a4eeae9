#include "cli/scene.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <string_view>

#include "cli/options.hpp"
#include "traces/avatar_gltf.hpp"
#include "traces/builtin_avatar.hpp"
#include "traces/error.hpp"
#include "traces/input_file.hpp"

namespace vestige::cli {

namespace {

std::string_view text_of(std::span<const std::byte> bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

void warn_all(const std::vector<std::string>& warnings, Verbosity verbosity) {
  for (const std::string& warning : warnings) warn(warning, verbosity);
}

void load_map(const std::string& map, Scene& scene) {
  if (map == "none") return;
  if (map == "builtin") {
    scene.map_png = builtin_actuator_map_png();
    scene.map_json = builtin_actuator_map_json();
  } else {
    scene.map_png = read_file(map);
    const auto sidecar = std::filesystem::path(map).replace_extension(".json");
    if (std::filesystem::exists(sidecar)) scene.map_json = read_text_file(sidecar);
  }
  scene.map = parse_actuator_map(scene.map_png, scene.map_json, map);
}

}  // namespace

Scene load_scene(const std::string& avatar, const std::string& map, Verbosity verbosity) {
  Scene scene;
  scene.avatar_glb = avatar == "builtin" ? builtin_avatar_glb() : read_avatar_glb(avatar);
  scene.avatar = parse_avatar_glb(scene.avatar_glb, avatar);
  warn_all(scene.avatar.warnings, verbosity);
  const std::string default_map = avatar == "builtin" ? "builtin" : "none";
  load_map(map.empty() ? default_map : map, scene);
  warn_all(scene.map.warnings, verbosity);
  const auto& coordinates = scene.avatar.texture_coordinate;
  if (!scene.map_png.empty() && std::ranges::count(coordinates, coordinates.front()) == std::ssize(coordinates))
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
  warn_all(trace.warnings(), verbosity);
  if (trace.warnings().empty()) warn(fmt::format("{}: is not complete", path), verbosity);
  return kDataLost;
}

}  // namespace vestige::cli
