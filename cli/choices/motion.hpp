#pragma once

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "cli/options.hpp"
#include "traces/motion/retarget.hpp"
#include "traces/scene/avatar.hpp"

namespace vestige::cli {

/// Returns whether an --animation is a motion capture file and not a name.
inline bool is_motion_file(const std::string& animation) {
  return animation.ends_with(".bvh") || animation.ends_with(".BVH");
}

/// Warns about joints or nodes of the file at `path`. Prints nothing if `names` is empty.
void warn_of_names(const std::string& path, std::string_view what, const std::vector<std::string>& names,
                   Verbosity verbosity);

/// What the help of a flag that names motion capture says of --force.
inline constexpr const char* kLeanHelp =
    "A body whose head ends up more than 30 degrees away from the motion's, as seen from the hips, is refused; --force "
    "takes it, if it overwrites no file";

/// The flags that say how a motion capture file is to be understood.
struct MotionChoice {
  std::string unit = "auto";
  std::string up = "auto";

  /// Returns the first flag that is given.
  std::optional<std::string> given() const {
    return unit != "auto" ? std::optional("--unit") : up != "auto" ? std::optional("--up") : std::nullopt;
  }
};

/// Adds --unit and --up.
void add_motion_options(CLI::App& verb, MotionChoice& choice);

/// Whether the part of an animation that moves the skin by morph targets is left out.
struct MorphChoice {
  bool ignored = false;
};

/// Adds the flag --ignore-morphs, of a verb that plays an animation of the avatar.
CLI::Option* add_morph_option(CLI::App& verb, MorphChoice& choice);

/// Returns the animation that `find_animation` returns. If it moves the skin by morph targets: throws `Error`, or with
/// --ignore-morphs warns how far.
const Animation* choose_animation(const Avatar& avatar, const std::string& name_or_index, const MorphChoice& morphs,
                                  Verbosity verbosity);

/// A motion, and the result of its retargeting to an avatar.
struct LoadedMotion {
  double frame_time_s = 0;
  std::size_t frame_count = 0;
  std::size_t joint_count = 0;
  RetargetReport report;
};

/// Reads a BVH file, retargets it to the avatar and adds it to the avatar's animations, under the path of the file.
/// Reports which joints matched, and what differs from the motion. A body that leans another way is refused unless
/// --force accepts it, see `refusal_unless_forced`.
LoadedMotion add_motion(Avatar& avatar, const std::string& path, const MotionChoice& choice,
                        const std::vector<std::string>& outputs, const CommonOptions& common);

/// Describes joints and units in one line.
std::string describe(const LoadedMotion& motion);

nlohmann::ordered_json to_json(const LoadedMotion& motion);

}  // namespace vestige::cli
