#pragma once

#include <glm/vec3.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "traces/base/error.hpp"

namespace vestige {

/// A name that is not among the known ones. `what()` lists the known names. A caller that knows what was probably meant
/// adds a hint.
class UnknownName : public Error {
 public:
  UnknownName(std::string_view where, std::string_view what, std::string word, std::vector<std::string> known);
  const std::string& word() const { return word_; }
  const std::vector<std::string>& known() const { return known_; }
  /// Returns the same error with `hint`, such as "did you mean 'x'? ", before the list of known names.
  Error with_hint(const std::string& hint) const;

 private:
  std::string where_;
  std::string what_;
  std::string word_;
  std::vector<std::string> known_;
};

/// The values from `low` up to, but not including, `high`.
struct Extent {
  double low = 0;
  double high = 1;
};

struct RegionGrid {
  std::size_t rows = 1;
  std::size_t columns = 1;
  std::vector<std::string> names;  ///< names row by row, or empty
};

/// An actuator at a place of a region. The place is a point of space (the nearest skin of the region counts), or a
/// height and an angle, counted as the region's own `height` and `angle`.
struct RegionActuator {
  std::string name;
  std::optional<glm::dvec3> position_m;
  double height = 0;
  double angle_degrees = 0;
};

/// A part of the skin, and the actuators on it. A point of the skin belongs to the region if the point meets all
/// criteria that are given.
struct RegionSpec {
  std::string name;
  std::vector<std::string> parts;   ///< one of these parts
  std::vector<std::string> joints;  ///< the strongest joint is one of these; "*" stands for any letters
  std::vector<std::string> below;   ///< or the strongest joint is one of these or a descendant of one
  std::optional<Extent> height;
  std::optional<Extent> height_m;
  std::optional<Extent> angle_degrees;
  std::vector<std::string> sides;  ///< all of these: "front", "back", "left", "right"
  std::optional<RegionGrid> grid;
  std::vector<RegionActuator> actuators;
  std::optional<double> radius_m;
};

/// Reads a region file: {"regions": [REGION, …]}. A point of the skin belongs to the first region that matches it.
/// Regions of one name are one actuator. A region is an object of
///
///     "name": "chest left"             the actuator's name; if there are several, the prefix of their names
///   which skin (without any of these: all of it):
///     "part": "torso"                  vest (the torso from the hips to the shoulders), torso, neck, head, upper arm,
///                                      forearm, hand, thigh, shin or foot, each also with " left" or " right";
///                                      or a list of these
///     "joints": ["spine*"]             the joint that weighs most is one of these; * stands for any letters
///     "below": ["upper_arm_left"]      or the joint is one of these or a descendant of one
///   what part of that skin (all criteria that are given must hold):
///     "height": [0.5, 1]               share of that skin's height: 0 is its lowest point, 1 its highest
///     "height_m": [1.1, 1.3]           metres above the rest pose's y = 0
///     "angle": [-45, 45]               degrees around the vertical through its middle: 0 front, 90 left, 180 back,
///                                      270 or -90 right
///     "side": "front"                  or back, left, right; or a list, such as ["front", "left"]
///   how many actuators (without any of these: one):
///     "grid": {"rows": 5, "columns": 4, "names": […]}   equal heights from the top down, equal angles in the angle's
///                                      direction (in front from right to left, behind from left to right)
///     "actuators": [{"name": "heart", "position_m": [0.05, 1.3, 0.1]}, {"name": "navel", "height": 0.2, "angle": 0}]
///                                      each has the skin that is nearest to it along the surface
///     "radius_m": 0.06                 …, and at most this far away
///
/// Beside "regions", "fires" says which regions fire other actuators than their own (`Firing`).
///
/// Throws `Error` if the text is not JSON, has a word that does not exist, or has a value that is not possible. The
/// error says which region and which of its words is wrong. `name` appears in it.
std::vector<RegionSpec> parse_region_file(std::string_view json, std::string_view name);

/// Returns the JSON of "fires" beside the regions, which goes into the map's sidecar (`Firing`); empty without one.
/// Precondition: `parse_region_file` has taken the text.
std::string fires_of_region_file(std::string_view json);

}  // namespace vestige
