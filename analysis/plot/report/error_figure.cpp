#include "analysis/plot/report/error_figure.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>
#include <utility>

#include "analysis/colours/palette.hpp"
#include "analysis/plot/canvas/axis.hpp"
#include "analysis/plot/data/report_words.hpp"
#include "traces/base/number_text.hpp"

namespace vestige::plot {

namespace {

constexpr double kWidthPt = 468;
constexpr double kLeftPt = 42;
constexpr double kRightPt = 10;
constexpr double kPanelGapPt = 12;
constexpr double kPlotHeightPt = 120;
constexpr double kLanePt = 8;  ///< of what is not felt
constexpr double kTitlePt = 24;
constexpr double kAxisRoomPt = 34;
constexpr std::size_t kColumns = 4;
constexpr std::size_t kBins = 24;
constexpr std::size_t kLeastOfMedian = 3;
constexpr double kDotPt = 1.5;

double median_of(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::ranges::nth_element(values, middle);
  return *middle;
}

class ErrorFigure : public Figure {
 public:
  ErrorFigure(std::vector<ErrorSeries> series, double begin_s, double end_s)
      : series_(std::move(series)), begin_s_(begin_s), end_s_(end_s > begin_s ? end_s : begin_s + 1) {}

  double width_pt() const override { return kWidthPt; }
  double height_pt() const override { return static_cast<double>(rows()) * row_pt(); }
  std::string description() const override {
    std::string text = "Localisation error of each contact over time.";
    for (const ErrorSeries& one : series_) {
      const std::vector<double> felt = felt_of(one);
      text += fmt::format(" {}: {} of {} felt", one.law, felt.size(), counted(one.time_s.size(), "contact"));
      if (!felt.empty()) text += fmt::format(", median {} mm", number_text(median_of(felt)));
      text += ".";
    }
    return text;
  }

  void draw(Canvas& canvas) const override {
    const double panel_pt =
        whole_dots_pt((kWidthPt - kLeftPt - kRightPt - kPanelGapPt * static_cast<double>(columns() - 1)) /
                      static_cast<double>(columns()));
    for (std::size_t i = 0; i < series_.size(); ++i) {
      const std::size_t column = i % columns();
      const std::size_t row = i / columns();
      const double left_pt = kLeftPt + static_cast<double>(column) * (panel_pt + kPanelGapPt);
      const double bottom_pt = height_pt() - static_cast<double>(row + 1) * row_pt() + kAxisRoomPt;
      draw_panel(canvas, series_[i], {left_pt, bottom_pt, left_pt + panel_pt, bottom_pt + kPlotHeightPt}, column == 0);
    }
  }

 private:
  static double row_pt() { return kTitlePt + kPlotHeightPt + kAxisRoomPt; }
  std::size_t columns() const { return std::min(series_.size(), kColumns); }
  std::size_t rows() const { return (series_.size() + columns() - 1) / columns(); }

  static std::vector<double> felt_of(const ErrorSeries& series) {
    std::vector<double> felt;
    for (const float error : series.error_mm)
      if (std::isfinite(error)) felt.push_back(error);
    return felt;
  }

  double highest() const {
    double highest = 0;
    for (const ErrorSeries& one : series_)
      for (const float error : one.error_mm)
        if (std::isfinite(error)) highest = std::max(highest, static_cast<double>(error));
    return highest > 0 ? highest * 1.05 : 1;
  }

  void draw_panel(Canvas& canvas, const ErrorSeries& series, const Box& plot, bool is_first) const {
    const Axis x = {Scale::kLinear, begin_s_, end_s_, plot.left_pt, plot.right_pt};
    const Axis y = {Scale::kLinear, 0, highest(), plot.bottom_pt + kLanePt, plot.top_pt};
    const std::vector<double> felt = felt_of(series);
    canvas.text({plot.left_pt, plot.top_pt + 13}, series.law, {8, kInk, Anchor::kLeft, Level::kFoot, Weight::kBold});
    const double share = series.time_s.empty() ? 0
                                               : 100 * static_cast<double>(series.time_s.size() - felt.size()) /
                                                     static_cast<double>(series.time_s.size());
    const std::string note = felt.empty()
                                 ? "nothing felt"
                                 : fmt::format("median {} mm, {:.0f} % not felt", number_text(median_of(felt)), share);
    canvas.text({plot.left_pt, plot.top_pt + 4}, shortened(note, {6, kSmallPrint}, plot.width_pt()),
                {6, kSmallPrint, Anchor::kLeft, Level::kFoot});
    std::vector<Tick> y_ticks = linear_ticks(0, y.high, 5);
    draw_dots(canvas, series, plot, x, y, y_ticks);
    if (!is_first)
      for (Tick& tick : y_ticks) tick.label.clear();
    draw_x_axis(canvas, plot, x, linear_ticks(x.low, x.high, columns() > 2 ? 4 : 6), "Time (s)");
    draw_y_axis(canvas, {plot.left_pt, plot.bottom_pt + kLanePt, plot.right_pt, plot.top_pt}, y, y_ticks,
                is_first ? "Localisation error (mm)" : "");
    draw_medians(canvas, series, x, y);
  }

