#pragma once

#include <memory>
#include <vector>

#include "analysis/plot/canvas/figure.hpp"
#include "analysis/plot/studio/subject.hpp"
#include "detector/output/contacts_csv.hpp"

namespace vestige::plot {

struct Body {
  Subject subject;
  bool has_contacts = false;
  std::vector<RecordedContact> contacts;  ///< of the avatar's triangles
};

/// The avatar at rest, from the front and from behind (of one that is longer than wide, both sides): the regions of its
/// map, texel by texel as the detectors look them up, and where contacts lie and how dense.
std::unique_ptr<Figure> body_figure(Body body);

}  // namespace vestige::plot
