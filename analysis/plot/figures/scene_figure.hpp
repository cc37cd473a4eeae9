#pragma once

#include <memory>
#include <vector>

#include "analysis/plot/canvas/figure.hpp"
#include "analysis/plot/scene/scene_moments.hpp"
#include "analysis/plot/studio/subject.hpp"

namespace vestige::plot {

/// kKind: paths, segments and contacts have a colour each. kCollider: each collider has its own.
enum class ColourBy { kKind, kCollider };

struct Scene {
  std::vector<Subject> subjects;  ///< the people, at least one
  std::vector<Moment> moments;    ///< at least one; all of these people
  double trail_s = 0.1;
  bool has_contacts = false;
  ColourBy colour_by = ColourBy::kKind;
};

/// Draws a film strip: the avatar at each moment from half-left, several people from the side of the first, with the
/// paths of the colliders, the segments that are tested, and the contacts on the skin. What the body hides is pale.
std::unique_ptr<Figure> scene_figure(const Scene& scene);

}  // namespace vestige::plot
