#include "analysis/plot/canvas/small_print.hpp"

namespace vestige::plot {

void draw_small_print(Canvas& canvas, double left_pt, const std::vector<std::string>& lines) {
  double y_pt = 2 + static_cast<double>(lines.size()) * kSmallPrintLinePt;
  for (const std::string& line : lines) {
    canvas.text({left_pt, y_pt}, line, kSmallPrintStyle);
    y_pt -= kSmallPrintLinePt;
  }
}

}  // namespace vestige::plot
