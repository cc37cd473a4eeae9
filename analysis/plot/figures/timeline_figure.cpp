#include "analysis/plot/figures/timeline_figure.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "analysis/colours/palette.hpp"
#include "analysis/plot/canvas/axis.hpp"
#include "analysis/plot/canvas/colour_bar.hpp"
#include "analysis/plot/canvas/duty_raster.hpp"
#include "traces/base/csv.hpp"
#include "traces/base/error.hpp"
#include "traces/base/number_text.hpp"
#include "traces/files/input_file.hpp"

namespace vestige::plot {

namespace {

constexpr std::string_view kRemedy = "name a file that 'vestige replay --timeline FILE.csv' wrote";
constexpr std::size_t kMostActuators = 1024;
/// 30 000 years.
constexpr double kFarthestS = 1e12;

constexpr double kWidthPt = 468;
constexpr double kLeastLeftPt = 48;
constexpr double kMostLabelPt = 150;
constexpr double kRightPt = 408;
constexpr double kAxisRoomPt = 36;
constexpr double kTopPt = 20;
constexpr double kLeastHeightPt = 60;
constexpr double kMostHeightPt = 480;

constexpr TextStyle kLabelStyle = {.size_pt = kTickTypePt};

class TimelineFigure : public Figure {
 public:
  explicit TimelineFigure(Timeline timeline) : timeline_(std::move(timeline)) {}

  double width_pt() const override { return kWidthPt; }
  double height_pt() const override { return kAxisRoomPt + plot_height_pt() + kTopPt; }
  std::string description() const override {
    return fmt::format("Duty of {} over {:.3g} s, {}.", counted(timeline_.actuator_count, "actuator"),
                       end_s() - timeline_.time_s.front(), counted(timeline_.time_s.size(), "frame"));
  }

  void draw(Canvas& canvas) const override {
    const std::vector<Tick> actuators = actuator_ticks();
    const Box plot = {left_pt(actuators), kAxisRoomPt, kRightPt, kAxisRoomPt + plot_height_pt()};
    canvas.image(plot, raster(plot));
    // A clock's time is long and says little: count from the first frame then.
    const double begin_s = timeline_.time_s.front();
    const double duration_s = end_s() - begin_s;
    const bool is_clock = std::abs(begin_s) > 10 * duration_s;
    const double zero_s = is_clock ? begin_s : 0;
    const Axis x = {Scale::kLinear, begin_s - zero_s, end_s() - zero_s, plot.left_pt, plot.right_pt};
    draw_x_axis(canvas, plot, x, linear_ticks(x.low, x.high, 8),
                is_clock ? fmt::format("Time (s) after {} s", begin_s) : "Time (s)");
    const auto count = static_cast<double>(timeline_.actuator_count);
    const Axis y = {Scale::kLinear, 0.5, count + 0.5, plot.top_pt, plot.bottom_pt};
    draw_y_axis(canvas, plot, y, actuators, "Actuator");
    const Box bar = {kRightPt + 18, std::max(plot.bottom_pt, plot.top_pt - 96), kRightPt + 24, plot.top_pt};
    draw_colour_bar(canvas, bar, amount_ramp, 0, kFullDuty, "Duty");
  }

 private:
  /// A row is 18 pt high while there is room; a multiple of 6 pt in all.
  double plot_height_pt() const {
    const double wish_pt = static_cast<double>(timeline_.actuator_count) * 18;
    return std::ceil(std::clamp(wish_pt, kLeastHeightPt, kMostHeightPt) / 6) * 6;
  }

  /// The last frame lasts as long as the one before it.
  double end_s() const {
    const std::vector<double>& time_s = timeline_.time_s;
    if (time_s.size() < 2) return time_s.front() + 1;
    return 2 * time_s.back() - time_s[time_s.size() - 2];
  }

  /// Room for the labels, and for the axis' title beside them; a multiple of 6 pt.
  static double left_pt(const std::vector<Tick>& actuators) {
    double widest_pt = 0;
    for (const Tick& tick : actuators) widest_pt = std::max(widest_pt, text_width_pt(tick.label, kLabelStyle));
    return std::max(kLeastLeftPt, std::ceil((widest_pt + 20) / 6) * 6);
  }

  std::vector<Tick> actuator_ticks() const {
    constexpr double kLabelHeightPt = 9;
    const double row_pt = plot_height_pt() / static_cast<double>(timeline_.actuator_count);
    const auto step = static_cast<std::size_t>(row_pt >= kLabelHeightPt ? 1 : round_up_125(kLabelHeightPt / row_pt));
    std::vector<Tick> ticks;
    for (std::size_t actuator = 1; actuator <= timeline_.actuator_count; ++actuator) {
      const auto number = static_cast<double>(actuator);
      if (actuator != 1 && actuator % step != 0) continue;
      std::string label =
          grouped(timeline_.numbers.empty() ? number : static_cast<double>(timeline_.numbers[actuator - 1]));
      if (!timeline_.names.empty()) label += " " + timeline_.names[actuator - 1];
      ticks.push_back({number, shortened(std::move(label), kLabelStyle, kMostLabelPt)});
    }
    return ticks;
  }

