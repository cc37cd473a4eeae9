#pragma once

#include <span>
#include <string>

#include "analysis/viz/seen.hpp"

namespace vestige {

/// Returns the layout that Foxglove and Lichtblick import for a `VizTrace` of these people, as JSON: a 3D panel in
/// which the first person stands upright in the middle, a plot of the duties in the colours of the regions, and the
/// contacts as raw messages.
std::string viewer_layout(std::span<const MappedPerson> people);

}  // namespace vestige
