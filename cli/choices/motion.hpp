#pragma once

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "cli/terminal.hpp"
#include "traces/motion/retarget.hpp"
#include "traces/scene/avatar.hpp"

namespace vestige::cli {

/// Whether an --animation is a file of motion capture, and no name.
inline bool is_motion_file(const std::string& animation) {
  return animation.ends_with(".bvh") || animation.ends_with(".BVH");
}

/// A warning about joints or nodes of the file at `path`; nothing where there are none.
void warn_of_names(const std::string& path, std::string_view what, const std::vector<std::string>& names,
                   Verbosity verbosity);

/// The flag --unit, of a motion.
void add_unit_option(CLI::App& verb, std::string& unit);

/// "cm", "m", …: how many metres it has; nothing for "auto".
std::optional<double> metres_of_unit(const std::string& unit);

/// A motion, and what became of it on an avatar.
struct LoadedMotion {
  double frame_time_s = 0;
  std::size_t frame_count = 0;
  std::size_t joint_count = 0;
  RetargetReport report;
};

/// Reads a BVH file and adds it, retargeted, to the avatar's animations, under the file's own name. Says what matched.
LoadedMotion add_motion(Avatar& avatar, const std::string& path, const std::string& unit, Verbosity verbosity);

/// Frames, joints and units in a few lines.
std::string describe(const LoadedMotion& motion);

nlohmann::ordered_json to_json(const LoadedMotion& motion);

}  // namespace vestige::cli
