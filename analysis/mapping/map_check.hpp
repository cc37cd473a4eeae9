#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "analysis/mapping/body.hpp"
#include "detector/actuator_map.hpp"

namespace vestige {

/// A problem makes results wrong. A note may be intended.
enum class Severity { kNote, kProblem };

struct MapFinding {
  Severity severity = Severity::kNote;
  std::string kind;  ///< "never_fires", "shared_texels", "mirrored_texels", "split", "soft_edges", "position",
                     ///< "texture_coordinates", "wrong_side", "facing"
  std::uint16_t actuator = 0;  ///< from 1; 0: the finding is about the whole map
  std::string cause;
  std::string remedy;
};

/// What an actuator of a map covers on a body.
struct CheckedActuator {
  std::string name;
  std::size_t texels = 0;
  std::size_t pieces = 0;  ///< connected pieces on the body, without specks
  double area_m2 = 0;
  double shared_m2 = 0;    ///< skin whose texels also lie on skin far away (kFarApart)
  double mirrored_m2 = 0;  ///< part of `shared_m2` on the mirrored place of the body's other half
};

struct MapCheck {
  std::vector<CheckedActuator> actuators;
  double skin_m2 = 0;
  std::vector<MapFinding> findings;  ///< problems first

  bool good() const;
};

/// Checks a map on the body that it is for. Finds:
/// - actuators that can never fire, since they have no texel or no triangle reaches a texel of theirs (exact);
/// - texels that lie on skin far apart: on different pieces of the region, or on the mirror image of the place, which a
///   map cannot tell apart. Mirrored texels are no problem for an actuator whose `position_m` is in the body's middle;
/// - regions in several pieces. Specks of less than 1 % of the region do not count as pieces;
/// - greys that come from soft edges: nowhere more than two texels wide;
/// - a `position_m` away from the actuator's skin;
/// - a map that was made for another facing than the body's;
/// - regions named left whose middle lies on the side of the joints named right, and the other way round;
/// - texture coordinates that are not finite, or cover the texture more than once over.
/// Throws `Error` if the avatar has no texture coordinates and the map is not per triangle.
MapCheck check_map(const Body& body, const ActuatorMap& map, std::string_view avatar_name);

}  // namespace vestige
