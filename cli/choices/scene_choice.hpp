#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "cli/choices/convention_choice.hpp"
#include "cli/choices/motion.hpp"
#include "cli/choices/radius_choice.hpp"
#include "cli/choices/scene.hpp"
#include "cli/terminal.hpp"
#include "traces/scene/avatar.hpp"
#include "traces/scene/colliders.hpp"

namespace vestige::cli {

/// The flags for the avatar, its motion, and the colliders around it. They mean the same in every verb that makes a
/// scene.
struct SceneChoice {
  std::string avatar = "builtin";
  std::string animation;
  MorphChoice morphs;
  MotionChoice motion;
  FacingChoice facing;
  std::string map;
  std::string colliders = "swarm";
  std::string nodes;            ///< of a glTF of colliders: a pattern of names
  ConventionChoice convention;  ///< of a file of colliders
  RadiusChoice radius;
  std::optional<std::uint32_t> count;  ///< of a scenario; if empty, the scenario's default
  std::size_t people = 1;              ///< to whom colliders of a file can belong

  bool from_file() const { return colliders.ends_with(".csv") || from_gltf(); }
  bool from_gltf() const { return colliders.ends_with(".glb") || colliders.ends_with(".gltf"); }
  /// Number of colliders of a scenario.
  std::uint32_t collider_count() const;
};

/// The value of --colliders that means no collider.
inline constexpr const char* kNoColliders = "none";

/// Returns the help of --animation; `otherwise` is its default.
std::string describe_animations(std::string_view otherwise);

inline constexpr const char* kNodesHelp =
    "The nodes of a glTF file that are colliders, as a pattern of names: 'ball*' [default: nodes named "
    "collider*, or if there are none, all nodes with an animated translation]";

/// Returns the help of --count, for the number of colliders of a scenario.
std::string describe_count();

/// Adds --avatar, --facing, --animation, --ignore-morphs, --unit, --up, --map, --colliders, --nodes, --radius, --count,
/// and how a file of colliders measures.
void add_scene_options(CLI::App& verb, SceneChoice& choice);

/// Throws `UsageError` for a scenario that does not exist, and for flags without effect: --unit and --up if none of the
/// people's animations is motion capture, --count with colliders from a file or without colliders, --nodes with
/// colliders that come from no glTF, units and axes of colliders that come from no file.
void check_scene_choice(const SceneChoice& choice, const std::vector<std::string>& animations);

/// If `animation` names a motion file, adds the motion to the avatar's animations under that name, by
/// add_motion.
void load_motion(const std::string& animation, const MotionChoice& motion, Avatar& avatar,
                 const std::vector<std::string>& outputs, const CommonOptions& common);

std::unique_ptr<ColliderSource> make_colliders(const SceneChoice& choice, const Avatar& avatar,
                                               const Animation* animation, std::uint64_t seed);

/// Returns a sentence if samples of colliders and a motion of `duration_s` hardly overlap in time; otherwise "".
std::string describe_small_overlap(const TimeSpan& span, double duration_s);

/// Returns a sentence if frames at `rate_hz` do not fall on samples that are `step_s` apart (0: there are none);
/// otherwise "".
std::string describe_resampling(double step_s, double rate_hz);

/// Warns of unexpected colliders: the source's own warnings, and samples of a file outside the duration or hardly in
/// it. Throws `Error` if all samples are outside.
void check_colliders(const SceneChoice& choice, const ColliderSource& colliders, double duration_s,
                     Verbosity verbosity);

}  // namespace vestige::cli
