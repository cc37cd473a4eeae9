#include "analysis/plot/growth_figure.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <sstream>
#include <utility>

#include "analysis/plot/axis.hpp"
#include "analysis/plot/palette.hpp"

namespace vestige::plot {

namespace {

constexpr double kWidthPt = 468;
constexpr double kMarginPt = 8;
constexpr double kLeftPt = 48;
constexpr double kPanelGapPt = 22;
constexpr double kPlotHeightPt = 190;
constexpr double kTitlePt = 14;
constexpr double kAxisRoomPt = 34;
constexpr double kLegendLinePt = 11;
constexpr double kLegendColumnPt = 150;
constexpr std::size_t kLegendColumns = 3;
constexpr double kSmallLinePt = 8;

constexpr TextStyle kTitleStyle = {8, kInk, Anchor::kLeft, Level::kFoot, Weight::kBold};
constexpr TextStyle kLegendStyle = {7, kInk, Anchor::kLeft, Level::kMiddle};
constexpr TextStyle kSmallStyle = {6, kSmallPrint, Anchor::kLeft, Level::kTop};

/// Breaks `text` at spaces into lines of the small print.
std::vector<std::string> wrapped(const std::string& text) {
  std::vector<std::string> lines;
  std::string line;
  std::istringstream words(text);
  for (std::string word; words >> word;) {
    const std::string longer = line.empty() ? word : fmt::format("{} {}", line, word);
    if (!line.empty() && text_width_pt(longer, kSmallStyle) > kWidthPt - 2 * kMarginPt) {
      lines.push_back(line);
      line = word;
    } else {
      line = longer;
    }
  }
  lines.push_back(line);
  return lines;
}

std::vector<std::string> small_print(const GrowthResult& result) {
  std::string text =
      "Mean of a frame, whole round trip. Triangles: the avatar's, each split into four again and again. ";
  if (!result.renderer.empty()) text += fmt::format("OpenGL: {}. ", result.renderer);
  if (!result.machine.empty()) text += fmt::format("Machine: {}. ", result.machine);
  text += fmt::format("Avatar: {}. Commit\u00a0{}.", result.avatar, result.commit);
  return wrapped(text);
}

class GrowthFigure : public Figure {
 public:
  explicit GrowthFigure(GrowthResult result) : result_(std::move(result)), small_print_(small_print(result_)) {}

  double width_pt() const override { return kWidthPt; }
  double height_pt() const override {
    return kMarginPt + kTitlePt + kPlotHeightPt + kAxisRoomPt + legend_pt() +
           static_cast<double>(small_print_.size()) * kSmallLinePt + 4;
  }
  std::string description() const override {
    std::string text = "Microseconds a frame.";
    for (const GrowthPanel& panel : result_.panels)
      for (const GrowthLine& line : panel.lines)
        text += fmt::format(" {}, {} {:.0f}: {:.4g}.", name(line), panel.along, line.points.back().size,
                            line.points.back().us);
    return text;
  }

  void draw(Canvas& canvas) const override {
    const double top_pt = height_pt() - kMarginPt - kTitlePt;
    const double panel_pt = (kWidthPt - kLeftPt - kPanelGapPt - kMarginPt) / 2;
    double left_pt = kLeftPt;
    for (std::size_t i = 0; i < result_.panels.size(); ++i) {
      draw_panel(canvas, i, {left_pt, top_pt - kPlotHeightPt, left_pt + panel_pt, top_pt});
      left_pt += panel_pt + kPanelGapPt;
    }
    draw_legend(canvas, top_pt - kPlotHeightPt - kAxisRoomPt - kLegendLinePt / 2);
    double y_pt = 2 + static_cast<double>(small_print_.size()) * kSmallLinePt;
    for (const std::string& line : small_print_) {
      canvas.text({kMarginPt, y_pt}, line, kSmallStyle);
      y_pt -= kSmallLinePt;
    }
  }

 private:
  const std::vector<GrowthLine>& lines() const { return result_.panels.front().lines; }
  double legend_pt() const {
    const std::size_t rows = (lines().size() + kLegendColumns - 1) / kLegendColumns;
    return static_cast<double>(rows) * kLegendLinePt + 4;
  }

