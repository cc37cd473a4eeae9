#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "analysis/plot/canvas/canvas.hpp"
#include "analysis/plot/scene/crowd.hpp"
#include "analysis/plot/scene/scene_moments.hpp"
#include "analysis/plot/scene/scene_sight.hpp"
#include "analysis/plot/studio/camera.hpp"

namespace vestige::plot {

/// Whether contacts fade with their age, or are all alike.
enum class ContactMarks { kAlike, kFading };

/// Whether a dark line parts regions.
enum class Borders { kNone, kRegions };

/// How the moments of a scene are drawn.
struct MomentStyle {
  double trail_s = 0.1;  ///< after it paths are gone
  double fade_s = 0.1;   ///< after it contacts that fade are gone
  ContactMarks marks = ContactMarks::kAlike;
  Borders borders = Borders::kNone;
  double dots_per_pt = kPrintDotsPerInch / 72;  ///< of the widths of lines and marks
  std::vector<std::uint32_t> colliders;         ///< ascending; those that occur
  /// Colliders take these in turn; as many of one as of the other, at least one.
  std::vector<Colour> path_colours;
  std::vector<Colour> contact_colours;
};

/// The size of a contact's mark.
inline constexpr double kContactPt = 3.2;

/// What the skin of the people of a scene looks like.
struct Skin {
  const std::vector<Subject>& people;
  /// Returns the colour, before light, of the region of an actuator of a person, who is counted from 0. Actuator 0 is
  /// skin without an actuator.
  std::function<Colour(std::size_t person, std::uint16_t actuator)> colour_of;
};

/// Returns the pale colour of an actuator's region; for 0, that of skin.
Colour region_skin(const Subject& subject, std::uint16_t actuator);

/// Draws one moment: the people, the paths of the colliders, the segments that are tested, and the contacts on the skin
/// as it is now. What the body hides is pale. `crowd` is posed as at the moment.
Raster moment_picture(const Moment& moment, const Crowd& crowd, const SceneSight& sight, const View& view,
                      const MomentStyle& style, const Skin& skin);

}  // namespace vestige::plot
