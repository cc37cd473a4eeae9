#include "cli/choices/convention_choice.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <vector>

#include "cli/options.hpp"
#include "traces/base/error.hpp"

namespace vestige::cli {

namespace {

std::vector<std::string> axes_names() {
  std::vector<std::string> names;
  names.reserve(kAxisPresets.size());
  for (const AxisPreset& preset : kAxisPresets) names.emplace_back(preset.name);
  return names;
}

template <typename Units>
std::vector<std::string> unit_names(const Units& units) {
  std::vector<std::string> names;
  names.reserve(units.size());
  for (const Unit& unit : units) names.emplace_back(unit.name);
  return names;
}

template <typename Units>
double size_of(const Units& units, std::string_view name) {
  return std::ranges::find(units, name, &Unit::name)->size;
}

std::string unit_of(const std::string& unit, const std::string& axes) {
  return unit.empty() ? std::string(std::ranges::find(kAxisPresets, axes, &AxisPreset::name)->unit) : unit;
}

Convention convention_of(const std::string& unit, const std::string& axes, const std::string& time_unit) {
  Convention convention;
  convention.metres_per_unit = size_of(kLengthUnits, unit_of(unit, axes));
  convention.seconds_per_unit = size_of(kTimeUnits, time_unit);
  convention.axes = axes_named(axes);
  return convention;
}

std::string describe_axes(const char* what) {
  std::string text = fmt::format("The axes of {}:", what);
  for (const AxisPreset& preset : kAxisPresets)
    fmt::format_to(std::back_inserter(text), "\n  {:<9} {}", preset.name, preset.meaning);
  return text;
}

void add_unit(CLI::App& verb, const char* flag, std::string& unit, const char* what) {
  verb.add_option(flag, unit,
                  fmt::format("The unit of length of {} [default: that of its axes: m, or cm for unreal]", what))
      ->check(CLI::IsMember(unit_names(kLengthUnits)));
}

void add_axes(CLI::App& verb, const char* flag, std::string& axes, const char* what) {
  verb.add_option(flag, axes, describe_axes(what))->capture_default_str()->check(CLI::IsMember(axes_names()));
}

bool is_gltf(const std::string& path) {
  return path.ends_with(".glb") || path.ends_with(".gltf");
}

}  // namespace

Convention ConventionChoice::of_colliders() const {
  Convention convention = convention_of(collider_unit, collider_axes, time_unit);
  convention.offset_m = parse_vector(collider_offset, "--collider-offset");
  return convention;
}

Convention ConventionChoice::of_poses() const {
  return convention_of(pose_unit, pose_axes, time_unit);
}

std::optional<std::string> ConventionChoice::given_for_colliders() const {
  if (!collider_unit.empty()) return "--collider-unit";
  if (collider_axes != "gltf") return "--collider-axes";
  return collider_offset != "0,0,0" ? std::optional<std::string>("--collider-offset") : std::nullopt;
}

std::optional<std::string> ConventionChoice::given_for_poses() const {
  if (!pose_unit.empty()) return "--pose-unit";
  return pose_axes != "gltf" ? std::optional<std::string>("--pose-axes") : std::nullopt;
}

void add_collider_convention(CLI::App& verb, ConventionChoice& choice) {
  add_unit(verb, "--collider-unit", choice.collider_unit, "the file of colliders");
  add_axes(verb, "--collider-axes", choice.collider_axes, "the file of colliders");
  verb.add_option("--collider-offset", choice.collider_offset,
                  "Moves all colliders of the file, in metres and the trace's axes")
      ->capture_default_str()
      ->type_name("X,Y,Z");
  verb.add_option("--time-unit", choice.time_unit, "The unit of the times in CSV files")
      ->capture_default_str()
      ->check(CLI::IsMember(unit_names(kTimeUnits)));
}

void add_pose_convention(CLI::App& verb, ConventionChoice& choice) {
  add_unit(verb, "--pose-unit", choice.pose_unit, "the file of poses");
  add_axes(verb, "--pose-axes", choice.pose_axes, "the file of poses, and of each node's own transform in it");
}

void check_collider_convention(const ConventionChoice& choice, const std::string& colliders, bool times) {
  const bool from_csv = colliders == "-" || colliders.ends_with(".csv");
  if (const auto flag = choice.given_for_colliders(); flag && !from_csv && !is_gltf(colliders))
    throw UsageError(*flag, "no colliders come from a file",
                     fmt::format("leave {} out, or name a .csv or .glb as --colliders", *flag));
  if (choice.has_time_unit() && !from_csv && !times)
    throw UsageError("--time-unit", "there is no CSV file with times",
                     "leave --time-unit out: the times of scenarios and glTF are seconds");
}

void note_collider_convention(const ConventionChoice& choice, Session& session) {
  session["collider_unit"] = unit_of(choice.collider_unit, choice.collider_axes);
  session["collider_axes"] = choice.collider_axes;
  session["collider_offset"] = choice.collider_offset;
  session["time_unit"] = choice.time_unit;
}

void note_pose_convention(const ConventionChoice& choice, Session& session) {
  session["pose_unit"] = unit_of(choice.pose_unit, choice.pose_axes);
  session["pose_axes"] = choice.pose_axes;
  session["time_unit"] = choice.time_unit;
}

}  // namespace vestige::cli
