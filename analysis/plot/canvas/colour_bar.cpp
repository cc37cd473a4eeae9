#include "analysis/plot/canvas/colour_bar.hpp"

#include <cmath>

#include "analysis/colours/palette.hpp"

namespace vestige::plot {

namespace {

void draw_bar(Canvas& canvas, const Box& box, Ramp ramp, const Axis& axis, const std::vector<Tick>& ticks,
              std::string_view title) {
  const std::size_t steps = print_dots(box.height_pt());
  Raster raster(1, steps, kWhite);
  for (std::size_t row = 0; row < steps; ++row)
    raster.at(0, row) = ramp(1 - (static_cast<double>(row) + 0.5) / static_cast<double>(steps));
  canvas.image(box, raster);
  canvas.frame(box, {kInk, 0.4, Dash::kSolid});
  for (const Tick& tick : ticks) {
    const double y_pt = axis.place_pt(tick.value);
    canvas.line({box.right_pt, y_pt}, {box.right_pt + 2, y_pt}, {kInk, 0.5, Dash::kSolid});
    canvas.text({box.right_pt + 4, y_pt}, tick.label, {7, kInk});
  }
  if (!title.empty()) canvas.text({box.left_pt, box.top_pt + 7}, title, {7, kInk, Anchor::kLeft, Level::kFoot});
}

}  // namespace

void draw_colour_bar(Canvas& canvas, const Box& box, Ramp ramp, double low, double high, std::string_view title) {
  std::vector<Tick> ticks;
  for (const double value : {low, std::round((low + high) / 2), high}) ticks.push_back({value, grouped(value)});
  draw_bar(canvas, box, ramp, {Scale::kLinear, low, high, box.bottom_pt, box.top_pt}, ticks, title);
}

void draw_colour_bar(Canvas& canvas, const Box& box, Ramp ramp, const std::vector<Tick>& ticks, double high,
                     std::string_view title) {
  draw_bar(canvas, box, ramp, {Scale::kLinear, 0, high, box.bottom_pt, box.top_pt}, ticks, title);
}

}  // namespace vestige::plot
