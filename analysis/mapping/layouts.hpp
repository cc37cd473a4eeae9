#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "analysis/mapping/map_maker.hpp"
#include "detector/actuator_map.hpp"
#include "traces/scene/avatar.hpp"

namespace vestige {

/// Returns the names of the layouts that Vestige can lay onto an avatar: "paper6" (three heights, right and left: HAVE
/// 2010, Fig. 4), "torso16" (two rings of eight around the torso), "torso40" (five rows of four in front, five behind)
/// and "body" (head, torso and limbs).
std::vector<std::string> layout_names();

/// Returns one line that describes the layout.
std::string layout_summary(std::string_view layout);

/// Returns all layouts as "\n  NAME  SUMMARY" lines for help texts.
std::string layout_list();

bool is_layout(std::string_view map);

/// Returns the layout on this avatar as the two files of a map, with names, positions and warnings. The same avatar
/// gives the same bytes. The map has 1024 x 1024 texels in the avatar's UV space. It has one texel for each triangle
/// instead in three cases:
/// - The avatar has no UV space.
/// - The triangles cover the texture more than four times over. A warning says so.
/// - More than 5 % of the layout's skin would fire another actuator. A warning says so. If one texel for each triangle
///   would leave out more actuators, the map keeps its UV space.
///
/// Throws `Error` if there is no such layout, if the avatar does not stand (`AvatarFacing::lies_deg`), if a region has
/// no skin (see `layout_empty_regions`), or if all regions have no skin.
ActuatorMapFiles make_layout(const Avatar& avatar, std::string_view layout);

/// As `make_layout`, but returns everything that is known about how the map was made. Calls `progress` with the
/// finished share, unless it is empty.
MadeMap make_layout_map(const Avatar& avatar, std::string_view layout, const WorkProgress& progress = {});

/// Returns what happens to the layout's regions that an avatar has no skin for.
EmptyRegions layout_empty_regions(std::string_view layout);

/// Returns the layout's regions as a region file (analysis/mapping/region_file.hpp). Users can start their own file
/// with it.
std::string layout_regions_json(std::string_view layout);

/// Reads a map. `map` is a layout's name, or what `read_actuator_map_files` takes. Throws `Error`, which lists the
/// layouts if `map` may be one of them, misspelt.
ActuatorMapFiles read_map_files(const Avatar& avatar, const std::string& map);

}  // namespace vestige
