#pragma once

#include <cstddef>
#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <limits>
#include <optional>
#include <vector>

#include "traces/scene/avatar.hpp"
#include "traces/scene/box.hpp"

namespace vestige {

/// Returns the nearest point of the grid of 2^-20 m (detector/CONTRACT.md, 2).
glm::dvec3 on_grid(const glm::dvec3& position_m);

/// Two directions perpendicular to each other and to `direction` (length 1).
struct Across {
  glm::dvec3 first;
  glm::dvec3 second;
};
Across across(const glm::dvec3& direction);

/// Returns place `index` of `count` in a disc of radius 1, evenly filled, the first in its centre (Vogel, 1979).
glm::dvec2 disc_place(std::size_t index, std::size_t count);

/// Goes from 0 to 1 as `share` does, with speed 0 at both ends.
double smooth(double share);

/// The properties of an avatar that scenarios need: its size, and its pose at any time. Keeps references to avatar and
/// animation.
class MovingBody {
 public:
  MovingBody(const Avatar& avatar, const Animation* animation);

  const Avatar& avatar() const { return avatar_; }
  const Animation* animation() const { return animation_; }

  /// The bounding box of the avatar at the beginning of the trace.
  const Box& box_m() const { return box_m_; }
  /// The longest side of that box, 0 for an avatar without extent.
  double size_m() const { return size_m_; }

  /// The length that corresponds to one metre beside a human being. 1 if the avatar is between 1 m and 2.5 m long. Any
  /// other avatar counts as a human being of 1.75 m in another unit.
  double metre() const { return metre_; }

  /// The duration after which the animation starts again; 0 if nothing moves.
  double loop_s() const { return loop_s_; }
  /// Whether, since the last call (or since 0), the animation restarted at a place other than its end, so that
  /// everything moving with the body jumps, too.
  bool jumps(double time_s);

  /// The palette matrices at `time_s` (before 0: at 0), valid until the next call.
  const std::vector<glm::dmat4>& palette(double time_s);

 private:
  const Avatar& avatar_;
  const Animation* animation_;
  Box box_m_;
  double size_m_ = 0;
  double metre_ = 1;
  double loop_s_ = 0;
  bool ends_elsewhere_ = false;
  double last_s_ = 0;
  double palette_s_ = std::numeric_limits<double>::quiet_NaN();
  std::vector<glm::dmat4> palette_;
};

/// Returns the radius of a scenario's spheres: the one asked for or, without one, `usual_m` beside a human being.
/// Throws `UsageError` if the body is so large that this is larger than a radius may be.
float sphere_radius_m(const MovingBody& body, const std::optional<float>& asked_m, double usual_m);

}  // namespace vestige
