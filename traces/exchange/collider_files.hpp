#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "traces/scene/colliders.hpp"

namespace vestige {

/// Reads `time_s,id,x,y,z` (that header, then a row for each sample, metres; times not decreasing). Between two samples
/// of a collider its position is interpolated linearly; before its first and after its last it is absent. With the
/// header `frame,time_s,id,x,y,z,teleported` that a trace is exported with, it is absent too over frames that it misses
/// and on the way to where it teleported. Throws `Error` as `ColliderRows` does, for two positions at one time and for
/// a file without rows.
std::unique_ptr<ColliderSource> read_collider_csv(const std::filesystem::path& path);

/// Colliders that are nodes of a glTF file, where its animations (all of them, from time 0) move them in the world.
/// They are absent while their scale is 0 and after the last key. `pattern` chooses nodes by name, as a shell does
/// (`*`, `?`,
/// `[…]`); empty: those named "collider…", or else every node whose translation is animated and that is no joint of a
/// skin. A node's id is the number that its name ends in, where all have one and none twice; else they are counted in
/// the file's order. Throws `Error` for what is no glTF and where no node is chosen, naming those there are.
std::unique_ptr<ColliderSource> read_collider_gltf(const std::filesystem::path& path, const std::string& pattern);

}  // namespace vestige
