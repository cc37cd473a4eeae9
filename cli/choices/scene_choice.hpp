#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "cli/terminal.hpp"
#include "traces/scene/avatar.hpp"
#include "traces/scene/colliders.hpp"

namespace vestige::cli {

/// The flags that say who moves how and what is around: they mean the same in every verb that makes a scene.
struct SceneChoice {
  std::string avatar = "builtin";
  std::string animation;
  std::string unit = "auto";  ///< of motion capture
  std::string map;
  std::string colliders = "swarm";
  std::string nodes;                   ///< of a glTF of colliders: a pattern of names
  std::optional<std::uint32_t> count;  ///< of a scenario; none: what it has by default

  bool from_file() const { return colliders.ends_with(".csv") || from_gltf(); }
  bool from_gltf() const { return colliders.ends_with(".glb") || colliders.ends_with(".gltf"); }
  /// Of a scenario.
  std::uint32_t collider_count() const;
};

/// Adds --avatar, --animation, --unit, --map, --colliders, --nodes and --count.
void add_scene_options(CLI::App& verb, SceneChoice& choice);

/// Throws `UsageError` for a scenario that does not exist, and for flags that do nothing: a --count of colliders that
/// come from a file, --nodes where they come from no glTF.
void check_scene_choice(const SceneChoice& choice);

/// Where --animation names a motion file: adds it to the avatar's animations under that name.
void load_motion(const SceneChoice& choice, Avatar& avatar, Verbosity verbosity);

std::unique_ptr<ColliderSource> make_colliders(const SceneChoice& choice, const Avatar& avatar,
                                               const Animation* animation, std::uint64_t seed);

/// Says what is not as expected: warnings of the source itself, and samples of a file that lie beyond the duration.
/// When none lies within, throws `Error`.
void check_colliders(const SceneChoice& choice, const ColliderSource& colliders, double duration_s,
                     Verbosity verbosity);

}  // namespace vestige::cli
