#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "cli/facing_flag.hpp"
#include "cli/terminal.hpp"
#include "detector/actuator_map.hpp"
#include "traces/motion/animation_choice.hpp"
#include "traces/scene/avatar.hpp"
#include "traces/trace_file/trace_reader.hpp"
#include "traces/trace_file/trace_writer.hpp"

namespace vestige::cli {

/// A person of a recording: an avatar and its map, as files and in parsed form.
struct Scene {
  std::string name;  ///< empty: nobody needs one
  std::vector<std::byte> avatar_glb;
  std::vector<std::byte> map_png;
  std::string map_json;
  Avatar avatar;
  ActuatorMap map;

  TracePerson person() const { return {avatar, {avatar_glb, map_png, map_json}, name}; }
};

/// `avatar` is "builtin" or a file. `map` is "builtin", "none", a layout's name, or a PNG file, whose sidecar is the
/// .json of the same name, if it exists. If `map` is empty, it is "builtin" for the built-in avatar, otherwise "none".
/// `recorded_facing` is as in `SceneFiles`. Warnings go to standard error.
Scene load_scene(const std::string& avatar, const std::string& map, const FacingChoice& facing, Verbosity verbosity,
                 const std::string& recorded_facing = "");

/// The files of avatar and map, and the facing that is recorded beside them.
struct SceneFiles {
  std::vector<std::byte> avatar_glb;
  ActuatorMapFiles map;
  std::string facing;  ///< as `take_recorded_facing` takes it
};

/// As above, from files that are already read.
Scene make_scene(SceneFiles files, const SceneNames& names, const FacingChoice& facing, Verbosity verbosity);

/// Reads an avatar, "builtin" or a file, as a recording attaches it. Throws `Error` unless it can be parsed.
std::vector<std::byte> load_avatar(const std::string& avatar);

/// Reads the files of a map, "builtin" or a PNG file with its sidecar, as a recording attaches them. Throws `Error`
/// unless they can be parsed.
ActuatorMapFiles load_map(const std::string& map);

/// A person of a trace, with the avatar and map that the trace carries.
struct TracedPerson {
  std::string name;  ///< of one person empty if the trace names nobody; of several people, each is different
  Avatar avatar;
  ActuatorMap map;
};

/// A trace with its people.
struct OpenTrace {
  OpenTrace(const std::string& path, Verbosity verbosity, People allowed = People::kOne, std::size_t threads = 1);
  /// The only person, for verbs that know one.
  TracedPerson& person() { return people.front(); }
  const TracedPerson& person() const { return people.front(); }

  TraceReader reader;
  std::vector<TracedPerson> people;
};

/// Throws `Error` if somebody's avatar is one point at rest, unless an animation scales it. What touches the point
/// touches all triangles, which takes minutes to decide. `file` is the trace's name.
void require_surfaces(const OpenTrace& trace, const std::string& file);

/// Returns what stands before what is said about a person: "NAME: ", or "" if the trace has one person.
std::string before_person(const OpenTrace& trace, std::size_t person);

/// Prints what was wrong with a trace to standard error. Returns kDataLost if anything was, otherwise kDone.
int report_damage(const TraceReader& trace, const std::string& path, Verbosity verbosity);

}  // namespace vestige::cli
