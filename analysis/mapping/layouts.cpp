#include "analysis/mapping/layouts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <system_error>

#include "analysis/mapping/map_maker.hpp"
#include "traces/base/error.hpp"
#include "traces/scene/builtin_avatar.hpp"

namespace vestige {

namespace {

struct Layout {
  std::string_view name;
  std::string_view summary;
  std::string_view regions;
  EmptyRegions empty;
};

/// Of a layout's skin: borders are no finer than texels.
constexpr double kTolerablyMisplaced = 0.05;
/// A texture that shows more skin than this tells little apart, and takes minutes to draw.
constexpr double kMostLayers = 4;

constexpr std::array kLayouts = {Layout{"paper6", "three heights of the torso, right and left", R"({
  "regions": [
    {"name": "torso", "part": "vest", "angle": [-180, 180],
     "grid": {"rows": 3, "columns": 2,
              "names": ["upper torso, right", "upper torso, left",
                        "middle torso, right", "middle torso, left",
                        "lower torso, right", "lower torso, left"]}}
  ]
}
)",
                                        EmptyRegions::kRefuse},
                                 Layout{"torso16", "two rings of eight around the torso", R"({
  "regions": [
    {"name": "torso", "part": "vest", "angle": [-180, 180],
     "grid": {"rows": 2, "columns": 8,
              "names": ["upper back right", "upper side right, behind", "upper side right, in front", "chest right",
                        "chest left", "upper side left, in front", "upper side left, behind", "upper back left",
                        "lower back right", "lower side right, behind", "lower side right, in front", "belly right",
                        "belly left", "lower side left, in front", "lower side left, behind", "lower back left"]}}
  ]
}
)",
                                        EmptyRegions::kRefuse},
                                 Layout{"torso40", "five rows of four on the front of the torso, five on its back", R"({
  "regions": [
    {"name": "front", "part": "vest", "side": "front", "grid": {"rows": 5, "columns": 4}},
    {"name": "back", "part": "vest", "side": "back", "grid": {"rows": 5, "columns": 4}}
  ]
}
)",
                                        EmptyRegions::kRefuse},
                                 Layout{"body", "the whole body: head, eight on the torso, and three on each limb", R"({
  "regions": [
    {"name": "head", "part": ["head", "neck"]},
    {"name": "torso, front", "part": "torso", "side": "front",
     "grid": {"rows": 2, "columns": 2, "names": ["chest right", "chest left", "belly right", "belly left"]}},
    {"name": "torso, back", "part": "torso", "side": "back",
     "grid": {"rows": 2, "columns": 2,
              "names": ["upper back left", "upper back right", "lower back left", "lower back right"]}},
    {"name": "upper arm right", "part": "upper arm right"},
    {"name": "upper arm left", "part": "upper arm left"},
    {"name": "forearm right", "part": "forearm right"},
    {"name": "forearm left", "part": "forearm left"},
    {"name": "hand right", "part": "hand right"},
    {"name": "hand left", "part": "hand left"},
    {"name": "thigh right", "part": "thigh right"},
    {"name": "thigh left", "part": "thigh left"},
    {"name": "shin right", "part": "shin right"},
    {"name": "shin left", "part": "shin left"},
    {"name": "foot right", "part": "foot right"},
    {"name": "foot left", "part": "foot left"}
  ]
}
)",
                                        EmptyRegions::kLeaveOut}};

const Layout& find_layout(std::string_view name) {
  const auto* found = std::ranges::find(kLayouts, name, &Layout::name);
  if (found == kLayouts.end())
    throw Error(name, "there is no such layout", fmt::format("there are: {}", fmt::join(layout_names(), ", ")));
  return *found;
}

/// Returns whether `map`, which is not a layout, looks like the name of one: it is no path, no file, and not what
/// `read_actuator_map_files` knows by name.
bool is_unknown_name(const std::string& map) {
  if (map == kBuiltin || map == "none" || map == "-" || map.find_first_of("./") != std::string::npos) return false;
  std::error_code ignored;
  return !std::filesystem::exists(map, ignored);
}

}  // namespace