  /// A picture, since there may be a hundred thousand; darker where they lie on each other.
  static void draw_dots(Canvas& canvas, const ErrorSeries& series, const Box& plot, const Axis& x, const Axis& y,
                        const std::vector<Tick>& y_ticks) {
    const Box box = {plot.left_pt, plot.bottom_pt, plot.left_pt + whole_dots_pt(plot.width_pt()),
                     plot.bottom_pt + whole_dots_pt(plot.height_pt())};
    Raster raster(print_dots(box.width_pt()), print_dots(box.height_pt()), kWhite);
    const double dots_per_pt = static_cast<double>(raster.width()) / box.width_pt();
    const auto row_of = [&](double y_pt) { return static_cast<std::ptrdiff_t>((box.top_pt - y_pt) * dots_per_pt); };
    const auto column_of = [&](double x_pt) { return static_cast<std::ptrdiff_t>((x_pt - box.left_pt) * dots_per_pt); };
    const auto fill = [&](std::ptrdiff_t left, std::ptrdiff_t top, std::ptrdiff_t right, std::ptrdiff_t bottom,
                          Colour colour, double opacity) {
      const auto width = static_cast<std::ptrdiff_t>(raster.width());
      const auto height = static_cast<std::ptrdiff_t>(raster.height());
      for (std::ptrdiff_t row = std::max<std::ptrdiff_t>(top, 0); row < std::min(bottom, height); ++row)
        for (std::ptrdiff_t column = std::max<std::ptrdiff_t>(left, 0); column < std::min(right, width); ++column) {
          Colour& dot = raster.at(static_cast<std::size_t>(column), static_cast<std::size_t>(row));
          dot = blend(dot, colour, opacity);
        }
    };
    const auto columns = static_cast<std::ptrdiff_t>(raster.width());
    const auto lane_top = row_of(plot.bottom_pt + kLanePt - 2);
    fill(0, lane_top, columns, static_cast<std::ptrdiff_t>(raster.height()), {244, 246, 244}, 1);
    for (const Tick& tick : y_ticks)
      fill(0, row_of(y.place_pt(tick.value)), columns, row_of(y.place_pt(tick.value)) + 2, kGrid, 1);
    const auto half = static_cast<std::ptrdiff_t>(std::lround(kDotPt * dots_per_pt / 2));
    const double opacity = series.time_s.size() > 3000 ? 0.25 : series.time_s.size() > 500 ? 0.45 : 0.8;
    for (std::size_t i = 0; i < series.time_s.size(); ++i) {
      const std::ptrdiff_t column = column_of(x.place_pt(series.time_s[i]));
      if (!std::isfinite(series.error_mm[i])) {
        fill(column - 1, lane_top + 4, column + 1, static_cast<std::ptrdiff_t>(raster.height()) - 4, kVermillion,
             opacity);
        continue;
      }
      const std::ptrdiff_t row = row_of(y.place_pt(series.error_mm[i]));
      fill(column - half, row - half, column + half, row + half, kSkyBlue, opacity);
    }
    canvas.image(box, raster);
  }

  /// Of equal parts of the time; a part with few contacts breaks the line.
  void draw_medians(Canvas& canvas, const ErrorSeries& series, const Axis& x, const Axis& y) const {
    std::vector<std::vector<double>> bins(kBins);
    for (std::size_t i = 0; i < series.time_s.size(); ++i) {
      if (!std::isfinite(series.error_mm[i])) continue;
      const double part = (series.time_s[i] - begin_s_) / (end_s_ - begin_s_) * kBins;
      bins[static_cast<std::size_t>(std::clamp(part, 0.0, kBins - 1.0))].push_back(series.error_mm[i]);
    }
    std::vector<Place> line;
    const auto flush = [&] {
      canvas.polyline(line, {kBlue, 1.2, Dash::kSolid});
      line.clear();
    };
    for (std::size_t i = 0; i < kBins; ++i) {
      if (bins[i].size() < kLeastOfMedian) {
        flush();
        continue;
      }
      const double bin_s = (end_s_ - begin_s_) / kBins;
      const double y_pt = y.place_pt(median_of(bins[i]));
      line.push_back({x.place_pt(begin_s_ + static_cast<double>(i) * bin_s), y_pt});
      line.push_back({x.place_pt(begin_s_ + static_cast<double>(i + 1) * bin_s), y_pt});
    }
    flush();
  }

  std::vector<ErrorSeries> series_;
  double begin_s_;
  double end_s_;
};

}  // namespace

std::unique_ptr<Figure> error_figure(std::vector<ErrorSeries> series, double begin_s, double end_s) {
  return std::make_unique<ErrorFigure>(std::move(series), begin_s, end_s);
}

}  // namespace vestige::plot
