#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "traces/scene/trace.hpp"

namespace vestige {

/// Reads what `make_frame_hdf5` wrote, or what others wrote in the same layout (FORMAT.md), a block of frames at a
/// time. Numbers of other types are converted where all of them fit. Every function throws `Error` naming the file: no
/// HDF5, another format or version, a table that is missing, of another shape or type, an attachment with another
/// SHA-256 than the session says, frames or times that run back, a library that is not installed.
class TraceHdf5 {
 public:
  /// Reads all of it once, in a process of its own, which HDF5 may crash: before threads are started.
  explicit TraceHdf5(const std::filesystem::path& path);
  ~TraceHdf5();
  TraceHdf5(const TraceHdf5&) = delete;
  TraceHdf5& operator=(const TraceHdf5&) = delete;

  const std::vector<std::byte>& avatar_glb() const;
  const std::vector<std::byte>& actuator_map_png() const;   ///< empty: none
  const std::vector<std::byte>& actuator_map_json() const;  ///< empty: none

  /// What it says that the avatar's nodes are called; empty: nothing.
  const std::vector<std::string>& node_names() const;

  bool next(TraceFrame& frame);
  double share() const;

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace vestige
