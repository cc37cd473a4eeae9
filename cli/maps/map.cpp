#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <memory>

#include "analysis/base/provenance.hpp"
#include "analysis/mapping/layouts.hpp"
#include "analysis/mapping/map_check.hpp"
#include "analysis/mapping/map_maker.hpp"
#include "analysis/mapping/skin_patches.hpp"
#include "cli/choices/scene.hpp"
#include "cli/help/suggest.hpp"
#include "cli/help/validators.hpp"
#include "cli/output_bytes.hpp"
#include "cli/verbs.hpp"
#include "traces/base/error.hpp"
#include "traces/files/input_file.hpp"
#include "traces/gltf/avatar_gltf.hpp"

namespace vestige::cli {

namespace {

constexpr double kSquareCentimetres = 1e4;

Avatar read_avatar(const std::string& avatar, const CommonOptions& options) {
  Avatar read = parse_avatar_glb(read_builtin_or_file(avatar), avatar);
  if (read.triangles.empty()) throw Error(avatar, "has no triangles", "name an avatar with a mesh");
  for (const std::string& warning : read.warnings) warn(warning, options.verbosity());
  return read;
}

void add_avatar_option(CLI::App& verb, std::string& avatar) {
  verb.add_option("--avatar", avatar, "The avatar: the built-in one, or a glTF file (.glb, .gltf, .vrm)")
      ->capture_default_str()
      ->type_name("builtin|FILE");
}

void say_how_understood(const Body& body, const std::string& avatar, const CommonOptions& options) {
  if (body.understanding() == Understanding::kProportions)
    warn(fmt::format("{}: the joints' names do not tell torso and limbs apart, so a grown person's proportions do; "
                     "'vestige map parts' lists parts and joints",
                     avatar),
         options.verbosity());
}

/// Calls `doing`; a name that is not there gets what was probably meant.
template <typename Doing>
auto with_suggestions(const Doing& doing) {
  try {
    return doing();
  } catch (const UnknownName& error) {
    const std::vector<std::string_view> known(error.known().begin(), error.known().end());
    throw error.with_hint(help::did_you_mean(error.word(), known));
  }
}

// vestige map make

struct MakeOptions {
  CommonOptions common;
  std::string avatar = "builtin";
  FacingChoice facing;
  std::string layout;
  std::string regions;
  std::string output;
  std::string regions_output;
  MapSettings settings;
  bool is_given_texels = false;  ///< --size, --padding or --per-triangle
};

std::string made_text(const MakeOptions& options, const MadeMap& map, const std::string& sidecar) {
  double area_m2 = 0;
  for (const MadeActuator& actuator : map.actuators) area_m2 += actuator.area_m2;
  std::string text = fmt::format(
      "{}, {}: {} actuator{} on {:.0f} cm² of skin, {}\n", options.output, sidecar, map.actuators.size(),
      map.actuators.size() == 1 ? "" : "s", area_m2 * kSquareCentimetres,
      map.triangle_count != 0 ? "a texel for each triangle" : fmt::format("{0} x {0} texels", map.raster.side));
  for (std::size_t i = 0; i < map.actuators.size(); ++i) {
    const MadeActuator& actuator = map.actuators[i];
    text += fmt::format("  {:>3}  grey {:>3}  {:>5.0f} cm² around ({:.3f}, {:.3f}, {:.3f})  {}\n", i + 1, actuator.grey,
                        actuator.area_m2 * kSquareCentimetres, actuator.position_m.x, actuator.position_m.y,
                        actuator.position_m.z, actuator.name);
  }
  return text;
}

nlohmann::ordered_json made_json(const MakeOptions& options, const MadeMap& map, const Body& body) {
  nlohmann::ordered_json json;
  json["avatar"] = options.avatar;
  json["parts_by"] = body.understanding() == Understanding::kJoints ? "joints" : "proportions";
  json["facing"] = to_string(body.avatar().facing.axis);
  json["facing_by"] = to_string(body.avatar().facing.by);
  json["per_triangle"] = map.triangle_count != 0;
  json["side"] = map.raster.side;
  json["actuators"] = nlohmann::ordered_json::array();
  for (const MadeActuator& actuator : map.actuators)
    json["actuators"].push_back({{"grey", actuator.grey},
                                 {"name", actuator.name},
                                 {"position_m", {actuator.position_m.x, actuator.position_m.y, actuator.position_m.z}},
                                 {"area_m2", actuator.area_m2}});
  json["left_out"] = map.left_out;
  std::size_t texels = 0;
  for (const auto& [pair, count] : map.raster.conflicts) texels += count;
  json["texels_in_conflict"] = texels;
  json["triangles_left_out"] = map.raster.triangles_left_out;
  return json;
}

/// Of what `map check` would find wrong.
void warn_of_problems(const MakeOptions& options, const MadeMap& map, const Body& body, const Avatar& avatar) {
  const MapCheck check = check_map(body, parse_actuator_map(map.files, avatar, options.output), options.avatar);
  for (const MapFinding& finding : check.findings)
    if (finding.severity == Severity::kProblem)
      warn(fmt::format("{}: {}\n  {}", options.output, finding.cause, finding.remedy), options.common.verbosity());
}

void run_make(const MakeOptions& options, Invocation& invocation) {
  if (options.layout.empty() == options.regions.empty())
    throw UsageError("map make", "needs either --layout or --regions", "name one of them");
  if (!options.regions_output.empty() && options.layout.empty())
    throw UsageError("--save-regions", "writes a layout's regions, and there is no --layout", "leave it out");
  if (options.output == "-") throw UsageError("-o -", "a map is two files, and standard output is one", "name OUT.png");
  check_extension("-o", options.output, ".png", "a PNG");
  check_extension("--save-regions", options.regions_output, ".json", "JSON");
  const std::string sidecar = sidecar_path(options.output).string();
  if (std::error_code missing; std::filesystem::equivalent(sidecar, options.regions, missing))
    throw UsageError("-o", fmt::format("beside '{}' comes '{}', which the regions are in", options.output, sidecar),
                     "choose another name for the map");
  check_outputs({options.output, sidecar, options.regions_output, options.common.json},
                {options.avatar, options.regions}, options.common);

  Avatar avatar = read_avatar(options.avatar, options.common);
  settle_facing(avatar, options.facing, options.avatar, options.common.verbosity());
  if (options.layout.empty() && !options.settings.per_triangle) require_texture_coordinates(avatar, options.avatar);
  const std::string name = options.layout.empty() ? options.regions : options.layout;
  const std::string regions =
      options.layout.empty() ? read_text_file(options.regions) : layout_regions_json(options.layout);
  const Body body(avatar);
  const MadeMap map = with_suggestions([&] {
    Progress bar("Drawing", options.common.verbosity());
    MapSettings settings = options.settings;
    if (!options.layout.empty()) settings.empty = layout_empty_regions(options.layout);
    settings.progress = [&](double share) { bar.update(share); };
    // As where a layout stands for a map, unless it is said how.
    if (!options.layout.empty() && !options.is_given_texels)
      return make_layout_map(avatar, options.layout, settings.progress);
    const RegionPlan plan(body, parse_region_file(regions, name), name);
    settings.fires = fires_of_region_file(regions);
    return make_map(body, plan, settings, name, options.avatar);
  });
  say_how_understood(body, options.avatar, options.common);
  for (const std::string& warning : map.warnings) warn(warning, options.common.verbosity());
  if (!map.left_out.empty())
    warn(fmt::format("{}: has no skin for {} of the layout's actuators, which are left out: {}", options.avatar,
                     map.left_out.size(), fmt::join(map.left_out, ", ")),
         options.common.verbosity());

  write_together({{options.output, map.files.png},
                  {sidecar, std::as_bytes(std::span(map.files.json))},
                  {options.regions_output, std::as_bytes(std::span(regions))}},
                 options.common);
  nlohmann::ordered_json json = provenance(invocation.argv);
  json.update(made_json(options, map, body));
  write_json(options.common.json, json, options.common);
  print_summary(made_text(options, map, sidecar), {options.regions_output, options.common.json}, options.common);
  if (map.warnings.empty()) warn_of_problems(options, map, body, avatar);
  // Skin that should fire and does not, or fires another actuator.
  if (!map.raster.conflicts.empty() || map.raster.triangles_left_out > 0) invocation.exit_code = kDataLost;
}

/// What is wrong with a layout's name; empty: nothing.
std::string unknown_layout(const std::string& word) {
  if (is_layout(word)) return "";
  const std::vector<std::string> names = layout_names();
  const std::vector<std::string_view> known(names.begin(), names.end());
  return fmt::format("there is no layout '{}'; {}the layouts are: {}", word, help::did_you_mean(word, known),
                     fmt::join(names, ", "));
}

void add_make(CLI::App& map, Invocation& invocation) {
  auto options = std::make_shared<MakeOptions>();
  CLI::App* verb = add_verb(map, "make", "Draw an actuator map for an avatar, from a layout or from your own regions",
                            "  vestige map make --layout torso40 -o torso40.png\n"
                            "  vestige map make --layout paper6 --save-regions mine.json -o paper6.png\n");
  add_avatar_option(*verb, options->avatar);
  add_facing_option(*verb, options->facing);
  auto* layout = verb->add_option("--layout", options->layout, "A layout:" + layout_list())
                     ->check(CLI::Validator(unknown_layout, ""))
                     ->type_name("LAYOUT");
  verb->add_option(
          "--regions", options->regions,
          "A file of regions: {\"regions\": [{\"name\": \"heart\", \"part\": \"vest\", \"side\": [\"front\", "
          "\"left\"], \"height\": [0.6, 0.8]}, ...]}. A point of the skin belongs to the first region that holds it. "
          "part, joints and below (joints and all their descendants) choose the skin. height (0 to 1), "
          "height_m, angle (degrees: 0 front, 90 left) and side limit it. A region has one actuator, a grid "
          "{\"rows\": 5, \"columns\": 4}, or a list of actuators with position_m, each of which has the skin "
          "nearest to it. --save-regions shows how the layouts are written")
      ->type_name("FILE.json")
      ->excludes(layout);
  auto* per_triangle =
      verb->add_flag("--per-triangle", options->settings.per_triangle,
                     "Write one texel for each triangle of the avatar, in the triangles' order, instead "
                     "of an image in UV space: for avatars whose left and right halves share one "
                     "texture, or that have no texture coordinates");
  verb->add_option("--size", options->settings.side, "Texels on each side of the map")
      ->capture_default_str()
      ->check(help::whole_number(16, 16384))
      ->excludes(per_triangle);
  verb->add_option("--padding", options->settings.padding,
                   "How many texels regions extend beyond the skin's edge in the texture, but never onto other skin")
      ->capture_default_str()
      ->check(help::whole_number(0, 64))
      ->excludes(per_triangle);
  verb->add_option("-o,--output", options->output, "The map to write, and OUT.json, which names its actuators")
      ->required()
      ->type_name("OUT.png");
  verb->add_option("--save-regions", options->regions_output,
                   "Also write the layout's regions, as a start for your own file")
      ->type_name("OUT.json");
  add_common_options(*verb, options->common);
  verb->callback([options, verb, &invocation] {
    options->is_given_texels = verb->count("--size") + verb->count("--padding") + verb->count("--per-triangle") > 0;
    run_make(*options, invocation);
  });
}

// vestige map check

struct CheckOptions {
  CommonOptions common;
  FacingChoice facing;
  std::string map;
  std::string avatar = "builtin";
};

std::string checked_text(const CheckOptions& options, const ActuatorMap& map, const MapCheck& check) {
  double mapped_m2 = 0;
  for (const CheckedActuator& actuator : check.actuators) mapped_m2 += actuator.area_m2;
  std::string text =
      fmt::format("{} on {}: {} actuator{} on {:.0f} of {:.0f} cm² of skin ({:.1f} %)\n", options.map, options.avatar,
                  check.actuators.size(), check.actuators.size() == 1 ? "" : "s", mapped_m2 * kSquareCentimetres,
                  check.skin_m2 * kSquareCentimetres, check.skin_m2 > 0 ? 100 * mapped_m2 / check.skin_m2 : 0);
  if (options.common.verbose)
    for (std::size_t i = 0; i < check.actuators.size(); ++i) {
      const CheckedActuator& actuator = check.actuators[i];
      text += fmt::format("  {:>3}  {:>7} texels  {:>5.0f} cm² in {} piece{}  {}\n", i + 1, actuator.texels,
                          actuator.area_m2 * kSquareCentimetres, actuator.pieces, actuator.pieces == 1 ? "" : "s",
                          actuator.name);
    }
  for (std::uint32_t i = 0; i < map.actuator_count; ++i)
    if (!map.firing.is_own(i))
      text += fmt::format("'{}' fires {}\n", map.names[i], vestige::describe(map.firing.of(i), map.names));
  for (const MapFinding& finding : check.findings)
    text += fmt::format("{}: {}\n  {}\n", finding.severity == Severity::kProblem ? "problem" : "note", finding.cause,
                        finding.remedy);
  if (check.findings.empty()) text += "nothing wrong was found\n";
  return text;
}

nlohmann::ordered_json checked_json(const CheckOptions& options, const MapCheck& check) {
  nlohmann::ordered_json json;
  json["map"] = options.map;
  json["avatar"] = options.avatar;
  json["good"] = check.good();
  json["skin_m2"] = check.skin_m2;
  json["actuators"] = nlohmann::ordered_json::array();
  for (const CheckedActuator& actuator : check.actuators)
    json["actuators"].push_back({{"name", actuator.name},
                                 {"texels", actuator.texels},
                                 {"area_m2", actuator.area_m2},
                                 {"pieces", actuator.pieces},
                                 {"shared_m2", actuator.shared_m2},
                                 {"mirrored_m2", actuator.mirrored_m2}});
  json["findings"] = nlohmann::ordered_json::array();
  for (const MapFinding& finding : check.findings)
    json["findings"].push_back({{"severity", finding.severity == Severity::kProblem ? "problem" : "note"},
                                {"kind", finding.kind},
                                {"actuator", finding.actuator},
                                {"cause", finding.cause},
                                {"remedy", finding.remedy}});
  return json;
}

void run_check(const CheckOptions& options, Invocation& invocation) {
  check_outputs({options.common.json}, {options.avatar, options.map}, options.common);
  Avatar avatar = read_avatar(options.avatar, options.common);
  if (is_layout(options.map)) settle_facing(avatar, options.facing, options.avatar, options.common.verbosity());
  const ActuatorMapFiles files = read_map_files(avatar, options.map);
  if (files.png.empty()) throw UsageError(options.map, "there is nothing to check", "name a layout or a PNG");
  const ActuatorMap map = parse_actuator_map(files, avatar, options.map);
  for (const std::string& warning : map.warnings) warn(warning, options.common.verbosity());
  if (!is_layout(options.map))
    for (const std::string& warning : settle_facing(avatar.facing, options.facing.axis, map.facing, options.avatar))
      warn(warning, options.common.verbosity());
  const MapCheck check = check_map(Body(avatar), map, options.avatar);
  print_summary(checked_text(options, map, check), {options.common.json}, options.common);
  nlohmann::ordered_json json = provenance(invocation.argv);
  json.update(checked_json(options, check));
  write_json(options.common.json, json, options.common);
  if (!check.good()) invocation.exit_code = kCheckFailed;
}

void add_check(CLI::App& map, Invocation& invocation) {
  auto options = std::make_shared<CheckOptions>();
  CLI::App* verb = add_verb(map, "check", "Check a map on the avatar that it is for",
                            "  vestige map check builtin\n"
                            "  vestige map check regions.png --avatar man.glb\n");
  verb->add_option("MAP", options->map,
                   "A greyscale PNG (FILE.json names the actuators, if it exists), builtin, or a layout")
      ->required()
      ->type_name("FILE.png|builtin|LAYOUT");
  add_avatar_option(*verb, options->avatar);
  add_facing_option(*verb, options->facing);
  add_common_options(*verb, options->common);
  verb->callback([options, &invocation] { run_check(*options, invocation); });
}

// vestige map parts

struct PartsOptions {
  CommonOptions common;
  FacingChoice facing;
  std::string avatar = "builtin";
};

void run_parts(const PartsOptions& options, Invocation& invocation) {
  check_outputs({options.common.json}, {options.avatar}, options.common);
  Avatar avatar = read_avatar(options.avatar, options.common);
  settle_facing(avatar, options.facing, options.avatar, options.common.verbosity());
  const Body body(avatar);
  std::map<std::string, double> parts_m2;
  std::map<std::string, double> joints_m2;
  const bool stands = !avatar.facing.lies_deg;  // otherwise, nothing tells left, right and the vest
  const double step_m = 0.01 * body.surface().bounds().longest_side();
  for (std::uint32_t i = 0; i < avatar.triangles.size(); ++i) {
    const SkinPatches patches = patches_of_length(body.surface(), i, step_m);
    const double area_m2 = body.surface().area_m2(i) / static_cast<double>(patches.count());
    patches.for_each([&](const SkinPoint& point) {
      const glm::dvec3 p = body.surface().position_m(point);
      const SkinPart part = body.part_at(point);
      std::string name(to_string(part));
      if (part > SkinPart::kHead && stands) name += body.leftwards_m(p) >= 0 ? " left" : " right";
      parts_m2[name] += area_m2;
      if (part == SkinPart::kTorso && stands && p.y >= body.vest_low_m() && p.y < body.vest_high_m())
        parts_m2["vest"] += area_m2;
      joints_m2[avatar.nodes[static_cast<std::size_t>(body.node_at(point))].name] += area_m2;
    });
  }
  const bool by_joints = body.understanding() == Understanding::kJoints;
  std::string text = fmt::format("{}: parts, by {}\n", options.avatar,
                                 by_joints ? "its joints' names" : "a grown person's proportions");
  for (const auto& [name, area_m2] : parts_m2)
    text += fmt::format("  {:>6.0f} cm²  {}\n", area_m2 * kSquareCentimetres, name);
  text += "joints, and nodes with their own meshes\n";
  for (const auto& [name, area_m2] : joints_m2)
    text += fmt::format("  {:>6.0f} cm²  {}\n", area_m2 * kSquareCentimetres, name);
  print_summary(text, {options.common.json}, options.common);
  nlohmann::ordered_json json = provenance(invocation.argv);
  json["avatar"] = options.avatar;
  json["parts_by"] = by_joints ? "joints" : "proportions";
  json["parts_m2"] = parts_m2;
  json["joints_m2"] = joints_m2;
  write_json(options.common.json, json, options.common);
}

void add_parts(CLI::App& map, Invocation& invocation) {
  auto options = std::make_shared<PartsOptions>();
  CLI::App* verb = add_verb(map, "parts", "List the parts and joints that regions may name, with their areas of skin",
                            "  vestige map parts\n"
                            "  vestige map parts --avatar man.glb\n");
  add_avatar_option(*verb, options->avatar);
  add_facing_option(*verb, options->facing);
  add_common_options(*verb, options->common);
  verb->callback([options, &invocation] { run_parts(*options, invocation); });
}

// vestige map preview

struct PreviewOptions {
  std::string map;
  std::string avatar = "builtin";
  FacingChoice facing;
  std::string output;
  bool force = false;
  bool quiet = false;
};

void add_preview(CLI::App& map, Invocation& invocation) {
  auto options = std::make_shared<PreviewOptions>();
  CLI::App* verb = add_verb(map, "preview", "Draw a map on its avatar, front and back (runs vestige-plot)",
                            "  vestige map preview torso16 -o torso16\n"
                            "  vestige map preview regions.png --avatar man.glb -o regions-on-man\n");
  verb->add_option("MAP", options->map,
                   "A greyscale PNG (FILE.json names the actuators, if it exists), builtin, or a layout")
      ->required()
      ->type_name("FILE.png|builtin|LAYOUT");
  add_avatar_option(*verb, options->avatar);
  add_facing_option(*verb, options->facing);
  verb->add_option("-o,--output", options->output, "Write OUT.svg and OUT.png")->required()->type_name("OUT");
  verb->add_flag("--force", options->force, "Overwrite existing files");
  verb->add_flag("-q,--quiet", options->quiet, "Print errors only");
  verb->callback([options, &invocation] {
    std::vector<std::string> arguments = {
        "body",       "--avatar", options->avatar, "--facing", options->facing.axis, "--map",
        options->map, "-o",       options->output};
    if (options->force) arguments.emplace_back("--force");
    if (options->quiet) arguments.emplace_back("-q");
    invocation.exit_code = run_plot(arguments);
  });
}

}  // namespace

void add_map(CLI::App& program, Invocation& invocation) {
  CLI::App* verb = add_verb(program, "map", "Make, check and preview actuator maps",
                            "  vestige map make --layout torso16 -o torso16.png\n"
                            "  vestige map check regions.png --avatar man.glb\n");
  verb->require_subcommand(1);
  add_make(*verb, invocation);
  add_check(*verb, invocation);
  add_preview(*verb, invocation);
  add_parts(*verb, invocation);
}

}  // namespace vestige::cli
