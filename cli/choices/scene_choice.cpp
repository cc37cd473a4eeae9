#include "cli/choices/scene_choice.hpp"

#include <fmt/format.h>

#include <cmath>
#include <iterator>
#include <string_view>
#include <vector>

#include "analysis/mapping/layouts.hpp"
#include "cli/help/suggest.hpp"
#include "cli/help/validators.hpp"
#include "traces/base/error.hpp"
#include "traces/exchange/collider_files.hpp"
#include "traces/scenarios/scenarios.hpp"

namespace vestige::cli {

namespace {

UsageError no_scenario(const std::string& name) {
  std::vector<std::string_view> names;
  for (const Scenario& scenario : scenarios()) names.push_back(scenario.name);
  names.push_back(kNoColliders);
  return {"--colliders", fmt::format("there is no scenario '{}'", name),
          fmt::format("{}the scenarios are: {}; or name a .csv or .glb file", help::did_you_mean(name, names),
                      fmt::join(names, ", "))};
}

std::string describe_colliders() {
  std::string text = "Where the colliders come from:";
  std::size_t longest = 0;
  for (const Scenario& scenario : scenarios()) longest = std::max(longest, scenario.name.size());
  for (const Scenario& scenario : scenarios())
    fmt::format_to(std::back_inserter(text), "\n  {:<{}} {}", scenario.name, longest, scenario.summary);
  fmt::format_to(std::back_inserter(text), "\n  {:<{}} no collider", kNoColliders, longest);
  return text +
         "\nor a file of rows time_s,id,x,y,z[,radius_m][,owner], or the animated nodes of a glTF file. Its "
         "convention: " +
         kConvention;
}

/// Samples of a file that the scene does not reach are said, and when it reaches none it is refused.
void check_span(const TimeSpan& span, const SceneChoice& choice, double duration_s, Verbosity verbosity) {
  const std::string times = fmt::format("the samples last from {} s to {} s, and the scene from 0 s to {} s",
                                        span.first_s, span.last_s, duration_s);
  if (span.last_s < 0 || span.first_s > duration_s)
    throw Error(choice.colliders, "no sample lies within the scene: " + times,
                "make the file's times begin at 0, or raise --duration");
  if (!std::isfinite(span.last_s)) return;
  // A glTF has its times in fp32.
  if (span.first_s < 0 || static_cast<float>(span.last_s) > static_cast<float>(duration_s))
    warn(fmt::format("{}: {}; samples outside the scene are left out (--duration)", choice.colliders, times),
         verbosity);
  if (const std::string doubt = describe_small_overlap(span, duration_s); !doubt.empty())
    warn(fmt::format("{}: {}", choice.colliders, doubt), verbosity);
}

}  // namespace

std::string describe_small_overlap(const TimeSpan& span, double duration_s) {
  constexpr double kSmall = 0.1;
  const double common_s = std::min(span.last_s, duration_s) - std::max(span.first_s, 0.0);
  if (!std::isfinite(span.last_s) || common_s >= kSmall * duration_s) return "";
  return fmt::format(
      "colliders are there for {:.3g} s of {:g} s; if that is not meant, check the unit (--time-unit) and "
      "the rate of their times",
      std::max(common_s, 0.0), duration_s);
}

std::string describe_resampling(double step_s, double rate_hz) {
  constexpr double kSame = 0.02;
  if (step_s <= 0 || std::abs(step_s * rate_hz - 1) <= kSame) return "";
  return fmt::format(
      "samples at {:.4g} Hz become frames at {:.4g} Hz; between samples, colliders move along straight lines",
      1 / step_s, rate_hz);
}

std::string describe_animations(std::string_view otherwise) {
  return fmt::format(
      "The avatar's animation, which loops: a name, an index, none, or motion capture, whose joints are matched to the "
      "avatar's by their names ('vestige import' reports more). {} [default: {}]",
      kLeanHelp, otherwise);
}

std::string describe_count() {
  std::string text = fmt::format("Number of colliders of a scenario [default: {}", scenarios().front().default_count);
  for (const Scenario& scenario : scenarios())
    if (scenario.default_count != scenarios().front().default_count)
      fmt::format_to(std::back_inserter(text), "; {}: {}", scenario.name, scenario.default_count);
  return text + "]";
}

std::uint32_t SceneChoice::collider_count() const {
  return count.value_or(find_scenario(colliders)->default_count);
}

void add_scene_options(CLI::App& verb, SceneChoice& choice) {
  verb.add_option("--avatar", choice.avatar, "The avatar: the built-in one, or a glTF file (.glb, .gltf, .vrm)")
      ->capture_default_str()
      ->type_name("builtin|FILE");
  add_facing_option(verb, choice.facing);
  verb.add_option("--animation", choice.animation, describe_animations("the first"))
      ->type_name("NAME|INDEX|none|FILE.bvh");
  add_morph_option(verb, choice.morphs);
  add_motion_options(verb, choice.motion);
  verb.add_option("--map", choice.map,
                  "The actuator map: a layout," + layout_list() +
                      "\nor a greyscale PNG in UV space or by triangle; FILE.json, if it exists, names the actuators "
                      "[default: builtin for the built-in avatar, otherwise none]")
      ->type_name("builtin|none|LAYOUT|FILE.png");
  verb.add_option("--colliders", choice.colliders, describe_colliders())
      ->capture_default_str()
      ->type_name("SCENARIO|FILE.csv|FILE.glb");
  verb.add_option("--nodes", choice.nodes, kNodesHelp)->type_name("PATTERN");
  add_collider_convention(verb, choice.convention);
  add_radius_option(verb, choice.radius);
  verb.add_option("--count", choice.count, describe_count())->check(help::whole_number(1, 1000000));
}

void check_scene_choice(const SceneChoice& choice, const std::vector<std::string>& animations) {
  const bool has_none = choice.colliders == kNoColliders;
  if (!has_none && !choice.from_file() && find_scenario(choice.colliders) == nullptr)
    throw no_scenario(choice.colliders);
  if (const auto flag = choice.motion.given(); flag && std::ranges::none_of(animations, is_motion_file))
    throw UsageError(*flag, "no motion capture is played",
                     fmt::format("leave {} out, or name a .bvh as --animation", *flag));
  if (!choice.nodes.empty() && !choice.from_gltf())
    throw UsageError("--nodes", "the colliders do not come from a glTF file",
                     "leave --nodes out, or name a .glb as --colliders");
  check_collider_convention(choice.convention, choice.colliders, false);
  check_radius(choice.radius, choice.colliders);
  if (choice.count && choice.from_file())
    throw UsageError("--count", "the file sets the number of colliders", "leave --count out");
  for (const auto& [is_given, flag] :
       {std::pair(choice.count.has_value(), "--count"), std::pair(!choice.radius.text.empty(), "--radius")})
    if (is_given && has_none)
      throw UsageError(flag, "there are no colliders", fmt::format("leave {} out, or name --colliders", flag));
}

void load_motion(const std::string& animation, const MotionChoice& motion, Avatar& avatar,
                 const std::vector<std::string>& outputs, const CommonOptions& common) {
  if (is_motion_file(animation)) add_motion(avatar, animation, motion, outputs, common);
}

std::unique_ptr<ColliderSource> make_colliders(const SceneChoice& choice, const Avatar& avatar,
                                               const Animation* animation, std::uint64_t seed) {
  const auto make = [&]() -> std::unique_ptr<ColliderSource> {
    if (choice.from_gltf())
      return read_collider_gltf(choice.colliders, choice.nodes, choice.convention.of_colliders(),
                                choice.radius.of_gltf());
    if (choice.from_file()) return read_collider_csv(choice.colliders, choice.convention.of_colliders(), choice.people);
    return find_scenario(choice.colliders)
        ->make(avatar, animation, {choice.collider_count(), seed, choice.radius.radius_m()});
  };
  return choice.radius.apply(make());
}

void check_colliders(const SceneChoice& choice, const ColliderSource& colliders, double duration_s,
                     Verbosity verbosity) {
  check_span(colliders.span_s(), choice, duration_s, verbosity);
  for (const std::string& warning : colliders.warnings())
    warn(fmt::format("--colliders {}: {}", choice.colliders, warning), verbosity);
}

}  // namespace vestige::cli
