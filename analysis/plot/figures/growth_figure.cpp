#include "analysis/plot/figures/growth_figure.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include "analysis/colours/palette.hpp"
#include "analysis/plot/canvas/axis.hpp"
#include "analysis/plot/canvas/small_print.hpp"

namespace vestige::plot {

namespace {

constexpr double kWidthPt = 468;
constexpr double kMarginPt = 8;
constexpr double kLeftPt = 60;
constexpr double kPanelGapPt = 22;
constexpr double kPlotHeightPt = 190;
constexpr double kTitlePt = 14;
constexpr double kAxisRoomPt = 34;
constexpr double kLegendLinePt = 11;
constexpr double kLegendColumnPt = 113;
constexpr double kMarkPt = 3.6;
/// Half of the widest tick label under a panel's right end.
constexpr double kRightPt = 18;

constexpr TextStyle kTitleStyle = {8, kInk, Anchor::kLeft, Level::kFoot, Weight::kBold};
constexpr TextStyle kLegendStyle = {7, kInk, Anchor::kLeft, Level::kMiddle};

std::vector<std::string> wrapped(const std::string& text) {
  return plot::wrapped(text, kSmallPrintStyle, kWidthPt - 2 * kMarginPt);
}

std::vector<std::string> small_print(const GrowthResult& result) {
  std::string text = fmt::format("Mean time of a frame, whole round trip. {} ", result.legend);
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
           static_cast<double>(small_print_.size()) * kSmallPrintLinePt + 4;
  }
  std::string description() const override {
    std::string text = "Microseconds a frame.";
    for (const GrowthPanel& panel : result_.panels)
      for (const GrowthLine& line : panel.lines)
        text += fmt::format(" {}, {}, {} {:.0f}: {:.4g}.", panel.title, name(line), panel.along,
                            line.points.back().size, line.points.back().us);
    return text;
  }

  void draw(Canvas& canvas) const override {
    const double top_pt = height_pt() - kMarginPt - kTitlePt;
    const auto panels = static_cast<double>(result_.panels.size());
    const double panel_pt = (kWidthPt - kLeftPt - (panels - 1) * kPanelGapPt - kRightPt) / panels;
    double left_pt = kLeftPt;
    for (std::size_t i = 0; i < result_.panels.size(); ++i) {
      draw_panel(canvas, i, {left_pt, top_pt - kPlotHeightPt, left_pt + panel_pt, top_pt});
      left_pt += panel_pt + kPanelGapPt;
    }
    draw_legend(canvas, top_pt - kPlotHeightPt - kAxisRoomPt - kLegendLinePt / 2);
    draw_small_print(canvas, kMarginPt, small_print_);
  }

 private:
  const std::vector<GrowthLine>& lines() const { return result_.panels.front().lines; }
  double legend_pt() const {
    return static_cast<double>(std::ranges::max(legend(), {}, &LegendPlace::row).row + 1) * kLegendLinePt + 4;
  }

  bool has_twin(const GrowthLine& line) const {
    return std::ranges::any_of(lines(), [&](const GrowthLine& one) {
      return one.detector == line.detector && one.context == line.context && one.first_only == line.first_only &&
             one.skip != line.skip;
    });
  }
  Dash dash(const GrowthLine& line) const {
    if (line.first_only) return Dash::kDotted;
    return line.skip == "off" && has_twin(line) ? Dash::kDashed : Dash::kSolid;
  }
  /// By its detector and by whatever else tells it from the others.
  std::string name(const GrowthLine& line) const {
    std::string text = line.detector;
    const auto other_context = [&](const GrowthLine& one) {
      return one.detector == line.detector && one.context != line.context;
    };
    if (!line.context.empty() && std::ranges::any_of(lines(), other_context)) text += ", " + line.context;
    if (has_twin(line)) text += line.skip == "off" ? ", no skipping" : ", skipping";
    if (line.first_only) text += ", colliders around the first";
    return text;
  }

  /// Detectors and contexts in the order of the file.
  std::vector<std::pair<std::string, std::string>> kinds() const {
    std::vector<std::pair<std::string, std::string>> kinds;
    for (const GrowthLine& one : lines())
      if (std::ranges::find(kinds, std::pair(one.detector, one.context)) == kinds.end())
        kinds.emplace_back(one.detector, one.context);
    return kinds;
  }
  std::size_t kind(const GrowthLine& line) const {
    const auto all = kinds();
    return static_cast<std::size_t>(std::ranges::find(all, std::pair(line.detector, line.context)) - all.begin());
  }
  Colour colour(const GrowthLine& line) const {
    std::vector<std::string> detectors;
    const auto all = kinds();
    detectors.reserve(all.size());
    for (const auto& [detector, context] : all) detectors.push_back(detector);
    return line_colours(detectors)[kind(line)];
  }

  /// Hollow where nothing is skipped, so that twins of one colour differ in more than their dashes.
  void draw_mark(Canvas& canvas, const Place& place, const GrowthLine& line) const {
    if (dash(line) == Dash::kSolid) return canvas.mark(place, Mark::kCircle, kMarkPt, colour(line), kWhite);
    canvas.mark(place, Mark::kCircle, kMarkPt + 0.6, colour(line), colour(line));
    canvas.mark(place, Mark::kCircle, kMarkPt - 1.4, kWhite, kWhite);
  }

  struct LegendPlace {
    const GrowthLine* line = nullptr;
    std::size_t column = 0;
    std::size_t row = 0;
  };
  /// A detector's lines below each other, detectors side by side.
  std::vector<LegendPlace> legend() const {
    constexpr std::size_t kColumns = 4;
    std::vector<LegendPlace> places;
    for (const GrowthLine& line : lines()) {
      if (line.first_only) continue;  // the small print explains the dots
      const std::size_t column = kind(line) % kColumns;
      const auto above = std::ranges::count_if(places, [&](const LegendPlace& one) { return one.column == column; });
      places.push_back({&line, column, static_cast<std::size_t>(above)});
    }
    return places;
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
    canvas.text({plot.left_pt, plot.top_pt + 4}, panel.title, kTitleStyle);
    for (const GrowthLine& line : panel.lines) {
      std::vector<Place> places;
      places.reserve(line.points.size());
      for (const GrowthPoint& point : line.points) places.push_back({x.place_pt(point.size), y.place_pt(point.us)});
      canvas.polyline(places, {colour(line), 1.2, dash(line)});
      for (const Place& place : places) draw_mark(canvas, place, line);
    }
  }

  void draw_legend(Canvas& canvas, double top_pt) const {
    for (const LegendPlace& entry : legend()) {
      const GrowthLine& line = *entry.line;
      const double left_pt = kMarginPt + static_cast<double>(entry.column) * kLegendColumnPt;
      const double y_pt = top_pt - static_cast<double>(entry.row) * kLegendLinePt;
      canvas.line({left_pt, y_pt}, {left_pt + 20, y_pt}, {colour(line), 1.2, dash(line)});
      draw_mark(canvas, {left_pt + 10, y_pt}, line);
      canvas.text({left_pt + 24, y_pt}, name(line), kLegendStyle);
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
