#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>

#include "traces/exchange/convention.hpp"
#include "traces/trace_file/trace_writer.hpp"

namespace vestige::cli {

/// What holds for every position and time, unless a flag says otherwise. For help.
inline constexpr const char* kConvention =
    "metres, seconds, right-handed axes, +Y up; the person faces +Z, unless --facing or the trace says otherwise";

/// The flags that say how the files of colliders and poses measure. An empty unit is that of the axes' program.
struct ConventionChoice {
  std::string collider_unit;
  std::string collider_axes = "gltf";
  std::string collider_offset = "0,0,0";
  std::string pose_unit;
  std::string pose_axes = "gltf";
  std::string time_unit = "s";

  Convention of_colliders() const;  ///< throws `UsageError` for an offset that is none
  Convention of_poses() const;

  /// Returns the first flag about colliders that is given.
  std::optional<std::string> given_for_colliders() const;
  std::optional<std::string> given_for_poses() const;
  bool has_time_unit() const { return time_unit != "s"; }
};

/// Adds --collider-unit, --collider-axes, --collider-offset and --time-unit.
void add_collider_convention(CLI::App& verb, ConventionChoice& choice);

/// Adds --pose-unit and --pose-axes.
void add_pose_convention(CLI::App& verb, ConventionChoice& choice);

/// Throws `UsageError` for flags about colliders where none come from a file, and for --time-unit where they come from
/// a glTF, whose times are seconds. `times` says whether another file has times that it concerns.
void check_collider_convention(const ConventionChoice& choice, const std::string& colliders, bool times);

/// Notes in the session what was taken for granted about the files.
void note_collider_convention(const ConventionChoice& choice, Session& session);
void note_pose_convention(const ConventionChoice& choice, Session& session);

}  // namespace vestige::cli
