#include "analysis/plot/colour_bar.hpp"

#include <cmath>

#include "analysis/plot/axis.hpp"
#include "analysis/plot/palette.hpp"

namespace vestige::plot {

void draw_colour_bar(Canvas& canvas, const Box& box, Ramp ramp, double low, double high, std::string_view title) {
  const std::size_t steps = print_dots(box.height_pt());
  Raster raster(1, steps, kWhite);
  for (std::size_t row = 0; row < steps; ++row)
    raster.at(0, row) = ramp(1 - (static_cast<double>(row) + 0.5) / static_cast<double>(steps));
  canvas.image(box, raster);
  canvas.frame(box, {kInk, 0.4, Dash::kSolid});
  const Axis axis = {Scale::kLinear, low, high, box.bottom_pt, box.top_pt};
  for (const double value : {low, std::round((low + high) / 2), high}) {
    const double y_pt = axis.place_pt(value);
    canvas.line({box.right_pt, y_pt}, {box.right_pt + 2, y_pt}, {kInk, 0.5, Dash::kSolid});
    canvas.text({box.right_pt + 4, y_pt}, grouped(value), {7, kInk});
  }
  canvas.text({box.left_pt, box.top_pt + 7}, title, {7, kInk, Anchor::kLeft, Level::kFoot});
}

}  // namespace vestige::plot
