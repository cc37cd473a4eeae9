#pragma once

#include <memory>
#include <vector>

#include "analysis/plot/canvas/figure.hpp"
#include "analysis/plot/studio/subject.hpp"
#include "detector/output/recorded_contacts.hpp"

namespace vestige::plot {

struct Body {
  Subject subject;
  bool has_contacts = false;
  std::vector<RecordedContact> contacts;  ///< on the avatar's triangles
};

/// Draws the avatar at rest from the front and from behind, or from both sides if it is longer than wide. Shows the
/// regions of its map, texel by texel as the detectors look them up, and where and how densely contacts lie.
std::unique_ptr<Figure> body_figure(Body body);

}  // namespace vestige::plot
