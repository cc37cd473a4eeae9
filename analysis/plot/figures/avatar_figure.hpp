#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "analysis/plot/canvas/figure.hpp"
#include "analysis/plot/studio/subject.hpp"

namespace vestige::plot {

/// The content of a contact sheet of an avatar: the poses of each animation, evenly spaced over its duration.
struct ContactSheet {
  Subject subject;
  std::vector<const Animation*> animations;  ///< of the subject's avatar; null: the rest pose
  std::size_t poses = 6;                     ///< number for each animation

  /// Returns the animations to show. `animation` is a name, an index, "none" (the rest pose), or empty: all animations,
  /// or the rest pose if the avatar has none. Throws `UsageError` that lists the animations if there is no such
  /// animation.
  static std::vector<const Animation*> choose(const Avatar& avatar, const std::string& animation);
};

/// Draws poses from left to right, each from the front, from half-left, from the left and from behind. All have one
/// scale and stand on one ground.
std::unique_ptr<Figure> avatar_figure(const ContactSheet& sheet);

}  // namespace vestige::plot
