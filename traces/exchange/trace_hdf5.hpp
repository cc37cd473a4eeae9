#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "traces/scene/trace.hpp"

namespace vestige {

/// Reads a file by `make_frame_hdf5`, or by another program in the same layout (FORMAT.md), one block of frames at a
/// time. Converts numbers of other types if all of them fit. Every function throws `Error` with the name of the file:
/// not HDF5, another format or version, a missing table, a table of another shape or type, an attachment with another
/// SHA-256 than in the session, frames or times that decrease, a collider of a person who is not there, a missing
/// library.
class TraceHdf5 {
 public:
  /// First reads the whole file once in a child process, because HDF5 may crash on it. Precondition: no threads have
  /// been started.
  explicit TraceHdf5(const std::filesystem::path& path);
  ~TraceHdf5();
  TraceHdf5(const TraceHdf5&) = delete;
  TraceHdf5& operator=(const TraceHdf5&) = delete;

  struct Person {
    std::vector<std::byte> avatar_glb;
    std::vector<std::byte> actuator_map_png;   ///< empty: none
    std::vector<std::byte> actuator_map_json;  ///< empty: none
    std::vector<std::string> node_names;       ///< of the avatar; empty if the file gives none
    std::string facing;  ///< at rest, as recorded: `take_recorded_facing`; empty: the file does not say it
    std::string name;    ///< empty: none
  };
  /// In the order of `TraceFrame::poses`, at least one.
  const std::vector<Person>& people() const;

  /// Whether the colliders may have a radius.
  ColliderShape shape() const;
  /// Whether the colliders may belong to people.
  Owners owners() const;

  bool next(TraceFrame& frame);
  double share() const;

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace vestige
