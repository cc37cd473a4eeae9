#include "analysis/plot/canvas/heat.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "analysis/colours/palette.hpp"
#include "analysis/plot/canvas/axis.hpp"
#include "analysis/plot/canvas/colour_bar.hpp"

namespace vestige::plot {

namespace {

/// Two significant digits, without an exponent.
std::string two_digits(double value) {
  const double decimals = std::clamp(1 - std::floor(std::log10(value)), 0.0, 9.0);
  return fmt::format("{:.{}f}", value, static_cast<int>(decimals));
}

}  // namespace

Colour heat_ramp(double part) {
  struct Stop {
    double part;
    Colour colour;
  };
  constexpr std::array<Stop, 5> kStops = {
      {{0, {222, 220, 217}}, {0.2, {253, 206, 110}}, {0.45, {236, 130, 30}}, {0.72, {190, 40, 30}}, {1, {80, 4, 40}}}};
  std::size_t i = 1;
  while (i + 1 < kStops.size() && part > kStops[i].part) ++i;
  const double between = (part - kStops[i - 1].part) / (kStops[i].part - kStops[i - 1].part);
  return blend(kStops[i - 1].colour, kStops[i].colour, std::clamp(between, 0.0, 1.0));
}

AreaUnit unit_for(double extent_m) {
  if (extent_m < 0.3) return {"cm²", 0.01};
  return extent_m < 20 ? AreaUnit{"dm²", 0.1} : AreaUnit{"m²", 1};
}

double heat_bar_high(double highest) {
  if (!(highest > 0)) return 1;
  const double high = round_up_125(highest);
  // Half of a bar unused would waste its colours.
  return high > 1.5 * highest ? std::ceil(highest / high * 10) * high / 10 : high;
}

void draw_heat_bar(Canvas& canvas, Place top_left, double height_pt, double high, double extent_m) {
  const double left_pt = top_left.x_pt;
  const double bar_top_pt = top_left.y_pt - 24;
  const Box bar = {left_pt, bar_top_pt - height_pt, left_pt + 7, bar_top_pt};
  draw_colour_bar(canvas, bar, heat_ramp, linear_ticks(0, high, 5), high, "");
  canvas.text({left_pt, bar_top_pt + 16}, "contacts", {7, kInk, Anchor::kLeft, Level::kFoot});
  canvas.text({left_pt, bar_top_pt + 7}, fmt::format("per {}", unit_for(extent_m).name),
              {7, kInk, Anchor::kLeft, Level::kFoot});
  const double sigma_m = kHeatSigma * extent_m;
  canvas.text({left_pt, bar.bottom_pt - 11}, "spread by", {7, kSmallPrint, Anchor::kLeft, Level::kFoot});
  canvas.text({left_pt, bar.bottom_pt - 20},
              sigma_m < 0.1 ? two_digits(sigma_m * 1000) + " mm (σ)" : two_digits(sigma_m) + " m (σ)",
              {7, kSmallPrint, Anchor::kLeft, Level::kFoot});
}

}  // namespace vestige::plot