  /// The highest duty of each actuator (rows) in each printed column.
  std::vector<std::uint8_t> highest_duty(std::size_t columns) const {
    const std::size_t actuators = timeline_.actuator_count;
    std::vector<std::uint8_t> highest(columns * actuators, 0);
    const double begin_s = timeline_.time_s.front();
    const auto column_of = [&](double time_s) {
      return (time_s - begin_s) / (end_s() - begin_s) * static_cast<double>(columns);
    };
    for (std::size_t frame = 0; frame < timeline_.time_s.size(); ++frame) {
      const bool is_last = frame + 1 == timeline_.time_s.size();
      const double next_s = is_last ? end_s() : timeline_.time_s[frame + 1];
      const auto first = std::min(static_cast<std::size_t>(column_of(timeline_.time_s[frame])), columns - 1);
      const auto end = std::min(static_cast<std::size_t>(std::ceil(column_of(next_s))), columns);
      for (std::size_t actuator = 0; actuator < actuators; ++actuator) {
        const std::uint8_t duty = timeline_.duty[frame * actuators + actuator];
        if (duty == 0) continue;
        for (std::size_t column = first; column < std::max(end, first + 1); ++column) {
          std::uint8_t& cell = highest[actuator * columns + column];
          cell = std::max(cell, duty);
        }
      }
    }
    return highest;
  }

  Raster raster(const Box& plot) const {
    const std::size_t columns = print_dots(plot.width_pt());
    return duty_raster(highest_duty(columns), columns, print_dots(plot.height_pt()),
                       [](std::size_t, std::uint8_t duty) { return amount_ramp(duty / double{kFullDuty}); });
  }

  Timeline timeline_;
};

}  // namespace

Timeline read_timeline(const std::filesystem::path& path) {
  const std::string text = read_text_file(path);
  Timeline timeline;
  const std::string_view first_line = std::string_view(text).substr(0, text.find('\n'));
  timeline.actuator_count = static_cast<std::size_t>(std::ranges::count(first_line, ','));
  if (timeline.actuator_count == 0) throw Error(path.string() + ", line 1", "is not 'time_s,actuator_1,…'", kRemedy);
  if (timeline.actuator_count > kMostActuators)
    throw Error(path.string() + ", line 1", fmt::format("names more than {} actuators", kMostActuators), kRemedy);
  std::string header = "time_s";
  for (std::size_t actuator = 1; actuator <= timeline.actuator_count; ++actuator)
    header += fmt::format(",actuator_{}", actuator);
  CsvLines lines(text, path.string(), header, kRemedy);
  while (lines.next()) {
    double time_s = 0;
    if (!lines.take(time_s) || !(std::abs(time_s) <= kFarthestS)) throw lines.error("time_s is not a time in seconds");
    if (!timeline.time_s.empty() && time_s <= timeline.time_s.back())
      throw lines.error(fmt::format("time_s does not rise: {} after {}", time_s, timeline.time_s.back()));
    timeline.time_s.push_back(time_s);
    for (std::size_t actuator = 1; actuator <= timeline.actuator_count; ++actuator) {
      int duty = 0;
      if (!lines.take(duty) || duty < 0 || duty > kFullDuty)
        throw lines.error(fmt::format("actuator_{} is not a whole number from 0 to 255", actuator));
      timeline.duty.push_back(static_cast<std::uint8_t>(duty));
    }
    if (!lines.at_end()) throw lines.error(fmt::format("has more than {} fields", timeline.actuator_count + 1));
  }
  if (timeline.time_s.empty()) throw Error(path.string(), "holds no frame", kRemedy);
  return timeline;
}

Timeline only(const Timeline& timeline, const std::vector<std::uint32_t>& numbers) {
  Timeline part;
  part.time_s = timeline.time_s;
  part.actuator_count = numbers.size();
  part.numbers = numbers;
  if (!timeline.names.empty())
    for (const std::uint32_t number : numbers) part.names.push_back(timeline.names[number - 1]);
  part.duty.reserve(part.time_s.size() * numbers.size());
  for (std::size_t frame = 0; frame < part.time_s.size(); ++frame)
    for (const std::uint32_t number : numbers)
      part.duty.push_back(timeline.duty[frame * timeline.actuator_count + number - 1]);
  return part;
}

std::unique_ptr<Figure> timeline_figure(Timeline timeline) {
  return std::make_unique<TimelineFigure>(std::move(timeline));
}

}  // namespace vestige::plot
