#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "cli/choices/convention_choice.hpp"
#include "cli/choices/motion.hpp"
#include "cli/choices/radius_choice.hpp"
#include "cli/choices/scene.hpp"
#include "cli/options.hpp"
#include "traces/scene/colliders.hpp"
#include "traces/scene/trace.hpp"

namespace vestige::cli {

/// The files of a person.
struct PersonFiles {
  std::string poses;
  std::string avatar;
  std::string map;
};

struct ImportOptions {
  CommonOptions common;
  std::string from;
  std::string motion;
  std::string poses;
  std::string colliders;
  std::string nodes;
  RadiusChoice radius;
  std::string avatar;
  std::string map;
  std::vector<PersonFiles> others;  ///< of a folder that `export` wrote: the people after the first
  std::string session;              ///< session.json of the folder; empty without one
  MotionChoice motion_choice;
  ConventionChoice convention;
  bool are_collider_axes_given = false;
  FacingChoice facing;
  std::optional<double> rate_hz;
  std::string compression = "zstd";
  std::string output;
};

/// Gives frame after frame: first whoever knows index, time and pose, then whoever knows the colliders.
struct ImportedFrames {
  bool next(TraceFrame& frame) const {
    if (!next_pose(frame)) return false;
    add_colliders(frame);
    return true;
  }

  std::function<bool(TraceFrame&)> next_pose;
  std::function<void(TraceFrame&)> add_colliders = [](TraceFrame&) {};
  std::function<void()> finish = [] {};
  std::shared_ptr<const ColliderSource> sampled = {};  ///< colliders that are sampled at the times of the frames
  ColliderShape shape = ColliderShape::kPoints;
  Owners owners = Owners::kNone;
  std::function<double()> share;
  std::vector<bool> placed;  ///< for each node, whether a file of poses says where it is
};

/// Reads --colliders, if given.
void read_colliders(const ImportOptions& options, ImportedFrames& frames);

/// Each frame of the motion once, or at a rate of one's own. Keeps a reference to the avatar.
void play_motion(const Avatar& avatar, const LoadedMotion& motion, std::optional<double> rate_hz,
                 ImportedFrames& frames);

/// Throws `Error` if the recorded facing of one of several people names no axis. Of one person it does not matter, as
/// --facing then sets another.
void require_axis(const std::string& file, std::size_t person, const std::string& facing);

/// Throws `Error` if two people have one name.
void require_different_names(const std::string& file, const std::vector<Scene>& scenes);

/// Reads the people of an .h5, whose frames follow.
std::vector<Scene> read_hdf5(const std::string& path, const FacingChoice& facing, ImportedFrames& frames,
                             Verbosity verbosity);

/// Reads --poses: those of the first person, and in a folder those of the others. Keeps references to the avatars.
void read_poses(const ImportOptions& options, const std::vector<Scene>& scenes, ImportedFrames& frames);

}  // namespace vestige::cli
