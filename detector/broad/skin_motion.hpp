#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "detector/decision.hpp"
#include "detector/frame.hpp"
#include "detector/method.hpp"
#include "traces/scene/avatar.hpp"

namespace vestige {

/// The skinned vertices of one frame by the contract (detector/CONTRACT.md, 3), and those of the previous frame. Both
/// are relative to this frame's origin.
struct SkinMotion {
  std::vector<glm::vec3> before;  ///< stays empty for `kStatic`
  std::vector<glm::vec3> now;

  void skin(const Avatar& avatar, const DetectorFrame& frame, Method method);
};

/// The corners of one triangle of the skin, in the previous frame and now. With `kStatic`, which does not use the
/// previous frame, both are the corners now.
struct MovingCorners {
  Corners before;
  Corners now;
};

Corners corners_of(const Avatar& avatar, std::span<const glm::vec3> vertices, std::uint32_t triangle);

/// `skin` must come from `SkinMotion::skin` with the same method.
MovingCorners moving_corners(const Avatar& avatar, const SkinMotion& skin, Method method, std::uint32_t triangle);

/// Skins only this triangle. Returns the same bits as `moving_corners`.
MovingCorners skin_corners(const Avatar& avatar, const DetectorFrame& frame, Method method, std::uint32_t triangle);

/// Returns the triangle at time t of a frame in which its corners move linearly, in fp64.
Corners corners_at(const Corners& before, const Corners& now, float t);

/// Returns the mean of the corners' displacements, in fp64.
glm::dvec3 carried_displacement(const Corners& before, const Corners& now);

/// Returns the start of a `kCarried` segment: `start` moved by `carried_displacement`, rounded once to fp32.
glm::vec3 carried_start(const glm::vec3& start, const Corners& before, const Corners& now);

}  // namespace vestige
