#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <memory>
#include <set>
#include <tuple>

#include "analysis/base/png_image.hpp"
#include "analysis/base/provenance.hpp"
#include "analysis/mapping/uv_overlap.hpp"
#include "cli/choices/scene.hpp"
#include "cli/output_bytes.hpp"
#include "cli/verbs.hpp"
#include "traces/base/error.hpp"
#include "traces/base/number_text.hpp"
#include "traces/gltf/avatar_gltf.hpp"
#include "traces/gltf/clean/clean_avatar.hpp"
#include "traces/motion/animation_choice.hpp"
#include "traces/scene/builtin_avatar.hpp"
#include "traces/scene/reference_skinning.hpp"

namespace vestige::cli {

namespace {

constexpr std::uint32_t kTextureSide = 1024;

struct AvatarOptions {
  CommonOptions common;
  std::string avatar = "builtin";
  FacingChoice facing;
  std::string output;
  std::string map_output;
  std::string uv_output;
};

/// Vertices that differ in place: those that only texture seams split count once.
std::size_t welded_vertices(const Avatar& avatar) {
  std::set<std::tuple<float, float, float>> places;
  for (const glm::vec3& p : avatar.position_bind) places.emplace(p.x, p.y, p.z);
  return places.size();
}

nlohmann::ordered_json describe(const Avatar& avatar, const UvCoverage& coverage) {
  nlohmann::ordered_json json = to_json(avatar);
  json["welded_vertices"] = welded_vertices(avatar);
  json["animations"] = nlohmann::ordered_json::array();
  for (const Animation& animation : avatar.animations)
    json["animations"].push_back({{"name", animation.name},
                                  {"duration_s", animation.duration_s},
                                  {"morph_m", animation.morph ? animation.morph->reach_m : 0}});
  json["influences"] = avatar.influence_count;
  const Box bounds = rest_box(avatar);
  json["bounds"] = {{"min", {bounds.low.x, bounds.low.y, bounds.low.z}},
                    {"max", {bounds.high.x, bounds.high.y, bounds.high.z}}};
  json["uv_overlap_texels"] = coverage.overlap_texels;
  json["uv_covered_texels"] = coverage.covered_texels;
  json["uv_texture_side"] = coverage.side;
  json["lies_deg"] = avatar.facing.lies_deg ? nlohmann::ordered_json(*avatar.facing.lies_deg) : nullptr;
  json["warnings"] = avatar.warnings;
  return json;
}

std::string overlap_text(const UvCoverage& coverage) {
  if (coverage.covered_texels == 0) return "no triangle covers a texel: an actuator map cannot tell regions apart";
  const double share =
      100.0 * static_cast<double>(coverage.overlap_texels) / static_cast<double>(coverage.covered_texels);
  return fmt::format("{} of {} covered texels have several triangles ({:.1f} %, at {} x {})", coverage.overlap_texels,
                     coverage.covered_texels, share, coverage.side, coverage.side);
}

std::string summary(const std::string& name, const nlohmann::ordered_json& json, const Avatar& avatar,
                    const UvCoverage& coverage) {
  const auto number = [&](const char* corner, std::size_t axis) { return json["bounds"][corner][axis].get<double>(); };
  std::string text = fmt::format("{}: {}, {} vertices in {}, {}, up to {} per vertex\n", name,
                                 counted(avatar.triangles.size(), "triangle"), avatar.position_bind.size(),
                                 counted(json["welded_vertices"].get<std::size_t>(), "place"),
                                 counted(avatar.joint_count, "joint"), counted(avatar.influence_count, "influence"));
  text += fmt::format(
      "  bounding box   x {:.4g} to {:.4g}, y {:.4g} to {:.4g}, z {:.4g} to {:.4g} (rest pose; glTF: metres)\n",
      number("min", 0), number("max", 0), number("min", 1), number("max", 1), number("min", 2), number("max", 2));
  text += fmt::format("  faces          {}, {}\n", to_string(avatar.facing.axis),
                      avatar.facing.lies_deg ? "though it does not stand" : in_words(avatar.facing.by));
  text += fmt::format("  UV overlap     {}\n", overlap_text(coverage));
  if (avatar.animations.empty()) text += "  no animation\n";
  for (std::size_t i = 0; i < avatar.animations.size(); ++i)
    text += fmt::format("  animation {:>3}  {} ({:.4g} s){}\n", i,
                        avatar.animations[i].name.empty() ? "unnamed" : avatar.animations[i].name,
                        avatar.animations[i].duration_s,
                        avatar.animations[i].morph ? ", moves the skin by morph targets, too" : "");
  return text;
}

/// Nothing is white, one triangle grey, several red, darker the more there are.
std::vector<std::byte> overlap_picture(const UvCoverage& coverage) {
  using Colour = std::array<std::uint8_t, 3>;
  constexpr Colour kNothing = {255, 255, 255};
  constexpr Colour kOne = {190, 190, 190};
  constexpr std::array<Colour, 3> kSeveral = {{{240, 110, 90}, {200, 40, 30}, {110, 0, 0}}};
  std::vector<Colour> pixels;
  pixels.reserve(coverage.layers.size());
  for (const std::uint8_t layers : coverage.layers)
    pixels.push_back(layers == 0   ? kNothing
                     : layers == 1 ? kOne
                                   : kSeveral[std::min<std::size_t>(layers - 2U, kSeveral.size() - 1)]);
  return colour_png(pixels, coverage.side, coverage.side);
}

void run_avatar(const AvatarOptions& options, const Invocation& invocation) {
  const bool is_builtin = options.avatar == kBuiltin;
  if (!options.map_output.empty() && !is_builtin)
    throw UsageError("--map-output", "only the built-in avatar comes with a map", "leave out --map-output or AVATAR");
  check_extension("-o", options.output, ".glb", "binary glTF");
  check_extension("--map-output", options.map_output, ".png", "a PNG");
  check_extension("--uv", options.uv_output, ".png", "a PNG");
  std::string sidecar;
  if (!options.map_output.empty() && options.map_output != "-") sidecar = sidecar_path(options.map_output).string();
  check_outputs({options.output, options.map_output, sidecar, options.uv_output, options.common.json}, {options.avatar},
                options.common);
  for (const auto& [flag, path] : {std::pair("-o -", options.output), std::pair("--map-output -", options.map_output),
                                   std::pair("--uv -", options.uv_output)})
    if (path == "-") refuse_terminal(flag);

  const std::vector<std::byte> glb = read_builtin_or_file(options.avatar);
  Avatar avatar = parse_avatar_glb(glb, options.avatar);
  for (const std::string& warning : avatar.warnings) warn(warning, options.common.verbosity());
  const Facing of_builtin_map = avatar.facing.axis;  // whatever --facing asks for
  settle_facing(avatar, options.facing, options.avatar, options.common.verbosity());
  const UvCoverage coverage = uv_coverage(avatar, kTextureSide);

  if (!options.output.empty() && !is_builtin)
    for (const Animation& animation : avatar.animations)
      if (animation.morph)
        warn(fmt::format("{}: {}; this motion is not written", animation.morph->where, describe_morph(animation)),
             options.common.verbosity());
  if (!options.output.empty())
    write_bytes(options.output, is_builtin ? glb : clean_avatar_glb(glb, options.avatar), options.common);
  if (!options.map_output.empty()) {
    write_bytes(options.map_output, builtin_actuator_map_png(), options.common);
    nlohmann::ordered_json map = {{"facing", to_string(of_builtin_map)}};
    map.update(nlohmann::ordered_json::parse(builtin_actuator_map_json()));
    const std::string json = map.dump(2) + "\n";
    write_bytes(sidecar, std::as_bytes(std::span(json)), options.common);
  }
  if (!options.uv_output.empty()) write_bytes(options.uv_output, overlap_picture(coverage), options.common);

  nlohmann::ordered_json json = provenance(invocation.argv);
  json["avatar"] = options.avatar;
  const nlohmann::ordered_json description = describe(avatar, coverage);
  json.update(description);
  write_json(options.common.json, json, options.common);
  print_summary(summary(options.avatar, description, avatar, coverage),
                {options.output, options.map_output, options.uv_output, options.common.json}, options.common);
}

}  // namespace

void add_avatar(CLI::App& program, Invocation& invocation) {
  auto options = std::make_shared<AvatarOptions>();
  CLI::App* verb = add_verb(program, "avatar", "Describe an avatar, and write it as a file",
                            "  vestige avatar\n"
                            "  vestige avatar builtin -o mannequin.glb --map-output mannequin.png\n");
  verb->add_option("AVATAR", options->avatar, "The built-in avatar, or a glTF file (.glb, .gltf, .vrm)")
      ->capture_default_str()
      ->type_name("builtin|FILE");
  add_facing_option(*verb, options->facing);
  verb->add_option("-o,--output", options->output,
                   "Write the avatar as one binary glTF file without faults. Colours, base colour textures in the "
                   "file, normals, animations of nodes and VRM's roles are kept. Morph targets (the rest keeps their "
                   "shape), other textures and texture coordinates, vertex colours, cameras, lights and extensions are "
                   "left out; glTF has no place for --facing")
      ->type_name("OUT.glb|-");
  verb->add_option("--map-output", options->map_output,
                   "Write the built-in avatar's actuator map, and OUT.json, which names its actuators")
      ->type_name("OUT.png");
  verb->add_option("--uv", options->uv_output,
                   "Draw the texture: grey for one triangle, red for several, which a map cannot tell apart")
      ->type_name("OUT.png|-");
  add_common_options(*verb, options->common);
  verb->callback([options, &invocation] { run_avatar(*options, invocation); });
}

}  // namespace vestige::cli
