#include "cli/choices/radius_choice.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cstdlib>
#include <utility>

#include "traces/base/error.hpp"
#include "traces/scene/radius.hpp"

namespace vestige::cli {

std::optional<float> RadiusChoice::radius_m() const {
  if (text.empty() || text == "mesh") return {};
  double radius_m = 0;
  const auto [end, failure] = std::from_chars(text.data(), text.data() + text.size(), radius_m);
  if (failure == std::errc::result_out_of_range) radius_m = std::strtod(text.c_str(), nullptr);
  if (failure == std::errc::invalid_argument || end != text.data() + text.size())
    throw UsageError("--radius", fmt::format("'{}' is neither a number nor mesh", text),
                     "give a number of metres from 0 to 10, or mesh for nodes of a glTF file");
  if (const std::string_view fault = radius_fault(radius_m); !fault.empty())
    throw UsageError("--radius", fmt::format("'{}' {}", text, fault), "give a number of metres from 0 to 10");
  return static_cast<float>(radius_m);
}

std::unique_ptr<ColliderSource> RadiusChoice::apply(std::unique_ptr<ColliderSource> source) const {
  const std::optional<float> chosen_m = radius_m();
  return chosen_m ? with_radius(std::move(source), *chosen_m) : std::move(source);
}

void add_radius_option(CLI::App& verb, RadiusChoice& choice) {
  verb.add_option("--radius", choice.text,
                  "The radius of every collider in metres, 0 for points; mesh: half of the size of a glTF node's mesh "
                  "[default: what the file says; 0.05 in the scenarios rest and brush, points in all others]")
      ->type_name("M|mesh");
}

void check_radius(const RadiusChoice& choice, const std::string& colliders) {
  if (choice.text.empty()) return;
  static_cast<void>(choice.radius_m());
  const bool from_gltf = colliders.ends_with(".glb") || colliders.ends_with(".gltf");
  if (colliders.empty())
    throw UsageError("--radius", "there are no colliders", "leave --radius out, or give --colliders");
  if (choice.text == "mesh" && !from_gltf)
    throw UsageError("--radius mesh", "the colliders do not come from a glTF file",
                     "give the radius as a number of metres, or name a .glb as --colliders");
}

}  // namespace vestige::cli
