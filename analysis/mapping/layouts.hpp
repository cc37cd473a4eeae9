#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "analysis/mapping/map_maker.hpp"
#include "detector/actuator_map.hpp"
#include "traces/scene/avatar.hpp"

namespace vestige {

/// The layouts that Vestige can lay onto any avatar with texture coordinates, by name: "paper6" (three heights, right
/// and left: HAVE 2010, Fig. 4), "torso16" (two rings of eight around the torso), "torso40" (five rows of four in
/// front, five behind) and "body" (head, torso and limbs).
std::vector<std::string> layout_names();

/// A line about what it is.
std::string layout_summary(std::string_view layout);

/// All of them, "\n  NAME  SUMMARY" each, for help texts.
std::string layout_list();

bool is_layout(std::string_view map);

/// The layout on this avatar, as the two files of a map, with names, positions and warnings; the same bytes for the
/// same avatar. 1024 x 1024 texels in its UV space; or per triangle, where there is none or more than 5 % of the
/// layout's skin would fire another actuator. Throws `Error`: no such layout, a region without skin
/// (`layout_empty_regions`), no skin for any.
ActuatorMapFiles make_layout(const Avatar& avatar, std::string_view layout);

/// The same, with all that is known of how it was made.
MadeMap make_layout_map(const Avatar& avatar, std::string_view layout);

/// What becomes of its regions that an avatar has no skin for.
EmptyRegions layout_empty_regions(std::string_view layout);

/// The layout's regions, as a region file says them (analysis/mapping/region_file.hpp): to begin one's own with.
std::string layout_regions_json(std::string_view layout);

/// `map`: a layout's name, or what `read_actuator_map_files` takes. Throws `Error`.
ActuatorMapFiles read_map_files(const Avatar& avatar, const std::string& map);

}  // namespace vestige
