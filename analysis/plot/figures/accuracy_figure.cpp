#include "analysis/plot/figures/accuracy_figure.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "analysis/plot/canvas/axis.hpp"
#include "analysis/plot/canvas/free_place.hpp"
#include "analysis/plot/canvas/palette.hpp"

namespace vestige::plot {

namespace {

constexpr double kWidthPt = 468;
constexpr double kMarginPt = 8;
constexpr double kLeftPt = 50;
constexpr double kLegendPt = 96;
constexpr double kTitlePt = 19;
constexpr double kSharesPt = 84;  ///< height of the logarithmic part of a panel
constexpr double kLanePt = 8.5;   ///< and of each lane below it
constexpr double kPanelGapPt = 10;
constexpr double kAxisRoomPt = 34;
constexpr double kSmallLinePt = 8;
constexpr double kLegendLinePt = 11;
constexpr double kTitleGapPt = 9;  ///< marks at the very top, and their labels, stay clear of the titles
constexpr double kMarkPt = 4;
constexpr double kRateHeightPt = 3.7;  ///< of digits in `kRateStyle`
constexpr double kRateGapPt = 1.2;     ///< between labels
constexpr double kMost = 1;
constexpr double kLeastShown = 0.002;

constexpr TextStyle kTitleStyle = {8, kInk, Anchor::kLeft, Level::kFoot, Weight::kBold};
constexpr TextStyle kLegendStyle = {7, kInk, Anchor::kLeft, Level::kMiddle};
constexpr TextStyle kRateStyle = {5, kSmallPrint, Anchor::kCentre, Level::kFoot};
constexpr TextStyle kSmallStyle = {6, kSmallPrint, Anchor::kLeft, Level::kTop};

/// 60 as "60", 10000 as "10k".
std::string short_rate(double rate_hz) {
  return rate_hz >= 1000 ? fmt::format("{:.4g}k", rate_hz / 1000) : fmt::format("{:.4g}", rate_hz);
}

std::vector<std::string> wrapped(const std::string& text) {
  return plot::wrapped(text, kSmallStyle, kWidthPt - 2 * kMarginPt);
}

std::vector<std::string> small_print(const AccuracyResult& result) {
  std::vector<std::string> lines = wrapped(fmt::format(
      "Truth: continuous collision detection at {} Hz. An event is a maximal run of contact of a collider with an "
      "actuator. It is missed if no contact of this pair lies within one frame of it, and no contact with another "
      "actuator lies there instead. Small numbers: frames per second of the trace (k: thousand). Run time: median time "
      "of a frame times the rate; more than 1 s is slower than real time. Marks in the grey band missed no event; "
      "their height there only keeps them apart.",
      result.truth_rate_hz));
  std::string text;
  if (!result.renderer.empty()) text += fmt::format("OpenGL: {}. ", result.renderer);
  if (!result.machine.empty()) text += fmt::format("Machine: {}. ", result.machine);
  text += fmt::format("Avatar: {}, animation {}. Commit\u00a0{}.", result.avatar,
                      result.animation.empty() ? "first" : result.animation, result.commit);
  for (std::string& line : wrapped(text)) lines.push_back(std::move(line));
  return lines;
}

class AccuracyFigure : public Figure {
 public:
  explicit AccuracyFigure(AccuracyResult result) : result_(std::move(result)), small_print_(small_print(result_)) {}

  double width_pt() const override { return kWidthPt; }
  double height_pt() const override {
    return kMarginPt + static_cast<double>(result_.panels.size()) * panel_height_pt() + kAxisRoomPt - kPanelGapPt +
           static_cast<double>(small_print_.size()) * kSmallLinePt + 4;
  }

  std::string description() const override {
    std::string text = "Contact events missed over run time for a second of motion.";
    for (const AccuracyPanel& panel : result_.panels)
      for (const AccuracySeries& series : panel.series)
        text += fmt::format(" {}, {} {}: {:.2f} % at {} Hz.", panel.colliders, series.detector, series.method,
                            100 * series.points.front().missed_share, series.points.front().rate_hz);
    return text;
  }

  void draw(Canvas& canvas) const override {
    const Axis x = x_axis();
    double top_pt = height_pt() - kMarginPt;
    for (std::size_t i = 0; i < result_.panels.size(); ++i) {
      draw_panel(canvas, result_.panels[i], x, top_pt, i + 1 == result_.panels.size());
      top_pt -= panel_height_pt();
    }
    draw_legend(canvas);
    double y_pt = 2 + static_cast<double>(small_print_.size()) * kSmallLinePt;
    for (const std::string& line : small_print_) {
      canvas.text({kMarginPt, y_pt}, line, kSmallStyle);
      y_pt -= kSmallLinePt;
    }
  }

