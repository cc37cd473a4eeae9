#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "traces/exchange/convention.hpp"
#include "traces/scene/colliders.hpp"
#include "traces/scene/people.hpp"

namespace vestige {

/// Reads a CSV file with the header `time_s,id,x,y,z[,radius_m][,owner]`, then a row for each sample, in metres and
/// seconds unless `convention` says otherwise (a radius is always in metres); times must not decrease.
/// Between two samples of a collider, its position and radius are interpolated linearly. Before its first and after its
/// last sample, the collider is absent. An exported trace has the header
/// `frame,time_s,id,x,y,z[,radius_m][,owner],teleported`. With that header, a collider is also absent over frames that
/// it misses and on the way to where it teleported. Throws `Error` as `ColliderRows` does, and if a collider has two
/// positions at one time or the file has no rows.
std::unique_ptr<ColliderSource> read_collider_csv(const std::filesystem::path& path, const Convention& convention = {},
                                                  std::size_t people = kMostOwners);

/// Where the radius of a glTF's node comes from. kExtras: `extras.radius_m`, the radius in metres at scale 1, 0 if
/// absent. kMesh: half of the longest side of the box around its mesh, 0 if it has none; the sphere stands at the
/// node's origin, wherever the mesh is. The node's scale in the world multiplies both. kNone: all are points.
enum class GltfRadius { kExtras, kMesh, kNone };

/// Reads colliders that are nodes of a glTF file. The file's animations (all of them, from time 0) move them in the
/// world. A collider is absent while its scale is 0 and after the last key. `pattern` selects nodes by name, as a shell
/// does (`*`, `?`, `[…]`). If `pattern` is empty, selects the nodes named "collider…". If there are none, selects every
/// node whose translation is animated and that is not a joint of a skin. A node's id is the number at the end of its
/// name, if all selected nodes have different ones. Otherwise ids count the nodes in file order. Throws `Error` if the
/// file is not glTF, or a node has a radius that none can have. Throws `Error` with the names of existing nodes if no
/// node is selected. `convention` changes the positions, and radii of meshes; a glTF's times are seconds.
std::unique_ptr<ColliderSource> read_collider_gltf(const std::filesystem::path& path, const std::string& pattern,
                                                   const Convention& convention = {},
                                                   GltfRadius radius = GltfRadius::kExtras);

}  // namespace vestige
