#include "analysis/plot/figures/accuracy_figure.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "analysis/colours/palette.hpp"
#include "analysis/plot/canvas/axis.hpp"
#include "analysis/plot/canvas/free_place.hpp"
#include "analysis/plot/canvas/small_print.hpp"

namespace vestige::plot {

namespace {

constexpr double kWidthPt = 468;
constexpr double kMarginPt = 8;
constexpr double kLeftPt = 46;
constexpr double kLegendPt = 112;
constexpr double kTitlePt = 19;
constexpr double kTitleGapPt = 9;
constexpr double kErrorsPt = 120;  ///< height of the logarithmic part of the large panel
constexpr double kSmallErrorsPt = 52;
constexpr double kNonePt = 12;  ///< height of the band for no errors below it
constexpr double kAxisRoomPt = 30;
constexpr double kSmallGapPt = 26;  ///< between two small panels
constexpr double kSceneGapPt = 12;
constexpr double kLegendLinePt = 10;
constexpr double kMarkPt = 3.4;
constexpr double kVestMarkPt = 5.4;
constexpr double kNearPt = 7;  ///< a name that is farther from its mark is joined with it
constexpr double kMost = 200;  ///< events wrong for 100 true ones: more false than true ones is beyond use
constexpr double kLeastShown = 0.5;
/// The frame rate of a headset, at which a vest is driven too.
constexpr double kVestRate_hz = 90;

constexpr TextStyle kTitleStyle = {8, kInk, Anchor::kLeft, Level::kFoot, Weight::kBold};
constexpr TextStyle kSmallTitleStyle = {7, kInk, Anchor::kLeft, Level::kFoot};
constexpr TextStyle kLegendStyle = {7, kInk, Anchor::kLeft, Level::kMiddle};
constexpr TextStyle kNameStyle = {6, kInk, Anchor::kLeft, Level::kMiddle, Weight::kBold};

/// 60 as "60", 10000 as "10k".
std::string short_rate(double rate_hz) {
  return rate_hz >= 1000 ? fmt::format("{:.4g}k", rate_hz / 1000) : fmt::format("{:.4g}", rate_hz);
}

std::string name_of(const AccuracySeries& series) {
  return fmt::format("{}, {}", series.detector, series.method);
}

std::vector<std::string> wrapped(const std::string& text) {
  return plot::wrapped(text, kSmallPrintStyle, kWidthPt - 2 * kMarginPt);
}

bool has(const AccuracyResult& result, bool (*matches)(const AccuracySeries&, const AccuracyPoint&)) {
  for (const AccuracyPanel& panel : result.panels)
    for (const AccuracySeries& series : panel.series)
      for (const AccuracyPoint& point : series.points)
        if (matches(series, point)) return true;
  return false;
}

std::vector<std::string> small_print(const AccuracyResult& result) {
  std::string explained = fmt::format(
      "Wrong: true events that are missed, false events, and events of a wrong actuator, for 100 true events; 95 % "
      "intervals by the bootstrap over colliders. An event is a maximal run of contact of a collider with an actuator. "
      "It is found if an event of the same collider and actuator begins within {:g} ms of it. Truth: continuous "
      "collision detection at {} Hz, of which exact arithmetic checked whole frames. Each line joins the frame rates "
      "of one detector",
      result.tolerance_ms, result.truth_rate_hz);
  if (has(result, [](const auto&, const AccuracyPoint& point) { return point.rate_hz == kVestRate_hz; }))
    explained += fmt::format("; large marks are at {:g} Hz", kVestRate_hz);
  explained +=
      ". The black line is the Pareto front: nothing measured is as cheap and has as few events wrong. Above 1000 ms, "
      "a "
      "detector is slower than real time.";
  if (has(result, [](const AccuracySeries& series, const auto&) { return series.detector == "decimated"; }))
    explained += fmt::format(" decimated keeps {:g} % of the triangles, or as many as seams need.", 100 * result.keep);
  std::vector<std::string> lines = wrapped(explained);
  std::string text;
  if (!result.renderer.empty()) text += fmt::format("OpenGL: {}. ", result.renderer);
  if (!result.machine.empty()) text += fmt::format("Machine: {}. ", result.machine);
  text += fmt::format("Avatar: {}, animation {}. Commit\u00a0{}.", result.avatar,
                      result.animation.empty() ? "first" : result.animation, result.commit);
  for (std::string& line : wrapped(text)) lines.push_back(std::move(line));
  return lines;
}

/// One kind of error, and where a panel shows it.
struct Kind {
  const char* title;
  ValueRange AccuracyPoint::*estimate;
};
constexpr std::array<Kind, 3> kKinds = {{{"Missed", &AccuracyPoint::missed},
                                         {"False", &AccuracyPoint::false_events},
                                         {"Wrong actuator", &AccuracyPoint::wrong_actuator}}};
constexpr Kind kAll = {"Events wrong, for 100 true", &AccuracyPoint::wrong};

/// Where a panel is, and what its axes mean. `y` is above the band for no errors.
struct Panel {
  Box plot;
  Axis x;
  Axis y;

