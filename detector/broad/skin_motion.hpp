#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

#include "detector/decision.hpp"
#include "detector/frame.hpp"
#include "detector/method.hpp"
#include "traces/scene/avatar.hpp"

namespace vestige {

/// The skin of one frame as the contract has it (detector/CONTRACT.md, 3), and what it was in the frame before, both
/// relative to the frame's origin.
struct SkinMotion {
  std::vector<glm::vec3> before;  ///< stays empty for `kStatic`
  std::vector<glm::vec3> now;

  void skin(const Avatar& avatar, const Frame& frame, Method method);
};

/// The corners of one triangle of that skin, in the frame before and now. `kStatic` looks at no frame before: both are
/// the same then.
struct MovingCorners {
  Corners before;
  Corners now;
};

Corners corners_of(const Avatar& avatar, const std::vector<glm::vec3>& vertices, std::uint32_t triangle);

/// `skin` as `SkinMotion::skin` made it with the same method.
MovingCorners moving_corners(const Avatar& avatar, const SkinMotion& skin, Method method, std::uint32_t triangle);

/// The same bits, where nothing but this triangle is skinned.
MovingCorners skin_corners(const Avatar& avatar, const Frame& frame, Method method, std::uint32_t triangle);

/// The triangle at time t of a frame in which its corners move linearly; in fp64.
Corners corners_at(const Corners& before, const Corners& now, float t);

/// The mean of the corners' displacements, in fp64.
glm::dvec3 carried_displacement(const Corners& before, const Corners& now);

/// Where a `kCarried` segment starts: `start` moved by `carried_displacement`, rounded once to fp32.
glm::vec3 carried_start(const glm::vec3& start, const Corners& before, const Corners& now);

}  // namespace vestige
