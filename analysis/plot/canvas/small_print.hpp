#pragma once

#include <string>
#include <vector>

#include "analysis/colours/palette.hpp"
#include "analysis/plot/canvas/canvas.hpp"

namespace vestige::plot {

inline constexpr TextStyle kSmallPrintStyle = {6, kSmallPrint, Anchor::kLeft, Level::kTop};
inline constexpr double kSmallPrintLinePt = 8;

/// Draws the lines that explain a figure, in kSmallPrintStyle, at its foot.
void draw_small_print(Canvas& canvas, double left_pt, const std::vector<std::string>& lines);

}  // namespace vestige::plot
