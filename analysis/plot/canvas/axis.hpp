#pragma once

#include <string>
#include <vector>

#include "analysis/plot/canvas/canvas.hpp"

namespace vestige::plot {

enum class Scale { kLinear, kLog };

/// Maps values in [low, high] to places in [begin_pt, end_pt]. Places may run downwards.
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
  std::string label;  ///< empty: a short tick without label
};

/// These return the largest number not above `value`, and the smallest number not below `value`, that is 1, 2 or 5
/// times a power of ten.
double round_down_125(double value);
double round_up_125(double value);

/// Returns about `wanted` ticks at round steps. `least_step` is 1 for things that are counted. `high` - `low` must be
/// at least a millionth of both.
std::vector<Tick> linear_ticks(double low, double high, int wanted, double least_step = 0);
/// Returns ticks with labels at powers of ten, and also at 2 and 5 times them if the axis is short. Ticks in between
/// have no label.
std::vector<Tick> log_ticks(double low, double high);

/// Returns digits in groups with narrow spaces: 12345 as "12 345".
std::string grouped(double value);
/// "1 contact", "12 345 contacts"
std::string grouped_count(double count, std::string_view thing);

/// The type size of tick labels.
inline constexpr int kTickTypePt = 7;

/// These draw the lower and the left axis of `box` with ticks and titles. `x` and `y` must map to `box`.
void draw_x_axis(Canvas& canvas, const Box& box, const Axis& x, const std::vector<Tick>& ticks, std::string_view title);
void draw_y_axis(Canvas& canvas, const Box& box, const Axis& y, const std::vector<Tick>& ticks, std::string_view title);

}  // namespace vestige::plot
