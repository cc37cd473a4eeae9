#pragma once

#include <cstddef>
#include <glm/vec3.hpp>
#include <optional>
#include <span>
#include <vector>

#include "detector/skinning.hpp"
#include "traces/scenarios/skin.hpp"
#include "traces/scene/avatar.hpp"

namespace vestige {

/// Places on the skin that move with it.
class PosedPlaces {
 public:
  PosedPlaces() = default;
  PosedPlaces(const Avatar& avatar, std::span<const std::optional<SkinPoint>> places);

  /// Moves the places with the skin under a palette, relative to the palette's origin.
  void move(std::span<const SkinMatrix> palette);
  /// Where they were moved last; nothing if there is no such place.
  const std::vector<std::optional<glm::dvec3>>& now() const { return now_; }

 private:
  std::vector<std::optional<glm::dvec3>> weights_;  ///< of the three corners of each place
  Avatar corners_;                                  ///< only vertices: three for each place
  std::vector<std::optional<glm::dvec3>> now_;
};

}  // namespace vestige
