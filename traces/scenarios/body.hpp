#pragma once

#include <cstddef>
#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <limits>
#include <vector>

#include "traces/scene/avatar.hpp"
#include "traces/scene/box.hpp"

namespace vestige {

/// The nearest point of the grid of 2^-20 m (detector/CONTRACT.md, 2).
glm::dvec3 on_grid(const glm::dvec3& position_m);

/// Two directions that, with `direction` (length 1), stand at right angles to each other.
struct Across {
  glm::dvec3 first;
  glm::dvec3 second;
};
Across across(const glm::dvec3& direction);

/// Place `index` of `count` in a disc of radius 1, evenly filled, the first in its middle (Vogel, 1979).
glm::dvec2 disc_place(std::size_t index, std::size_t count);

/// 0 to 1, from rest to rest, as `share` goes from 0 to 1.
double smooth(double share);

/// What scenarios ask of an avatar: its size, and where it is at any time. Holds references to avatar and animation.
class Body {
 public:
  Body(const Avatar& avatar, const Animation* animation);

  const Avatar& avatar() const { return avatar_; }
  const Animation* animation() const { return animation_; }

  /// The box around the avatar when the trace begins.
  const Box& box_m() const { return box_m_; }
  /// The longest side of that box, 0 for an avatar without extent.
  double size_m() const { return size_m_; }

  /// What a metre beside a human being is beside this avatar. 1 if it is between 1 m and 2.5 m long; any other is taken
  /// for a human being of 1.75 m in another unit.
  double metre() const { return metre_; }

  /// After so long the animation begins anew; 0 where nothing moves.
  double loop_s() const { return loop_s_; }
  /// Whether since the last call (since 0) the animation began anew somewhere else than it had ended, so that whatever
  /// goes with the body is suddenly elsewhere too.
  bool jumps(double time_s);

  /// What every palette entry does at `time_s` (before 0: at 0). Good until the next call.
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

}  // namespace vestige
