#include "analysis/plot/canvas/axis.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "analysis/colours/palette.hpp"

namespace vestige::plot {

namespace {

constexpr Pen kAxisPen = {kInk, 0.6, Dash::kSolid};
constexpr double kTickPt = 3;
constexpr double kShortTickPt = 1.8;
constexpr int kTitleTypePt = 8;
/// Sums of floating-point steps end slightly beside the round number.
constexpr double kSlack = 1e-9;

double tick_length_pt(const Tick& tick) {
  return tick.label.empty() ? kShortTickPt : kTickPt;
}

}  // namespace

double Axis::place_pt(double value) const {
  const double part =
      scale == Scale::kLog ? std::log(value / low) / std::log(high / low) : (value - low) / (high - low);
  return begin_pt + part * (end_pt - begin_pt);
}

double round_down_125(double value) {
  const double power = std::pow(10.0, std::floor(std::log10(value) + kSlack));
  for (const double factor : {5.0, 2.0})
    if (value >= factor * power * (1 - kSlack)) return factor * power;
  return power;
}

double round_up_125(double value) {
  const double power = std::pow(10.0, std::floor(std::log10(value) + kSlack));
  for (const double factor : {1.0, 2.0, 5.0})
    if (value <= factor * power * (1 + kSlack)) return factor * power;
  return 10 * power;
}

std::string grouped(double value) {
  std::string digits = fmt::format("{}", value);
  const std::size_t whole = std::min(digits.find('.'), digits.size());
  if (whole < 5 || digits.find('e') != std::string::npos) return digits;
  for (std::size_t at = whole - 3; at > 0 && at < whole; at -= 3) {
    digits.insert(at, "\u202f");
    if (at < 3) break;
  }
  return digits;
}

std::string grouped_count(double count, std::string_view thing) {
  return fmt::format("{} {}{}", grouped(count), thing, count == 1 ? "" : "s");
}

std::vector<Tick> linear_ticks(double low, double high, int wanted, double least_step) {
  const double step = std::max(least_step, round_up_125((high - low) / wanted));
  const auto first = static_cast<std::int64_t>(std::ceil(low / step - kSlack));
  const auto last = static_cast<std::int64_t>(std::floor(high / step + kSlack));
  std::vector<Tick> ticks;
  for (std::int64_t index = first; index <= last; ++index) {
    // Ten digits: 0.30000000000000004 is 0.3.
    const double value = std::stod(fmt::format("{:.10g}", static_cast<double>(index) * step));
    ticks.push_back({value, grouped(value)});
  }
  return ticks;
}

std::vector<Tick> log_ticks(double low, double high) {
  const bool short_axis = high / low < 100;
  std::vector<Tick> ticks;
  const int first_decade = static_cast<int>(std::floor(std::log10(low) + kSlack));
  const int last_decade = static_cast<int>(std::floor(std::log10(high) + kSlack));
  for (int decade = first_decade; decade <= last_decade; ++decade) {
    const double power = std::pow(10.0, decade);
    for (int factor = 1; factor < 10; ++factor) {
      const double value = factor * power;
      if (value < low * (1 - kSlack) || value > high * (1 + kSlack)) continue;
      const bool labelled = factor == 1 || (short_axis && (factor == 2 || factor == 5));
      ticks.push_back({value, labelled ? grouped(value) : ""});
    }
  }
  return ticks;
}

void draw_x_axis(Canvas& canvas, const Box& box, const Axis& x, const std::vector<Tick>& ticks,
                 std::string_view title) {
  canvas.line({box.left_pt, box.bottom_pt}, {box.right_pt, box.bottom_pt}, kAxisPen);
  for (const Tick& tick : ticks) {
    const double x_pt = x.place_pt(tick.value);
    canvas.line({x_pt, box.bottom_pt}, {x_pt, box.bottom_pt - tick_length_pt(tick)}, kAxisPen);
    canvas.text({x_pt, box.bottom_pt - 5}, tick.label, {kTickTypePt, kInk, Anchor::kCentre, Level::kTop});
  }
  canvas.text({(box.left_pt + box.right_pt) / 2, box.bottom_pt - 17}, title,
              {kTitleTypePt, kInk, Anchor::kCentre, Level::kTop});
}

void draw_y_axis(Canvas& canvas, const Box& box, const Axis& y, const std::vector<Tick>& ticks,
                 std::string_view title) {
  canvas.line({box.left_pt, box.bottom_pt}, {box.left_pt, box.top_pt}, kAxisPen);
  double widest_pt = 0;
  for (const Tick& tick : ticks) {
    const TextStyle style = {kTickTypePt, kInk, Anchor::kRight, Level::kMiddle};
    const double y_pt = y.place_pt(tick.value);
    canvas.line({box.left_pt, y_pt}, {box.left_pt - tick_length_pt(tick), y_pt}, kAxisPen);
    if (tick.label.empty()) continue;
    canvas.text({box.left_pt - 5, y_pt}, tick.label, style);
    widest_pt = std::max(widest_pt, text_width_pt(tick.label, style));
  }
  canvas.text({box.left_pt - 11 - widest_pt, (box.bottom_pt + box.top_pt) / 2}, title,
              {kTitleTypePt, kInk, Anchor::kCentre, Level::kFoot, Weight::kRegular, 90});
}

}  // namespace vestige::plot
