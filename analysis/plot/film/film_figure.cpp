#include "analysis/plot/film/film_figure.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "analysis/colours/palette.hpp"
#include "analysis/colours/region_colours.hpp"
#include "analysis/plot/canvas/axis.hpp"
#include "analysis/plot/canvas/duty_raster.hpp"
#include "analysis/plot/scene/moment_picture.hpp"

namespace vestige::plot {

namespace {

constexpr double kPointsPerInch = 72;
constexpr double kWidthPt = 384;
constexpr double kSidePt = 6;
constexpr double kTitleRoomPt = 18;
constexpr double kMostBodyPt = 250;
constexpr double kGapPt = 6;
constexpr double kAxisRoomPt = 28;
constexpr double kKeyRoomPt = 14;
constexpr double kLinePt = 9;
constexpr double kLeastLabelledPt = 8;
constexpr double kLeastTimelinePt = 6;
constexpr double kMostTimelinePt = 192;
constexpr double kMostLabelPt = 110;
constexpr double kSwatchPt = 6;

constexpr TextStyle kLabelStyle = {.size_pt = kTickTypePt, .colour = kInk};
constexpr TextStyle kTitleStyle = {9, kInk, Anchor::kLeft, Level::kMiddle, Weight::kBold};
constexpr TextStyle kSmallStyle = {.size_pt = kTickTypePt, .colour = kSmallPrint};

double timeline_pt(std::size_t lines) {
  if (lines == 0) return 0;
  return std::clamp(static_cast<double>(lines) * kLinePt, kLeastTimelinePt, kMostTimelinePt);
}

bool has_labels(std::size_t lines) {
  return lines > 0 && timeline_pt(lines) / static_cast<double>(lines) >= kLeastLabelledPt;
}

/// Returns how many digits tell the times of two pictures apart; milliseconds at least.
int digits_of(double step_s) {
  return std::clamp(static_cast<int>(std::ceil(-std::log10(step_s))), 3, 9);
}

/// What must be said beside the title, or "".
std::string small_print(const FilmSheet& sheet) {
  std::string text = sheet.speed == 1 ? "" : fmt::format("{:.3g} × real time", sheet.speed);
  if (sheet.follows) text += text.empty() ? "the view follows" : ", the view follows";
  return text;
}

/// Room for the labels of the lines on their left.
double label_room_pt(const std::vector<FilmLine>& lines) {
  if (!has_labels(lines.size())) return 2 * kSidePt;
  double widest_pt = 0;
  for (const FilmLine& line : lines) widest_pt = std::max(widest_pt, text_width_pt(line.name, kLabelStyle));
  return kSidePt + kSwatchPt + 4 + std::min(widest_pt, kMostLabelPt) + 8;
}

}  // namespace

std::vector<FilmLine> film_lines(const std::vector<Subject>& people) {
  std::vector<FilmLine> lines;
  for (std::size_t person = 0; person < people.size(); ++person) {
    const ActuatorMap& map = people[person].map;
    for (std::size_t i = 0; i < map.actuator_count; ++i)
      lines.push_back({people.size() > 1 ? fmt::format("{}: {}", person + 1, map.names[i]) : map.names[i],
                       region_colour(i + 1, map.actuator_count)});
  }
  return lines;
}

double FilmLayout::dots_per_inch(std::size_t width_dots) {
  return static_cast<double>(width_dots) / kWidthPt * kPointsPerInch;
}

FilmLayout::FilmLayout(std::size_t width_dots, const SceneSight& sight, const std::vector<FilmLine>& lines)
    : dots_per_pt_(static_cast<double>(width_dots) / kWidthPt), width_dots_(width_dots) {
  m_per_dot_ = std::max(sight.size_m.x / kWidthPt, sight.size_m.y / kMostBodyPt) / dots_per_pt_;
  body_height_dots_ = std::max<std::size_t>(1, static_cast<std::size_t>(std::lround(sight.size_m.y / m_per_dot_)));
  timeline_left_dots_ = dots_of(label_room_pt(lines));
  timeline_right_dots_ = dots_of(kWidthPt - 2 * kSidePt);
  timeline_height_dots_ = dots_of(timeline_pt(lines.size()));
}

std::size_t FilmLayout::dots_of(double length_pt) const {
  return static_cast<std::size_t>(std::lround(length_pt * dots_per_pt_));
}

Box FilmLayout::timeline() const {
  const double bottom_pt = pt_of(dots_of(kKeyRoomPt + kAxisRoomPt));
  return {pt_of(timeline_left_dots_), bottom_pt, pt_of(timeline_right_dots_), bottom_pt + pt_of(timeline_height_dots_)};
}

Box FilmLayout::body() const {
  const double bottom_pt = timeline().top_pt + pt_of(dots_of(kGapPt));
  return {0, bottom_pt, width_pt(), bottom_pt + pt_of(body_height_dots_)};
}

double FilmLayout::height_pt() const {
  return body().top_pt + pt_of(dots_of(kTitleRoomPt));
}

FilmFigure::FilmFigure(FilmSheet sheet, const FilmLayout& layout, Raster duties)
    : sheet_(std::move(sheet)), layout_(layout), duties_(std::move(duties)) {}

void FilmFigure::show(double time_s, Raster scene, std::span<const std::uint8_t> duty) {
  time_s_ = time_s;
  scene_ = std::move(scene);
  duty_.assign(duty.begin(), duty.end());
}

std::string FilmFigure::description() const {
  return fmt::format("{} at {:.3f} s.", sheet_.title, time_s_);
}

void FilmFigure::draw(Canvas& canvas) const {
  canvas.image(layout_.body(), scene_);
  draw_title(canvas);
  draw_timeline(canvas);
  draw_key(canvas);
}

void FilmFigure::draw_title(Canvas& canvas) const {
  const double y_pt = height_pt() - kTitleRoomPt / 2;
  TextStyle time_style = kTitleStyle;
  time_style.anchor = Anchor::kRight;
  canvas.text({kWidthPt - kSidePt, y_pt}, fmt::format("{:.{}f} s", time_s_, digits_of(sheet_.step_s)), time_style);
  const std::string title = shortened(sheet_.title, kTitleStyle, kWidthPt / 2);
  canvas.text({kSidePt, y_pt}, title, kTitleStyle);
  const std::string beside = small_print(sheet_);
  if (!beside.empty()) canvas.text({kSidePt + text_width_pt(title, kTitleStyle) + 8, y_pt}, beside, kSmallStyle);
}

void FilmFigure::draw_timeline(Canvas& canvas) const {
  const Box plot = layout_.timeline();
  if (!sheet_.lines.empty()) canvas.image(plot, duties_);
  if (has_labels(sheet_.lines.size())) draw_labels(canvas, plot);
  // A clock's time is long and says little: count from the film's start then.
  const bool is_clock = std::abs(sheet_.begin_s) > 10 * (sheet_.end_s - sheet_.begin_s);
  const double zero_s = is_clock ? sheet_.begin_s : 0;
  const Axis x = {Scale::kLinear, sheet_.begin_s - zero_s, sheet_.end_s - zero_s, plot.left_pt, plot.right_pt};
  draw_x_axis(canvas, plot, x, linear_ticks(x.low, x.high, 8),
              is_clock ? fmt::format("Time (s) after {} s", sheet_.begin_s) : "Time (s)");
  const double cursor_pt = x.place_pt(time_s_ - zero_s);
  canvas.line({cursor_pt, plot.bottom_pt - 1}, {cursor_pt, plot.top_pt + 2}, {kInk, 1, Dash::kSolid});
}

void FilmFigure::draw_labels(Canvas& canvas, const Box& plot) const {
  const double line_pt = plot.height_pt() / static_cast<double>(sheet_.lines.size());
  for (std::size_t i = 0; i < sheet_.lines.size(); ++i) {
    const FilmLine& line = sheet_.lines[i];
    const double y_pt = plot.top_pt - (static_cast<double>(i) + 0.5) * line_pt;
    const Box swatch = {kSidePt, y_pt - kSwatchPt / 2, kSidePt + kSwatchPt, y_pt + kSwatchPt / 2};
    canvas.rectangle(swatch, blend(line.colour, kRunning, duty_[i] / double{kFullDuty}));
    canvas.frame(swatch, {kInk, 0.3, Dash::kSolid});
    canvas.text({swatch.right_pt + 4, y_pt}, shortened(line.name, kLabelStyle, kMostLabelPt), kLabelStyle);
  }
}

void FilmFigure::draw_key(Canvas& canvas) const {
  const double y_pt = kKeyRoomPt / 2;
  double left_pt = kSidePt;
  const auto say = [&](const std::string& words) {
    canvas.text({left_pt + 4, y_pt}, words, kLabelStyle);
    left_pt += 4 + text_width_pt(words, kLabelStyle) + 12;
  };
  if (!sheet_.lines.empty()) {
    const Box swatch = {left_pt, y_pt - kSwatchPt / 2, left_pt + kSwatchPt, y_pt + kSwatchPt / 2};
    canvas.rectangle(swatch, kRunning);
    canvas.frame(swatch, {kInk, 0.3, Dash::kSolid});
    left_pt += kSwatchPt;
    say("motor runs");
  }
  canvas.mark({left_pt + 2, y_pt}, Mark::kCircle, kContactPt, kVermillion, kVermillion);
  left_pt += 4;
  say(fmt::format("contact in these {:g} ms", sheet_.fade_s * 1000));
  canvas.line({left_pt, y_pt}, {left_pt + 10, y_pt}, {blend(kWhite, kBlue, 0.6), 0.9, Dash::kSolid});
  canvas.mark({left_pt + 10, y_pt}, Mark::kCircle, 2.2, kInk, kInk);
  left_pt += 12;
  say("collider and its path");
  say("pale: behind skin");
}

}  // namespace vestige::plot