  double height_of(double errors) const {
    return errors > 0 ? y.place_pt(std::clamp(errors, y.low, y.high)) : plot.bottom_pt + kNonePt / 2;
  }
  Place place_of(const AccuracyPoint& point, const Kind& kind) const {
    return {x.place_pt(point.load_ms.value), height_of((point.*kind.estimate).value)};
  }
};

class AccuracyFigure : public Figure {
 public:
  explicit AccuracyFigure(AccuracyResult result)
      : result_(std::move(result)), small_print_(small_print(result_)), x_(x_axis()), least_(least_error()) {}

  double width_pt() const override { return kWidthPt; }
  double height_pt() const override {
    return kMarginPt + static_cast<double>(result_.panels.size()) * scene_height_pt() - kSceneGapPt +
           static_cast<double>(small_print_.size()) * kSmallPrintLinePt + 6;
  }

  std::string description() const override {
    std::string text = "Events wrong over processor time for a second of the scene. On the Pareto front:";
    for (const AccuracyPanel& panel : result_.panels)
      for (const auto& [series, point] : front(panel))
        text += fmt::format(" {}, {} at {} Hz: {:.3g} wrong for 100, {:.3g} ms.", panel.colliders, name_of(*series),
                            point->rate_hz, point->wrong.value, point->load_ms.value);
    return text;
  }

  void draw(Canvas& canvas) const override {
    double top_pt = height_pt() - kMarginPt;
    for (const AccuracyPanel& panel : result_.panels) {
      draw_scene(canvas, panel, top_pt);
      top_pt -= scene_height_pt();
    }
    draw_legend(canvas);
    draw_small_print(canvas, kMarginPt, small_print_);
  }

 private:
  using FrontPoint = std::pair<const AccuracySeries*, const AccuracyPoint*>;

  static constexpr double scene_height_pt() {
    return kTitlePt + kErrorsPt + kNonePt + kAxisRoomPt + kTitlePt + kSmallErrorsPt + kNonePt + kAxisRoomPt +
           kSceneGapPt;
  }

  /// By ascending load.
  static std::vector<FrontPoint> front(const AccuracyPanel& panel) {
    std::vector<FrontPoint> points;
    for (const AccuracySeries& series : panel.series)
      for (const AccuracyPoint& point : series.points)
        if (point.on_front) points.emplace_back(&series, &point);
    std::ranges::sort(points, {}, [](const FrontPoint& one) { return one.second->load_ms.value; });
    return points;
  }

  std::pair<double, double> x_axis() const {
    double least = 1e12;
    double most = 0;
    for (const AccuracyPanel& panel : result_.panels)
      for (const AccuracySeries& series : panel.series)
        for (const AccuracyPoint& point : series.points) {
          least = std::min(least, point.load_ms.low);
          most = std::max(most, point.load_ms.high);
        }
    return {round_down_125(least * 0.8), round_up_125(most * 1.2)};
  }

  /// The least number of errors above 0, or a little less.
  double least_error() const {
    double least = 1;
    for (const AccuracyPanel& panel : result_.panels)
      for (const AccuracySeries& series : panel.series)
        for (const AccuracyPoint& point : series.points)
          for (const Kind& kind : kKinds)
            if (const double value = (point.*kind.estimate).value; value > 0) least = std::min(least, value);
    return std::min(kLeastShown, round_down_125(least * 0.8));
  }

  /// One for each detector, whose methods the marks tell apart.
  std::vector<Colour> colours() const {
    std::vector<std::string> detectors;
    const std::vector<AccuracySeries>& all = result_.panels.front().series;
    for (const AccuracySeries& one : all)
      if (std::ranges::find(detectors, one.detector) == detectors.end()) detectors.push_back(one.detector);
    const std::vector<Colour> of_detector = line_colours(detectors);
    std::vector<Colour> colours;
    colours.reserve(all.size());
    for (const AccuracySeries& one : all)
      colours.push_back(
          of_detector[static_cast<std::size_t>(std::ranges::find(detectors, one.detector) - detectors.begin())]);
    return colours;
  }

  static Mark mark_of(const AccuracySeries& series) {
    if (series.method == "static") return Mark::kCircle;
    return series.method == "ccd" ? Mark::kDiamond : Mark::kSquare;
  }

