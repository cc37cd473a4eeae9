#include "analysis/plot/canvas/scale_bar.hpp"

#include <fmt/format.h>

#include "analysis/colours/palette.hpp"
#include "analysis/plot/canvas/axis.hpp"

namespace vestige::plot {

void draw_scale_bar(Canvas& canvas, Place left, double metre_per_pt, double most_pt) {
  const double length_m = round_down_125(most_pt * metre_per_pt);
  const Place right = {left.x_pt + length_m / metre_per_pt, left.y_pt};
  const Pen pen = {kInk, 0.8, Dash::kSolid};
  canvas.line(left, right, pen);
  for (const Place& end : {left, right}) canvas.line({end.x_pt, end.y_pt - 2}, {end.x_pt, end.y_pt + 2}, pen);
  const std::string label = length_m < 0.01 ? fmt::format("{:g} mm", length_m * 1000) : fmt::format("{:g} m", length_m);
  canvas.text({right.x_pt + 5, right.y_pt}, label, {7, kInk});
}

}  // namespace vestige::plot