 private:
  std::size_t lanes() const { return result_.panels.front().series.size(); }
  double lanes_pt() const { return static_cast<double>(lanes()) * kLanePt + 3; }
  double panel_height_pt() const { return kTitlePt + kSharesPt + lanes_pt() + kPanelGapPt; }

  Axis x_axis() const {
    double least = 1;
    double most = 1;
    for (const AccuracyPanel& panel : result_.panels)
      for (const AccuracySeries& series : panel.series)
        for (const AccuracyPoint& point : series.points) {
          least = std::min(least, point.load);
          most = std::max(most, point.load);
        }
    return {Scale::kLog, round_down_125(least * 0.8), round_up_125(most * 1.2), kLeftPt, kWidthPt - kLegendPt};
  }

  /// The least share that is shown on the logarithmic part: no line has one above 0 below it.
  double least_share() const {
    double least = 0.01;
    for (const AccuracyPanel& panel : result_.panels)
      for (const AccuracySeries& series : panel.series)
        for (const AccuracyPoint& point : series.points)
          if (point.missed_share > 0) least = std::min(least, point.missed_share);
    return std::min(kLeastShown, round_down_125(least * 0.8));
  }

  /// One each; where there are too many, one for each detector, whose methods the marks tell apart.
  Colour colour(std::size_t series) const {
    const std::vector<AccuracySeries>& all = result_.panels.front().series;
    std::vector<std::string> detectors;
    if (all.size() <= kLineColours.size()) {
      for (const AccuracySeries& one : all) detectors.push_back(one.detector);
      return line_colours(detectors)[series];
    }
    for (const AccuracySeries& one : all)
      if (std::ranges::find(detectors, one.detector) == detectors.end()) detectors.push_back(one.detector);
    const auto found = std::ranges::find(detectors, all[series].detector);
    return line_colours(detectors)[static_cast<std::size_t>(found - detectors.begin())];
  }
  static Mark mark_of(const AccuracySeries& series) {
    if (series.method == "static") return Mark::kCircle;
    return series.method == "ccd" ? Mark::kDiamond : Mark::kSquare;
  }

  void draw_panel(Canvas& canvas, const AccuracyPanel& panel, const Axis& x, double top_pt, bool is_last) const {
    const Box plot = {x.begin_pt, top_pt - kTitlePt - kSharesPt - lanes_pt(), x.end_pt, top_pt - kTitlePt};
    const Axis y = {Scale::kLog, least_share(), kMost, plot.bottom_pt + lanes_pt(), plot.top_pt};
    canvas.text({plot.left_pt, plot.top_pt + kTitleGapPt},
                fmt::format("{}: {} colliders, {} true events", panel.colliders, panel.collider_count,
                            grouped(panel.true_events)),
                kTitleStyle);
    draw_frame(canvas, plot, x, y, is_last);
    FreePlace free_place({plot.left_pt, plot.bottom_pt, plot.right_pt + 8, plot.top_pt + kTitleGapPt - 2});
    if (x.low < 1 && x.high > 1) {
      const std::array<Place, 2> real_time = {Place{x.place_pt(1), plot.bottom_pt}, Place{x.place_pt(1), plot.top_pt}};
      free_place.take(real_time);
    }
    std::vector<std::vector<Place>> lines;
    for (std::size_t i = 0; i < panel.series.size(); ++i) {
      lines.push_back(places(panel.series[i], i, x, y));
      free_place.take(lines.back());
      for (const Place& place : lines.back())
        free_place.take(
            {place.x_pt - kMarkPt / 2, place.y_pt - kMarkPt / 2, place.x_pt + kMarkPt / 2, place.y_pt + kMarkPt / 2});
      canvas.polyline(lines.back(), {colour(i), 1, Dash::kSolid});
    }
    for (std::size_t i = 0; i < lines.size(); ++i)
      for (std::size_t p = 0; p < lines[i].size(); ++p) {
        canvas.mark(lines[i][p], mark_of(panel.series[i]), kMarkPt, colour(i), kWhite);
        draw_rate(canvas, panel.series[i].points[p].rate_hz, lines[i][p], free_place);
      }
  }

  /// Where something is missed by its share, else in the lane of the series.
  std::vector<Place> places(const AccuracySeries& series, std::size_t index, const Axis& x, const Axis& y) const {
    const double lane_pt = y.begin_pt - (static_cast<double>(index) + 0.5) * kLanePt - 3;
    std::vector<Place> line;
    line.reserve(series.points.size());
    for (const AccuracyPoint& point : series.points)
      line.push_back({x.place_pt(point.load), point.missed_share > 0 ? y.place_pt(point.missed_share) : lane_pt});
    return line;
  }