  Panel panel_at(const Box& plot) const {
    return {plot,
            {Scale::kLog, x_.first, x_.second, plot.left_pt, plot.right_pt},
            {Scale::kLog, least_, kMost, plot.bottom_pt + kNonePt, plot.top_pt}};
  }

  void draw_scene(Canvas& canvas, const AccuracyPanel& scene, double top_pt) const {
    const double right_pt = kWidthPt - kLegendPt;
    const double bottom_pt = top_pt - kTitlePt - kErrorsPt - kNonePt;
    const Panel large = panel_at({kLeftPt, bottom_pt, right_pt, top_pt - kTitlePt});
    canvas.text({kLeftPt, large.plot.top_pt + kTitleGapPt},
                fmt::format("{}: {} collider{}, {} true events", scene.colliders, scene.collider_count,
                            scene.collider_count == 1 ? "" : "s", grouped(scene.true_events)),
                kTitleStyle);
    draw_axes(canvas, large, kAll.title, "Processor time for a second of the scene (ms)");
    draw_front(canvas, large, scene);
    draw_series(canvas, large, scene, kAll);
    draw_names(canvas, large, scene);

    const double small_top_pt = bottom_pt - kAxisRoomPt - kTitlePt;
    const double width_pt = (kWidthPt - 2 * kMarginPt - kLeftPt - 2 * kSmallGapPt) / 3;
    for (std::size_t i = 0; i < kKinds.size(); ++i) {
      const double left_pt = kLeftPt + static_cast<double>(i) * (width_pt + kSmallGapPt);
      const Panel small =
          panel_at({left_pt, small_top_pt - kSmallErrorsPt - kNonePt, left_pt + width_pt, small_top_pt});
      canvas.text({left_pt, small_top_pt + 3}, fmt::format("{}, for 100 true", kKinds[i].title), kSmallTitleStyle);
      draw_axes(canvas, small, "", "Processor time (ms)");
      draw_series(canvas, small, scene, kKinds[i]);
    }
  }

  static void draw_axes(Canvas& canvas, const Panel& panel, const char* y_title, const char* x_title) {
    constexpr Colour kNone = {244, 246, 244};
    const Box& plot = panel.plot;
    canvas.rectangle({plot.left_pt, plot.bottom_pt, plot.right_pt, panel.y.begin_pt - 1}, kNone);
    const std::vector<Tick> x_ticks = log_ticks(panel.x.low, panel.x.high);
    for (const Tick& tick : x_ticks)
      if (!tick.label.empty())
        canvas.line({panel.x.place_pt(tick.value), plot.bottom_pt}, {panel.x.place_pt(tick.value), plot.top_pt},
                    {kGrid, 0.4, Dash::kSolid});
    const std::vector<Tick> y_ticks = log_ticks(panel.y.low, panel.y.high);
    for (const Tick& tick : y_ticks)
      if (!tick.label.empty())
        canvas.line({plot.left_pt, panel.y.place_pt(tick.value)}, {plot.right_pt, panel.y.place_pt(tick.value)},
                    {kGrid, 0.4, Dash::kSolid});
    draw_y_axis(canvas, {plot.left_pt, panel.y.begin_pt, plot.right_pt, plot.top_pt}, panel.y, y_ticks, y_title);
    canvas.text({plot.left_pt - 5, plot.bottom_pt + kNonePt / 2}, "0", {7, kInk, Anchor::kRight, Level::kMiddle});
    draw_x_axis(canvas, plot, panel.x, x_ticks, x_title);
  }

  /// In steps: between two points of the front, the cheaper one is what can be had.
  static void draw_front(Canvas& canvas, const Panel& panel, const AccuracyPanel& scene) {
    std::vector<Place> line;
    for (const auto& [series, point] : front(scene)) {
      const Place place = panel.place_of(*point, kAll);
      line.push_back({place.x_pt, line.empty() ? panel.plot.top_pt : line.back().y_pt});
      line.push_back(place);
    }
    if (line.empty()) return;
    line.push_back({panel.plot.right_pt, line.back().y_pt});
    canvas.polyline(line, {kBlack, 1.4, Dash::kSolid});
  }

