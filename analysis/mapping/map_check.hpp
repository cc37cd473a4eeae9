#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "analysis/mapping/body.hpp"
#include "detector/actuator_map.hpp"

namespace vestige {

/// A problem makes results wrong; a note may be meant so.
enum class Severity { kNote, kProblem };

struct MapFinding {
  Severity severity = Severity::kNote;
  std::string kind;  ///< "never_fires", "shared_texels", "mirrored_texels", "split", "soft_edges", "position",
                     ///< "texture_coordinates"
  std::uint16_t actuator = 0;  ///< from 1; 0: of the map as a whole
  std::string cause;
  std::string remedy;
};

/// What a map's actuator comes to on a body.
struct CheckedActuator {
  std::string name;
  std::size_t texels = 0;
  std::size_t pieces = 0;  ///< on the body, specks left out
  double area_m2 = 0;
  double shared_m2 = 0;    ///< of which texels also lie on skin far away (kFarApart), …
  double mirrored_m2 = 0;  ///< … and this much on the same place of the other half of the body
};

struct MapCheck {
  std::vector<CheckedActuator> actuators;
  double skin_m2 = 0;
  std::vector<MapFinding> findings;  ///< problems first

  bool good() const;
};

/// Looks a map over on the body that it is for:
/// - actuators that can never fire, since no triangle reaches a texel of theirs (exact) or they have none;
/// - texels that lie on skin far apart: on different pieces of the region, or on the mirror image of the place, which
///   no map can tell apart. Mirrored texels are no problem for an actuator whose `position_m` is in the body's middle;
/// - regions in several pieces, other than specks of less than 1 %;
/// - greys of soft edges: nowhere more than two texels wide;
/// - a `position_m` away from the actuator's skin;
/// - texture coordinates that are not finite, or cover the texture more than once over.
/// Throws `Error` for an avatar without texture coordinates.
MapCheck check_map(const Body& body, const ActuatorMap& map, std::string_view avatar_name);

}  // namespace vestige
