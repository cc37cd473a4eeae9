#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "traces/files/output_file.hpp"
#include "traces/scene/avatar.hpp"
#include "traces/scene/trace.hpp"

namespace vestige {

class TraceReader;

/// A file of a trace's frames for other programs. Complete or absent: without `commit` it leaves nothing behind. Memory
/// does not grow with the number of frames. Every function throws `Error` as `OutputFile` does.
class FrameFile {
 public:
  FrameFile() = default;
  virtual ~FrameFile() = default;
  FrameFile(const FrameFile&) = delete;
  FrameFile& operator=(const FrameFile&) = delete;

  virtual void write(const TraceFrame& frame) = 0;
  virtual void commit() = 0;
  /// What of the frames the format could not hold, one sentence each.
  virtual std::vector<std::string> losses() const { return {}; }
};

/// A line of JSON a frame; FORMAT.md, "Frames as text". "-" is standard output.
std::unique_ptr<FrameFile> make_frame_ndjson(const std::filesystem::path& path, Overwrite overwrite);

/// A row a frame: `frame,time_s,origin_x,origin_y,origin_z`, then ten columns for each node, as `pose_csv_nodes`
/// names them. "-" is standard output.
std::unique_ptr<FrameFile> make_pose_csv(const std::filesystem::path& path, Overwrite overwrite,
                                         const std::vector<std::string>& node_names);

/// A row a collider and frame: `frame,time_s,id,x,y,z,teleported`. "-" is standard output.
std::unique_ptr<FrameFile> make_collider_csv(const std::filesystem::path& path, Overwrite overwrite);

/// Binary glTF 2.0: the avatar as the trace carries it (`avatar` is what `glb` means), its motion as the one animation,
/// LINEAR, and a small sphere named "collider ID" for each of `collider_ids`, whose translation is animated, and whose
/// scale is 0 (STEP) while it is absent. Poses keep their bits, but for rotations that are not of length 1; times and
/// positions of colliders, which count from the first frame's origin (`extras.origin_m` of the scene), are rounded to
/// fp32. glTF has no teleports. A part that never moves has no channel. Holds 16 MiB of frames; the rest waits on disk,
/// beside `path`. Throws `Error` where the file would become larger than the 4 GiB that a GLB can hold.
std::unique_ptr<FrameFile> make_frame_gltf(const std::filesystem::path& path, Overwrite overwrite, const Avatar& avatar,
                                           std::span<const std::byte> glb, std::vector<std::uint32_t> collider_ids);

/// HDF5, into which a whole trace fits: `TraceHdf5` gives it back to the bit, but for markers and counts of drops. The
/// layout is in FORMAT.md. Holds a few chunks. The library is opened at run time. Throws `Error` where it is missing.
std::unique_ptr<FrameFile> make_frame_hdf5(const std::filesystem::path& path, Overwrite overwrite, TraceReader& trace);

}  // namespace vestige
