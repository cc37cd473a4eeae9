#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include "analysis/colours/palette.hpp"
#include "analysis/plot/canvas/axis.hpp"
#include "analysis/plot/canvas/small_print.hpp"
#include "analysis/plot/figures/stage_figure.hpp"

namespace vestige::plot {

namespace {

constexpr double kWidthPt = 468;
constexpr double kMarginPt = 8;
constexpr double kTitlePt = 18;
constexpr double kLeftPt = 44;
constexpr double kRightPt = 18;
constexpr double kPlotHeightPt = 170;
constexpr double kAxisRoomPt = 34;
constexpr double kLegendLinePt = 11;

constexpr TextStyle kTitleStyle = {9, kInk, Anchor::kLeft, Level::kFoot, Weight::kBold};
constexpr TextStyle kLegendStyle = {7, kInk, Anchor::kLeft, Level::kMiddle};
constexpr TextStyle kLimitStyle = {6, kSmallPrint, Anchor::kRight, Level::kTop};

constexpr std::array<Colour, 4> kStageColours = {kSkyBlue, kOrange, kBlue, kVermillion};

/// What people notice, and how early a cue may come (docs/guides/live.md).
constexpr std::array<std::pair<double, const char*>, 2> kLimits = {{{15, "early cue"}, {50, "not noticed"}}};

class LatencyFigure : public Figure {
 public:
  explicit LatencyFigure(LatencyResult result) : result_(std::move(result)), small_print_(small_print()) {}

  double width_pt() const override { return kWidthPt; }
  double height_pt() const override {
    return kMarginPt + kTitlePt + kPlotHeightPt + kAxisRoomPt + legend_pt() +
           static_cast<double>(small_print_.size()) * kSmallPrintLinePt + 4;
  }
  std::string description() const override {
    std::string text = "Share of frames that took up to some time, from the arrival of their input.";
    for (const LatencyLine& line : result_.lines) text += fmt::format(" {}.", name(line));
    return text;
  }

  void draw(Canvas& canvas) const override {
    const double top_pt = height_pt() - kMarginPt - kTitlePt;
    canvas.text({kMarginPt, top_pt + 7}, "From the arrival of input to the motor", kTitleStyle);
    const Box plot = {kLeftPt, top_pt - kPlotHeightPt, kWidthPt - kRightPt, top_pt};
    const Axis x = {Scale::kLog, low_ms(), high_ms(), plot.left_pt, plot.right_pt};
    const Axis y = {Scale::kLinear, 0, 100, plot.bottom_pt, plot.top_pt};
    draw_grid(canvas, plot, x, y);
    for (std::size_t i = 0; i < result_.lines.size(); ++i) draw_line(canvas, i, x, y);
    for (std::size_t i = 0; i < result_.lines.size(); ++i)
      draw_entry(canvas, i, plot.bottom_pt - kAxisRoomPt - (static_cast<double>(i) + 0.5) * kLegendLinePt);
    draw_small_print(canvas, kMarginPt, small_print_);
  }

 private:
  static std::string name(const LatencyLine& line) {
    return fmt::format("{}: half within {:.3g} ms, 99 % within {:.3g} ms", line.stage, line.p50_ms, line.p99_ms);
  }
  double legend_pt() const { return static_cast<double>(result_.lines.size()) * kLegendLinePt + 4; }
  double low_ms() const {
    double least = 1;
    for (const LatencyLine& line : result_.lines) least = std::min(least, line.up_to_ms.front());
    return round_down_125(least * 0.9);
  }
  double high_ms() const {
    double most = kLimits.back().first * 1.2;
    for (const LatencyLine& line : result_.lines) most = std::max(most, line.up_to_ms.back());
    return round_up_125(most);
  }

  static void draw_grid(Canvas& canvas, const Box& plot, const Axis& x, const Axis& y) {
    const std::vector<Tick> x_ticks = log_ticks(x.low, x.high);
    const std::vector<Tick> y_ticks = linear_ticks(y.low, y.high, 5);
    for (const Tick& tick : y_ticks)
      canvas.line({plot.left_pt, y.place_pt(tick.value)}, {plot.right_pt, y.place_pt(tick.value)},
                  {kGrid, 0.4, Dash::kSolid});
    for (const auto& [limit_ms, words] : kLimits) {
      const double x_pt = x.place_pt(limit_ms);
      canvas.line({x_pt, plot.bottom_pt}, {x_pt, plot.top_pt}, {kSmallPrint, 0.6, Dash::kDashed});
      canvas.text({x_pt - 2, plot.bottom_pt + 9}, words, kLimitStyle);  // where lines seldom are
    }
    draw_x_axis(canvas, plot, x, x_ticks, "Time since the arrival (ms)");
    draw_y_axis(canvas, plot, y, y_ticks, "Frames that took up to it (%)");
  }

  void draw_line(Canvas& canvas, std::size_t i, const Axis& x, const Axis& y) const {
    const LatencyLine& line = result_.lines[i];
    std::vector<Place> places = {{x.place_pt(line.up_to_ms.front()), y.begin_pt}};
    for (std::size_t k = 0; k < line.shares.size(); ++k)
      places.push_back({x.place_pt(line.up_to_ms[k]), y.place_pt(100 * line.shares[k])});
    canvas.polyline(places, {colour(i), 1.2, Dash::kSolid});
  }

  void draw_entry(Canvas& canvas, std::size_t i, double y_pt) const {
    canvas.line({kMarginPt, y_pt}, {kMarginPt + 20, y_pt}, {colour(i), 1.2, Dash::kSolid});
    canvas.text({kMarginPt + 24, y_pt}, name(result_.lines[i]), kLegendStyle);
  }

  static Colour colour(std::size_t i) { return kStageColours[i % kStageColours.size()]; }

  std::vector<std::string> small_print() const {
    std::string text = "Contacts found: of all frames. Written and acknowledged: of those that changed what is felt. ";
    text += fmt::format("{}: at least {:.3g} ms between two frames", result_.port, result_.floor_ms);
    if (result_.line_time_ms > 0)
      text += fmt::format("; a frame then takes {:.3g} ms on the line", result_.line_time_ms);
    text += ". ";
    if (result_.pose_delay_ms > 0)
      text += fmt::format("Half of the poses were shown {:.3g} ms late or later, which comes on top. ",
                          result_.pose_delay_ms);
    if (!result_.machine.empty()) text += fmt::format("Machine: {}. ", result_.machine);
    text += fmt::format("Commit\u00a0{}.", result_.commit);
    return wrapped(text, kSmallPrintStyle, kWidthPt - 2 * kMarginPt);
  }

  LatencyResult result_;
  std::vector<std::string> small_print_;
};

}  // namespace

std::unique_ptr<Figure> latency_figure(LatencyResult result) {
  return std::make_unique<LatencyFigure>(std::move(result));
}

}  // namespace vestige::plot