  void draw_series(Canvas& canvas, const Panel& panel, const AccuracyPanel& scene, const Kind& kind) const {
    const std::vector<Colour> colours = this->colours();
    for (std::size_t i = 0; i < scene.series.size(); ++i) {
      std::vector<Place> line;
      line.reserve(scene.series[i].points.size());
      for (const AccuracyPoint& point : scene.series[i].points) line.push_back(panel.place_of(point, kind));
      canvas.polyline(line, {faded(colours[i], 0.45), 0.6, Dash::kSolid});
    }
    for (std::size_t i = 0; i < scene.series.size(); ++i)
      for (const AccuracyPoint& point : scene.series[i].points) {
        const Place place = panel.place_of(point, kind);
        const Pen pen = {faded(colours[i], 0.7), 0.5, Dash::kSolid};
        const ValueRange& errors = point.*kind.estimate;
        canvas.line({place.x_pt, panel.height_of(errors.low)}, {place.x_pt, panel.height_of(errors.high)}, pen);
        canvas.line({panel.x.place_pt(point.load_ms.low), place.y_pt},
                    {panel.x.place_pt(point.load_ms.high), place.y_pt}, pen);
        const double size_pt = point.rate_hz == kVestRate_hz ? kVestMarkPt : kMarkPt;
        canvas.mark(place, mark_of(scene.series[i]), size_pt, colours[i], kWhite);
      }
  }

  /// Names who is on the front, beside its marks.
  static void draw_names(Canvas& canvas, const Panel& panel, const AccuracyPanel& scene) {
    FreePlace free_place({panel.plot.left_pt, panel.plot.bottom_pt, panel.plot.right_pt + 4, panel.plot.top_pt});
    for (const AccuracySeries& series : scene.series)
      for (const AccuracyPoint& point : series.points) {
        const Place at = panel.place_of(point, kAll);
        free_place.take({at.x_pt - kMarkPt / 2, at.y_pt - kMarkPt / 2, at.x_pt + kMarkPt / 2, at.y_pt + kMarkPt / 2});
      }
    // The best first: where there is no room for all, it is least for those of little use.
    std::vector<FrontPoint> named = front(scene);
    std::ranges::reverse(named);
    for (const auto& [series, point] : named) {
      const std::string label = fmt::format("{} {} {}", series->detector, series->method, short_rate(point->rate_hz));
      const double width_pt = text_width_pt(label, kNameStyle);
      const Place at = panel.place_of(*point, kAll);
      std::vector<Box> boxes;
      for (const double up_pt : {6.0, -6.0, 12.0, -12.0, 18.0, -18.0, 24.0})
        for (const double left_pt : {at.x_pt + 3, at.x_pt - 3 - width_pt, at.x_pt - width_pt / 2})
          boxes.push_back({left_pt, at.y_pt + up_pt - 3, left_pt + width_pt, at.y_pt + up_pt + 3});
      const auto free = std::ranges::find_if(boxes, [&](const Box& box) { return free_place.is_free(box); });
      if (free == boxes.end()) continue;  // pareto in run.json names it
      const Box box = *free;
      free_place.take(box);
      const double label_pt = (box.bottom_pt + box.top_pt) / 2;
      if (std::abs(label_pt - at.y_pt) > kNearPt)
        canvas.line(at,
                    {std::clamp(at.x_pt, box.left_pt, box.right_pt), label_pt > at.y_pt ? box.bottom_pt : box.top_pt},
                    {kSmallPrint, 0.4, Dash::kSolid});
      canvas.text({box.left_pt, label_pt}, label, kNameStyle);
    }
  }

  void draw_legend(Canvas& canvas) const {
    const std::vector<AccuracySeries>& all = result_.panels.front().series;
    const std::vector<Colour> colours = this->colours();
    double y_pt = height_pt() - kMarginPt - kTitlePt - 5;
    const double left_pt = kWidthPt - kLegendPt + 10;
    for (std::size_t i = 0; i < all.size(); ++i) {
      canvas.line({left_pt, y_pt}, {left_pt + 12, y_pt}, {colours[i], 0.8, Dash::kSolid});
      canvas.mark({left_pt + 6, y_pt}, mark_of(all[i]), kMarkPt + 0.6, colours[i], kWhite);
      canvas.text({left_pt + 16, y_pt}, name_of(all[i]), kLegendStyle);
      y_pt -= kLegendLinePt;
    }
    const bool any = std::ranges::any_of(all, &AccuracySeries::approximate);
    if (!any) return;
    std::string names;
    for (const AccuracySeries& one : all)
      if (one.approximate && names.find(one.detector) == std::string::npos)
        names += (names.empty() ? "" : ", ") + one.detector;
    for (const std::string& line : plot::wrapped("approximate: " + names, kSmallPrintStyle, kLegendPt - 12)) {
      canvas.text({left_pt, y_pt}, line, kSmallPrintStyle);
      y_pt -= kSmallPrintLinePt;
    }
  }

  AccuracyResult result_;
  std::vector<std::string> small_print_;
  std::pair<double, double> x_;  ///< of all panels
  double least_;                 ///< of all panels
};

}  // namespace

std::unique_ptr<Figure> accuracy_figure(AccuracyResult result) {
  return std::make_unique<AccuracyFigure>(std::move(result));
}

}  // namespace vestige::plot