  bool has_twin(const GrowthLine& line) const {
    return std::ranges::any_of(lines(), [&](const GrowthLine& one) {
      return one.detector == line.detector && one.context == line.context && one.skip != line.skip;
    });
  }
  Dash dash(const GrowthLine& line) const {
    return line.skip == "off" && has_twin(line) ? Dash::kDashed : Dash::kSolid;
  }
  std::string name(const GrowthLine& line) const {
    std::string text = line.context.empty() ? line.detector : fmt::format("{}, {}", line.detector, line.context);
    if (dash(line) == Dash::kDashed) text += ", no skipping";
    return text;
  }
  Colour colour(const GrowthLine& line) const {
    std::vector<std::pair<std::string, std::string>> kinds;
    for (const GrowthLine& one : lines())
      if (std::ranges::find(kinds, std::pair(one.detector, one.context)) == kinds.end())
        kinds.emplace_back(one.detector, one.context);
    const auto found = std::ranges::find(kinds, std::pair(line.detector, line.context));
    return kLineColours[static_cast<std::size_t>(found - kinds.begin()) % kLineColours.size()];
  }

  /// The same for both panels, so that heights compare.
  Axis y_axis(const Box& plot) const {
    double least = 1e12;
    double most = 0;
    for (const GrowthPanel& panel : result_.panels)
      for (const GrowthLine& line : panel.lines)
        for (const GrowthPoint& point : line.points) {
          least = std::min(least, point.us);
          most = std::max(most, point.us);
        }
    return {Scale::kLog, round_down_125(least * 0.9), round_up_125(most * 1.1), plot.bottom_pt, plot.top_pt};
  }

  static Axis x_axis(const GrowthPanel& panel, const Box& plot) {
    double least = 1e12;
    double most = 1;
    for (const GrowthLine& line : panel.lines) {
      least = std::min(least, line.points.front().size);
      most = std::max(most, line.points.back().size);
    }
    return {Scale::kLog, least * 0.85, most * 1.2, plot.left_pt, plot.right_pt};
  }

  void draw_panel(Canvas& canvas, std::size_t index, const Box& plot) const {
    const GrowthPanel& panel = result_.panels[index];
    const Axis x = x_axis(panel, plot);
    const Axis y = y_axis(plot);
    const std::vector<Tick> x_ticks = log_ticks(x.low, x.high);
    std::vector<Tick> y_ticks = log_ticks(y.low, y.high);
    for (const Tick& tick : y_ticks)
      if (!tick.label.empty())
        canvas.line({plot.left_pt, y.place_pt(tick.value)}, {plot.right_pt, y.place_pt(tick.value)},
                    {kGrid, 0.4, Dash::kSolid});
    for (const Tick& tick : x_ticks)
      if (!tick.label.empty())
        canvas.line({x.place_pt(tick.value), plot.bottom_pt}, {x.place_pt(tick.value), plot.top_pt},
                    {kGrid, 0.4, Dash::kSolid});
    if (index > 0)
      for (Tick& tick : y_ticks) tick.label.clear();  // the first panel's
    draw_x_axis(canvas, plot, x, x_ticks, panel.along);
    draw_y_axis(canvas, plot, y, y_ticks, index == 0 ? "Cost of a frame (\u00b5s)" : "");
    canvas.text({plot.left_pt, plot.top_pt + 4},
                index == 0 ? result_.avatar : fmt::format("{} colliders", grouped(result_.colliders)), kTitleStyle);
    for (const GrowthLine& line : panel.lines) {
      std::vector<Place> places;
      places.reserve(line.points.size());
      for (const GrowthPoint& point : line.points) places.push_back({x.place_pt(point.size), y.place_pt(point.us)});
      canvas.polyline(places, {colour(line), 1.2, dash(line)});
      for (const Place& place : places) canvas.mark(place, Mark::kCircle, 3.6, colour(line), kWhite);
    }
  }

  void draw_legend(Canvas& canvas, double top_pt) const {
    for (std::size_t i = 0; i < lines().size(); ++i) {
      const double left_pt = kMarginPt + static_cast<double>(i % kLegendColumns) * kLegendColumnPt;
      const std::size_t row = i / kLegendColumns;
      const double y_pt = top_pt - static_cast<double>(row) * kLegendLinePt;
      canvas.line({left_pt, y_pt}, {left_pt + 14, y_pt}, {colour(lines()[i]), 1.2, dash(lines()[i])});
      canvas.text({left_pt + 18, y_pt}, name(lines()[i]), kLegendStyle);
    }
  }

  GrowthResult result_;
  std::vector<std::string> small_print_;
};

}  // namespace

std::unique_ptr<Figure> growth_figure(GrowthResult result) {
  return std::make_unique<GrowthFigure>(std::move(result));
}

}  // namespace vestige::plot
