#pragma once

#include <CLI/CLI.hpp>
#include <memory>
#include <optional>
#include <string>

#include "traces/exchange/collider_files.hpp"
#include "traces/scene/colliders.hpp"

namespace vestige::cli {

/// How large colliders are, in every verb that takes them from a scenario or a file.
struct RadiusChoice {
  std::string text;  ///< as --radius has it; empty: as the file or the scenario says

  /// Returns the radius that all colliders have; nothing without one.
  std::optional<float> radius_m() const;
  GltfRadius of_gltf() const {
    if (text.empty()) return GltfRadius::kExtras;
    return text == "mesh" ? GltfRadius::kMesh : GltfRadius::kNone;
  }
  /// Gives the colliders of a source the radius that was chosen, if one was.
  std::unique_ptr<ColliderSource> apply(std::unique_ptr<ColliderSource> source) const;
};

/// Adds --radius.
void add_radius_option(CLI::App& verb, RadiusChoice& choice);

/// Throws `UsageError` for a radius that none can have, and for `mesh` without a glTF of colliders.
void check_radius(const RadiusChoice& choice, const std::string& colliders);

}  // namespace vestige::cli
