#pragma once

#include <string>
#include <vector>

#include "analysis/plot/canvas/canvas.hpp"

namespace vestige::plot {

enum class Scale { kLinear, kLog };

/// Maps values in [low, high] to places in [begin_pt, end_pt] (which may run downwards).
struct Axis {
  Scale scale = Scale::kLinear;
  double low = 0;
  double high = 1;
  double begin_pt = 0;
  double end_pt = 1;

  double place_pt(double value) const;
};

struct Tick {
  double value = 0;
  std::string label;  ///< empty: a short tick without one
};

/// The largest number 1, 2 or 5 times a power of ten that is not above `value`, and the smallest not below it.
double round_down_125(double value);
double round_up_125(double value);

/// Ticks at round steps, about `wanted` of them; `least_step` 1 for things that are counted.
/// `high` - `low` is at least a millionth of both.
std::vector<Tick> linear_ticks(double low, double high, int wanted, double least_step = 0);
/// Labelled at powers of ten (at 2 and 5 times them too where the axis is short), unlabelled between.
std::vector<Tick> log_ticks(double low, double high);

/// 12345 as "12 345", with narrow spaces.
std::string grouped(double value);

/// What their labels are set in.
inline constexpr int kTickTypePt = 7;

/// The lower and left axis of `box` with their ticks and titles; `x` and `y` must map to `box`.
void draw_x_axis(Canvas& canvas, const Box& box, const Axis& x, const std::vector<Tick>& ticks, std::string_view title);
void draw_y_axis(Canvas& canvas, const Box& box, const Axis& y, const std::vector<Tick>& ticks, std::string_view title);

}  // namespace vestige::plot
