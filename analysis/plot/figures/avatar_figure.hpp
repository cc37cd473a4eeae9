#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "analysis/plot/canvas/figure.hpp"
#include "analysis/plot/studio/subject.hpp"

namespace vestige::plot {

/// What a contact sheet shows of an avatar: the poses of each animation, evenly over its duration.
struct ContactSheet {
  Subject subject;
  std::vector<const Animation*> animations;  ///< of the subject's avatar; null: its rest pose
  std::size_t poses = 6;                     ///< of each animation

  /// `animation`: a name, an index, "none" (the rest pose) or empty: all, of which there may be none. Throws
  /// `UsageError` listing what there is.
  static std::vector<const Animation*> choose(const Avatar& avatar, const std::string& animation);
};

/// Poses from the left to the right, each from the front, from half-left, from the left and from behind, all to one
/// scale, standing on one ground.
std::unique_ptr<Figure> avatar_figure(const ContactSheet& sheet);

}  // namespace vestige::plot