std::vector<std::string> layout_names() {
  std::vector<std::string> names;
  names.reserve(kLayouts.size());
  for (const Layout& layout : kLayouts) names.emplace_back(layout.name);
  return names;
}

std::string layout_summary(std::string_view layout) {
  return std::string(find_layout(layout).summary);
}

std::string layout_list() {
  std::string list;
  for (const Layout& layout : kLayouts) list += fmt::format("\n  {:<8} {}", layout.name, layout.summary);
  return list;
}

bool is_layout(std::string_view map) {
  return std::ranges::find(kLayouts, map, &Layout::name) != kLayouts.end();
}

std::string layout_regions_json(std::string_view layout) {
  return std::string(find_layout(layout).regions);
}

EmptyRegions layout_empty_regions(std::string_view layout) {
  return find_layout(layout).empty;
}

MadeMap make_layout_map(const Avatar& avatar, std::string_view layout, const WorkProgress& progress) {
  const Layout& found = find_layout(layout);
  const Body body(avatar);
  const RegionPlan plan(body, parse_region_file(found.regions, layout), layout);
  MapSettings settings;
  settings.empty = found.empty;
  settings.progress = progress;
  const double layers = texture_layers(body.surface());
  if (layers > kMostLayers) {
    settings.per_triangle = true;
    MadeMap by_triangle = make_map(body, plan, settings, layout, "the avatar");
    by_triangle.warnings.push_back(
        fmt::format("the avatar's texture coordinates cannot tell its skin apart: they cover the texture {:.0f} times "
                    "over, so the map gives each triangle an actuator instead",
                    layers));
    return by_triangle;
  }
  settings.per_triangle = !has_texture_coordinates(avatar);
  MadeMap map = make_map(body, plan, settings, layout, "the avatar");
  const double misplaced = map.misplaced_share;
  if (misplaced <= kTolerablyMisplaced) return map;
  settings.per_triangle = true;
  settings.empty = EmptyRegions::kLeaveOut;
  MadeMap by_triangle = make_map(body, plan, settings, layout, "the avatar");
  const bool is_too_coarse = by_triangle.left_out.size() > map.left_out.size();
  MadeMap& better = is_too_coarse ? map : by_triangle;
  better.warnings.push_back(
      fmt::format("the avatar's texture coordinates cannot tell its skin apart: {:.0f} % of the skin of layout {} {}",
                  100 * misplaced, layout,
                  is_too_coarse ? "fires a wrong actuator, and the triangles are too large for an actuator each"
                                : "would fire a wrong actuator, so the map gives each triangle an actuator instead"));
  return std::move(better);
}

ActuatorMapFiles make_layout(const Avatar& avatar, std::string_view layout) {
  MadeMap made = make_layout_map(avatar, layout);
  made.files.warnings = std::move(made.warnings);
  if (!avatar.facing.doubt.empty())
    made.files.warnings.push_back(
        fmt::format("the avatar's facing: {}; {} is taken; 'vestige record --facing' records another",
                    avatar.facing.doubt, to_string(avatar.facing.axis)));
  if (!made.left_out.empty())
    made.files.warnings.push_back(
        fmt::format("the avatar has no skin for {} of the layout's actuators, which are left out: {}",
                    made.left_out.size(), fmt::join(made.left_out, ", ")));
  return std::move(made.files);
}

ActuatorMapFiles read_map_files(const Avatar& avatar, const std::string& map) {
  if (is_layout(map)) return make_layout(avatar, map);
  if (is_unknown_name(map))
    throw Error(map, "there is no such file",
                fmt::format("the layouts are: {}, {}", fmt::join(layout_names(), ", "), kBuiltin));
  return read_actuator_map_files(map);
}

}  // namespace vestige
