#pragma once

#include <cstddef>
#include <span>
#include <string_view>
#include <vector>

namespace vestige {

/// Writes anew what `parse_avatar_glb` reads of a file, so that the result has no fault: Khronos' glTF validator finds
/// no error in it, and reading it gives the same nodes, vertices, triangles and motion as reading `glb`. Normals, plain
/// materials, colour textures inside the file, the copyright and VRM's roles are kept; what else is not read is left
/// out. Where weights or rotations have to be normalised, results may differ in the last bits. A node with a
/// `fixed_matrix`, which shears, becomes two nodes, with which they may differ as well; a pose cannot move such a node,
/// but it can move the two. Roots that a skin joins get a common root. Animations that move no node are left out.
/// Throws `Error` as `parse_avatar_glb` does.
std::vector<std::byte> clean_avatar_glb(std::span<const std::byte> glb, std::string_view name);

}  // namespace vestige
