#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <vector>

#include "traces/trace.hpp"

namespace vestige {

/// Reads what `make_frame_hdf5` wrote, or what others wrote in the same layout (FORMAT.md), a block of frames at a
/// time. Numbers of other types are converted. Every function throws `Error` naming the file: no HDF5, a table that is
/// missing or of another shape, an attachment with another SHA-256 than the session says, frames or times that run
/// back, a library that is not installed.
class TraceHdf5 {
 public:
  explicit TraceHdf5(const std::filesystem::path& path);
  ~TraceHdf5();
  TraceHdf5(const TraceHdf5&) = delete;
  TraceHdf5& operator=(const TraceHdf5&) = delete;

  const std::vector<std::byte>& avatar_glb() const;
  const std::vector<std::byte>& actuator_map_png() const;   ///< empty: none
  const std::vector<std::byte>& actuator_map_json() const;  ///< empty: none

  bool next(TraceFrame& frame);
  double share() const;

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace vestige
