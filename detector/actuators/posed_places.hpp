#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <optional>
#include <span>
#include <vector>

#include "detector/frame.hpp"
#include "detector/skinning.hpp"
#include "traces/places/skin.hpp"
#include "traces/scene/avatar.hpp"

namespace vestige {

/// An actuator whose place on the skin a sphere covers at the end of the frame.
struct CoveredPlace {
  std::uint32_t actuator = 0;  ///< from 0
  double depth_m = 0;          ///< the sphere's radius minus the distance from its centre; above 0

  friend bool operator==(const CoveredPlace&, const CoveredPlace&) = default;
};

/// Places on the skin that move with it.
class PosedPlaces {
 public:
  PosedPlaces() = default;
  PosedPlaces(const Avatar& avatar, std::span<const std::optional<SkinPoint>> places);

  /// Moves the places with the skin under a palette, relative to the palette's origin.
  void move(std::span<const SkinMatrix> palette);
  /// Where they were moved last; nothing if there is no such place.
  const std::vector<std::optional<glm::dvec3>>& now() const { return now_; }
  /// Adds to `covered` the places that the sphere of a column covers at the end of the frame that the places were moved
  /// for. Precondition: the frame tests that column.
  void covered_by(std::uint32_t column, const DetectorFrame& frame, std::vector<CoveredPlace>& covered) const;

 private:
  std::vector<std::optional<glm::dvec3>> weights_;  ///< of the three corners of each place
  Avatar corners_;                                  ///< only vertices: three for each place
  std::vector<std::optional<glm::dvec3>> now_;
};

}  // namespace vestige