  static void draw_rate(Canvas& canvas, double rate_hz, const Place& at, FreePlace& free_place) {
    const std::string label = short_rate(rate_hz);
    const double half_pt = text_width_pt(label, kRateStyle) / 2;
    const double beside_pt = kMarkPt / 2 + kRateGapPt + half_pt;
    const double above_pt = kMarkPt / 2 + kRateGapPt + kRateHeightPt / 2;
    const double aslant_pt = kRateHeightPt / 2 + kRateGapPt;
    std::vector<Box> boxes;
    for (const Place& centre :
         {Place{at.x_pt, at.y_pt + above_pt}, Place{at.x_pt, at.y_pt - above_pt},
          Place{at.x_pt + beside_pt, at.y_pt + aslant_pt}, Place{at.x_pt - beside_pt, at.y_pt + aslant_pt},
          Place{at.x_pt + beside_pt, at.y_pt - aslant_pt}, Place{at.x_pt - beside_pt, at.y_pt - aslant_pt}})
      boxes.push_back({centre.x_pt - half_pt, centre.y_pt - kRateHeightPt / 2, centre.x_pt + half_pt,
                       centre.y_pt + kRateHeightPt / 2});
    const auto with_gap = [](const Box& box) {
      return Box{box.left_pt - kRateGapPt / 2, box.bottom_pt - kRateGapPt / 2, box.right_pt + kRateGapPt / 2,
                 box.top_pt + kRateGapPt / 2};
    };
    const auto place = std::ranges::find_if(boxes, [&](const Box& box) { return free_place.is_free(with_gap(box)); });
    if (place == boxes.end()) return;  // marks beside it along the line say it
    free_place.take(with_gap(*place));
    canvas.text({(place->left_pt + place->right_pt) / 2, place->bottom_pt}, label, kRateStyle);
  }

  void draw_frame(Canvas& canvas, const Box& plot, const Axis& x, const Axis& y, bool is_last) const {
    constexpr Colour kLanes = {244, 246, 244};
    canvas.rectangle({plot.left_pt, plot.bottom_pt, plot.right_pt, y.begin_pt - 1.5}, kLanes);
    const std::vector<Tick> x_ticks = log_ticks(x.low, x.high);
    for (const Tick& tick : x_ticks)
      if (!tick.label.empty())
        canvas.line({x.place_pt(tick.value), plot.bottom_pt}, {x.place_pt(tick.value), plot.top_pt},
                    {kGrid, 0.4, Dash::kSolid});
    std::vector<Tick> y_ticks = log_ticks(y.low, y.high);
    for (Tick& tick : y_ticks) {
      if (tick.label.empty()) continue;
      tick.label = fmt::format("{:.4g} %", tick.value * 100);
      const double y_pt = y.place_pt(tick.value);
      canvas.line({plot.left_pt, y_pt}, {plot.right_pt, y_pt}, {kGrid, 0.4, Dash::kSolid});
    }
    const Box shares = {plot.left_pt, y.begin_pt, plot.right_pt, y.end_pt};
    draw_y_axis(canvas, shares, y, y_ticks, "Events missed");
    canvas.text({plot.left_pt - 5, (plot.bottom_pt + y.begin_pt - 1.5) / 2}, "none",
                {7, kInk, Anchor::kRight, Level::kMiddle});
    if (x.low < 1 && x.high > 1) {
      const double x_pt = x.place_pt(1);
      canvas.line({x_pt, plot.bottom_pt}, {x_pt, plot.top_pt + kTitleGapPt - 2}, {kSmallPrint, 0.5, Dash::kDotted});
      canvas.text({x_pt, plot.top_pt + kTitleGapPt}, "real time", {6, kSmallPrint, Anchor::kCentre, Level::kFoot});
    }
    if (is_last) {
      draw_x_axis(canvas, plot, x, x_ticks, "Run time for a second of motion (s)");
    } else {
      canvas.line({plot.left_pt, plot.bottom_pt}, {plot.right_pt, plot.bottom_pt}, {kInk, 0.6, Dash::kSolid});
    }
  }

  void draw_legend(Canvas& canvas) const {
    const std::vector<AccuracySeries>& all = result_.panels.front().series;
    double y_pt = height_pt() - kMarginPt - kTitlePt - 5;
    const double left_pt = kWidthPt - kLegendPt + 14;
    for (std::size_t i = 0; i < all.size(); ++i) {
      canvas.line({left_pt, y_pt}, {left_pt + 14, y_pt}, {colour(i), 1, Dash::kSolid});
      canvas.mark({left_pt + 7, y_pt}, mark_of(all[i]), kMarkPt, colour(i), kWhite);
      canvas.text({left_pt + 18, y_pt}, fmt::format("{}, {}", all[i].detector, all[i].method), kLegendStyle);
      y_pt -= kLegendLinePt;
    }
  }

  AccuracyResult result_;
  std::vector<std::string> small_print_;
};

}  // namespace

std::unique_ptr<Figure> accuracy_figure(AccuracyResult result) {
  return std::make_unique<AccuracyFigure>(std::move(result));
}

}  // namespace vestige::plot
