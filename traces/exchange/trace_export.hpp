#pragma once

#include <hdf5.h>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "traces/files/output_file.hpp"
#include "traces/scene/avatar.hpp"
#include "traces/scene/trace.hpp"

namespace vestige {

class TraceReader;

/// A file of a trace's frames for other programs. The file is complete or absent: without `commit` it leaves nothing
/// behind. Memory does not grow with the number of frames. Every function throws `Error` as `OutputFile` does.
class TraceExport {
 public:
  TraceExport() = default;
  virtual ~TraceExport() = default;
  TraceExport(const TraceExport&) = delete;
  TraceExport& operator=(const TraceExport&) = delete;

  virtual void write(const TraceFrame& frame) = 0;
  virtual void commit() = 0;
  /// The data of the frames that the format could not hold, one sentence each.
  virtual std::vector<std::string> losses() const { return {}; }
};

/// Writes one line of JSON for each frame; FORMAT.md, "Frames as text". "-" is standard output.
std::unique_ptr<TraceExport> make_frame_ndjson(const std::filesystem::path& path, Overwrite overwrite);

/// Writes one row for each frame that has a pose of this person, who counts from 0:
/// `frame,time_s,origin_x,origin_y,origin_z`, then ten columns for each node, as `pose_csv_nodes` names them. "-" is
/// standard output.
std::unique_ptr<TraceExport> make_pose_csv(const std::filesystem::path& path, Overwrite overwrite,
                                           const std::vector<std::string>& node_names, std::size_t person);

/// Writes one row for each collider in each frame: `frame,time_s,id,x,y,z,teleported`; spheres have radius_m behind z,
/// and then comes the owner if the trace has owners. "-" is standard output.
std::unique_ptr<TraceExport> make_collider_csv(const std::filesystem::path& path, Overwrite overwrite,
                                               ColliderShape shape, Owners owners);

/// The ids of a trace's colliders, ascending.
struct ColliderIds {
  std::vector<std::uint32_t> all;
  std::vector<std::uint32_t> spheres = {};  ///< those of `all` that have a radius in some frame
};

/// A person whom a glTF file shows.
struct GltfPerson {
  std::string name;  ///< needed where there are several
  const Avatar& avatar;
  std::span<const std::byte> glb;  ///< of which `avatar` was parsed
};

/// Writes binary glTF 2.0. It holds the trace's avatars, as `clean_avatar_glb` writes them, with the trace's motion as
/// the only animation, LINEAR. Each of several people stands below a node of their name. Each collider is a node
/// "collider ID" with an animated translation. A point is drawn as a sphere of 1 cm, with `extras.radius_m` 0. A sphere
/// has `extras.radius_m` 1, and its scale (STEP) is its radius. The scale is 0 (STEP) while the collider is absent.
///
/// Poses keep their bits, except rotations whose length is not 1. Times and positions of colliders are rounded to fp32;
/// positions count from the first frame's origin (`extras.origin_m` of the scene). glTF has no teleports. A part that
/// never moves has no channel. Holds 16 MiB of frames in memory, and the rest on disk beside `path`. Throws `Error` if
/// the file would exceed the 4 GiB that a GLB can hold.
std::unique_ptr<TraceExport> make_frame_gltf(const std::filesystem::path& path, Overwrite overwrite,
                                             std::span<const GltfPerson> people, ColliderIds ids);

/// Writes HDF5, which holds a whole trace: `TraceHdf5` reads it back to the bit, except markers and counts of drops.
/// FORMAT.md describes the layout. Holds a few chunks in memory. Opens the library at run time, and throws `Error` if
/// it is missing. `write_more`, if given, is called when all frames are written, to add groups of its own to the file.
std::unique_ptr<TraceExport> make_frame_hdf5(const std::filesystem::path& path, Overwrite overwrite, TraceReader& trace,
                                             std::function<void(hid_t file)> write_more = {});

}  // namespace vestige
