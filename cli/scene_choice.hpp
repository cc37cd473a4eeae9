#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "cli/terminal.hpp"
#include "traces/avatar.hpp"
#include "traces/colliders.hpp"

namespace vestige::cli {

/// The flags that say who moves how and what is around: they mean the same in every verb that makes a scene.
struct SceneChoice {
  std::string avatar = "builtin";
  std::string animation;
  std::string map;
  std::string colliders = "swarm";
  std::optional<std::uint32_t> count;  ///< of a scenario; none: what it has by default

  bool from_file() const { return colliders.ends_with(".csv"); }
  /// Of a scenario.
  std::uint32_t collider_count() const;
};

/// Adds --avatar, --animation, --map, --colliders and --count.
void add_scene_options(CLI::App& verb, SceneChoice& choice);

/// Throws `UsageError` for a scenario that does not exist, and for a --count of colliders that come from a file.
void check_scene_choice(const SceneChoice& choice);

std::unique_ptr<ColliderSource> make_colliders(const SceneChoice& choice, const Avatar& avatar,
                                               const Animation* animation, std::uint64_t seed);

/// Says what is not as expected: warnings of the source itself, and samples of a file that lie beyond the duration.
/// When none lies within, throws `Error`.
void check_colliders(const SceneChoice& choice, const ColliderSource& colliders, double duration_s,
                     Verbosity verbosity);

}  // namespace vestige::cli
