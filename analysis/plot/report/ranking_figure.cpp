#include "analysis/plot/report/ranking_figure.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "analysis/colours/palette.hpp"
#include "analysis/plot/canvas/axis.hpp"
#include "analysis/plot/data/report_words.hpp"

namespace vestige::plot {

namespace {

constexpr double kWidthPt = 252;  // a paper's column, and a phone's width
constexpr double kMarginPt = 6;
constexpr double kMostLabelPt = 90;
constexpr double kRowPt = 13;
constexpr double kAxisRoomPt = 34;
constexpr double kTopPt = 8;
constexpr double kRightPt = 14;
constexpr TextStyle kLabelStyle = {7, kInk, Anchor::kRight, Level::kMiddle};

class RankingFigure : public Figure {
 public:
  RankingFigure(const ReportData& data, std::size_t most) : data_(data) {
    for (const Candidate& candidate : data.ranking)
      if (candidate.headline.mean && shown_.size() < most) shown_.push_back(&candidate);
  }

  double width_pt() const override { return kWidthPt; }
  double height_pt() const override { return kTopPt + rows_pt() + kAxisRoomPt; }
  std::string description() const override {
    std::string text = fmt::format("{} of the best {} of {} combinations of map and law, 95 % intervals.",
                                   sentence_case(words_of_name(metric().name)), shown_.size(), data_.ranking.size());
    for (std::size_t i = 0; i < std::min<std::size_t>(shown_.size(), 3); ++i)
      text += fmt::format(" {}: {}.", label(*shown_[i]), estimate_text(shown_[i]->headline, metric()));
    return text;
  }

  void draw(Canvas& canvas) const override {
    double widest_pt = 0;
    for (const Candidate* one : shown_)
      widest_pt = std::max(widest_pt, text_width_pt(shortened(label(*one), kLabelStyle, kMostLabelPt), kLabelStyle));
    const Box plot = {kMarginPt + widest_pt + 8, kAxisRoomPt, kWidthPt - kRightPt, kAxisRoomPt + rows_pt()};
    const Axis x = x_axis(plot);
    const std::vector<Tick> ticks = linear_ticks(x.low, x.high, 4);
    for (const Tick& tick : ticks)
      canvas.line({x.place_pt(tick.value), plot.bottom_pt}, {x.place_pt(tick.value), plot.top_pt},
                  {kGrid, 0.4, Dash::kSolid});
    for (std::size_t i = 0; i < shown_.size(); ++i) draw_row(canvas, i, plot, x);
    draw_x_axis(canvas, plot, x, ticks, axis_title());
  }

 private:
  const ReportMetric& metric() const { return data_.metrics[data_.headline]; }
  double rows_pt() const { return kRowPt * static_cast<double>(std::max<std::size_t>(shown_.size(), 1)); }
  static std::string label(const Candidate& candidate) { return fmt::format("{}, {}", candidate.map, candidate.law); }
  std::string axis_title() const {
    std::string title = sentence_case(words_of_name(metric().name));
    if (!metric().unit.empty()) title += fmt::format(" ({})", metric().unit);
    return title;
  }

  Axis x_axis(const Box& plot) const {
    double low = 0;
    double high = 0;
    bool first = true;
    for (const Candidate* one : shown_)
      for (const std::optional<double>& value : {one->headline.low, one->headline.mean, one->headline.high}) {
        if (!value) continue;
        low = first ? *value : std::min(low, *value);
        high = first ? *value : std::max(high, *value);
        first = false;
      }
    // Nought belongs in the picture where it is not far.
    if (low > 0 && low < 0.6 * high) low = 0;
    if (high < 0 && high > 0.6 * low) high = 0;
    const double room = std::max({(high - low) * 0.04, std::abs(high) * 1e-3, 1e-9});
    return {Scale::kLinear, low == 0 ? 0 : low - room, high == 0 ? 0 + room : high + room, plot.left_pt, plot.right_pt};
  }

  void draw_row(Canvas& canvas, std::size_t row, const Box& plot, const Axis& x) const {
    const Candidate& one = *shown_[row];
    const double y_pt = plot.top_pt - (static_cast<double>(row) + 0.5) * kRowPt;
    canvas.text({plot.left_pt - 6, y_pt}, shortened(label(one), kLabelStyle, kMostLabelPt), kLabelStyle);
    const Colour colour = one.distinguishable_from_best ? kSmallPrint : kBlue;
    if (one.headline.has_interval()) {
      const double low_pt = x.place_pt(*one.headline.low);
      const double high_pt = x.place_pt(*one.headline.high);
      canvas.line({low_pt, y_pt}, {high_pt, y_pt}, {colour, 1, Dash::kSolid});
      for (const double end_pt : {low_pt, high_pt})
        canvas.line({end_pt, y_pt - 2}, {end_pt, y_pt + 2}, {colour, 1, Dash::kSolid});
    }
    const double mean_pt = x.place_pt(*one.headline.mean);
    canvas.mark({mean_pt, y_pt}, Mark::kCircle, 5.4, colour, colour);
    if (one.distinguishable_from_best) canvas.mark({mean_pt, y_pt}, Mark::kCircle, 3.2, kWhite, kWhite);
  }

  const ReportData& data_;
  std::vector<const Candidate*> shown_;
};

}  // namespace

std::unique_ptr<Figure> ranking_figure(const ReportData& data, std::size_t most) {
  return std::make_unique<RankingFigure>(data, most);
}

}  // namespace vestige::plot
