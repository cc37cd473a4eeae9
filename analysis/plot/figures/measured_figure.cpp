#include "analysis/plot/figures/measured_figure.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

#include "analysis/colours/palette.hpp"
#include "analysis/plot/canvas/axis.hpp"
#include "traces/base/error.hpp"
#include "traces/base/number_text.hpp"

namespace vestige::plot {

namespace {

constexpr double kWidthPt = 468;
constexpr double kRightPt = 456;
constexpr double kAxisRoomPt = 36;
constexpr double kLegendRoomPt = 36;
constexpr double kLanePt = 30;
constexpr double kLaneGapPt = 8;
constexpr double kMostLabelPt = 150;
constexpr double kFullDuty = 255;
constexpr Colour kCommanded = kSkyBlue;
constexpr Colour kMeasured = kVermillion;
constexpr TextStyle kLabelStyle = {.size_pt = kTickTypePt};

/// The first row in which anything is on.
std::optional<double> first_on_s(const Timeline& timeline) {
  const auto on = std::ranges::find_if(timeline.duty, [](std::uint8_t duty) { return duty != 0; });
  if (on == timeline.duty.end()) return std::nullopt;
  return timeline.time_s[static_cast<std::size_t>(on - timeline.duty.begin()) / timeline.actuator_count];
}

/// A time in which a duty stays the same.
struct Step {
  double from_s;
  double to_s;
  std::uint8_t duty;
};

std::vector<Step> steps_of(const Timeline& timeline, std::size_t actuator, double begin_s, double end_s) {
  std::vector<Step> steps = {{begin_s, end_s, 0}};
  for (std::size_t row = 0; row < timeline.time_s.size(); ++row) {
    const double time_s = std::clamp(timeline.time_s[row], begin_s, end_s);
    const std::uint8_t duty = timeline.duty[row * timeline.actuator_count + actuator];
    if (duty == steps.back().duty) continue;
    steps.back().to_s = time_s;
    steps.push_back({time_s, end_s, duty});
  }
  return steps;
}

class MeasuredFigure : public Figure {
 public:
  MeasuredFigure(Timeline commanded, Timeline measured, double shift_s)
      : commanded_(std::move(commanded)), measured_(std::move(measured)), shift_s_(shift_s) {
    for (double& time_s : measured_.time_s) time_s += shift_s;
    begin_s_ = commanded_.time_s.front();
    end_s_ = std::max(commanded_.time_s.back(), measured_.time_s.back());
    if (end_s_ <= begin_s_) end_s_ = begin_s_ + 1;
    end_s_ += (end_s_ - begin_s_) / 100;
  }

  double width_pt() const override { return kWidthPt; }
  double height_pt() const override {
    return kAxisRoomPt + static_cast<double>(commanded_.actuator_count) * kLanePt + kLegendRoomPt;
  }
  std::string description() const override {
    return fmt::format("Commanded and measured duties of {} over {:.3g} s.",
                       counted(commanded_.actuator_count, "actuator"), end_s_ - begin_s_);
  }

  void draw(Canvas& canvas) const override {
    std::vector<std::string> labels;
    double widest_pt = 0;
    for (std::size_t i = 0; i < commanded_.actuator_count; ++i) {
      const std::string name = commanded_.names.empty() ? "" : " " + commanded_.names[i];
      labels.push_back(shortened(fmt::format("{}{}", i + 1, name), kLabelStyle, kMostLabelPt));
      widest_pt = std::max(widest_pt, text_width_pt(labels.back(), kLabelStyle));
    }
    const Box plot = {widest_pt + 24, kAxisRoomPt, kRightPt, height_pt() - kLegendRoomPt};
    const Axis x = {Scale::kLinear, begin_s_, end_s_, plot.left_pt, plot.right_pt};
    for (std::size_t i = 0; i < labels.size(); ++i) {
      const double top_pt = plot.top_pt - static_cast<double>(i) * kLanePt;
      const Box lane = {plot.left_pt, top_pt - kLanePt, plot.right_pt, top_pt - kLaneGapPt};
      draw_lane(canvas, lane, x, i);
      TextStyle style = kLabelStyle;
      style.anchor = Anchor::kRight;
      canvas.text({plot.left_pt - 6, (lane.bottom_pt + lane.top_pt) / 2}, labels[i], style);
    }
    draw_x_axis(canvas, plot, x, linear_ticks(x.low, x.high, 8), "Time (s)");
    draw_legend(canvas, plot);
  }

 private:
  void draw_lane(Canvas& canvas, const Box& lane, const Axis& x, std::size_t actuator) const {
    const auto height_pt = [&](std::uint8_t duty) { return lane.bottom_pt + duty / kFullDuty * lane.height_pt(); };
    // At the trace's end everything is switched off.
    for (const Step& step : steps_of(commanded_, actuator, begin_s_, commanded_.time_s.back()))
      if (step.duty != 0)
        canvas.rectangle({x.place_pt(step.from_s), lane.bottom_pt, x.place_pt(step.to_s), height_pt(step.duty)},
                         faded(kCommanded, 0.6));
    std::vector<Place> line;
    for (const Step& step : steps_of(measured_, actuator, begin_s_, end_s_)) {
      line.push_back({x.place_pt(step.from_s), height_pt(step.duty)});
      line.push_back({x.place_pt(step.to_s), height_pt(step.duty)});
    }
    canvas.polyline(line, {kMeasured, 0.75});
  }

  void draw_legend(Canvas& canvas, const Box& plot) const {
    const double upper_pt = height_pt() - 10;
    const double lower_pt = upper_pt - 12;
    canvas.rectangle({plot.left_pt, upper_pt - 3, plot.left_pt + 16, upper_pt + 3}, faded(kCommanded, 0.6));
    canvas.text({plot.left_pt + 20, upper_pt}, "Commanded", kLabelStyle);
    canvas.line({plot.left_pt, lower_pt}, {plot.left_pt + 16, lower_pt}, {kMeasured, 0.75});
    canvas.text({plot.left_pt + 20, lower_pt},
                fmt::format("Measured, with its clock shifted by {:+.3f} s: both switch the first actuator on together",
                            shift_s_),
                kLabelStyle);
  }

  Timeline commanded_;
  Timeline measured_;
  double shift_s_;
  double begin_s_ = 0;
  double end_s_ = 1;
};

}  // namespace

std::unique_ptr<Figure> measured_figure(Timeline commanded, Timeline measured, const std::string& name) {
  if (commanded.actuator_count != measured.actuator_count)
    throw Error(
        name,
        fmt::format("has {} actuators, but the timeline has {}", measured.actuator_count, commanded.actuator_count),
        "name the file that was measured while this timeline was streamed");
  const std::optional<double> commanded_s = first_on_s(commanded);
  const std::optional<double> measured_s = first_on_s(measured);
  if (!commanded_s || !measured_s)
    throw Error(name,
                measured_s ? "switches an actuator on, but the timeline never does" : "never switches an actuator on",
                "stream a trace with contacts");
  return std::make_unique<MeasuredFigure>(std::move(commanded), std::move(measured), *commanded_s - *measured_s);
}

}  // namespace vestige::plot
