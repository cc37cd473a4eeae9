#include "analysis/plot/figures/stress_figure.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <string>
#include <utility>
#include <vector>

#include "analysis/colours/palette.hpp"
#include "traces/base/number_text.hpp"

namespace vestige::plot {

namespace {

constexpr double kRowPt = 8.6;
constexpr double kColumnPt = 62;
constexpr double kNamePt = 92;
constexpr double kMagnitudePt = 44;
constexpr double kHeadPt = 24;
constexpr double kMarginPt = 8;
constexpr double kSmallLinePt = 8;
constexpr double kFamilyGapPt = 2;
constexpr double kLeastWidthPt = 360;
constexpr double kKeyPt = 24;
/// Shares of errors from one in a million to all, by their powers of ten.
constexpr double kDecades = 6;
constexpr Colour kNoErrors = {238, 241, 245};

constexpr TextStyle kHeadStyle = {7, kInk, Anchor::kCentre, Level::kFoot, Weight::kBold};
constexpr TextStyle kMethodStyle = {6, kInk, Anchor::kCentre, Level::kFoot};
constexpr TextStyle kNameStyle = {7, kInk, Anchor::kLeft, Level::kMiddle};
constexpr TextStyle kMagnitudeStyle = {6, kSmallPrint, Anchor::kRight, Level::kMiddle};
constexpr TextStyle kKeyStyle = {6, kInk, Anchor::kLeft, Level::kMiddle};
constexpr TextStyle kSmallStyle = {6, kSmallPrint, Anchor::kLeft, Level::kTop};

struct Column {
  std::string detector;
  std::string method;
  friend bool operator==(const Column&, const Column&) = default;
};

std::string name_of(const StressLine& line) {
  return line.variant.empty() ? line.name : fmt::format("{}, {}", line.name, line.variant);
}

bool same_family(const StressLine& a, const StressLine& b) {
  return a.name == b.name && a.variant == b.variant;
}

/// An error in a million is as visible as it must be: the scale is logarithmic.
double shade_of(double rate) {
  return std::clamp(1 + std::log10(rate) / kDecades, 0.0, 1.0);
}

/// Returns "304 (72–80 %)": the errors, and what their share may be. No errors need no interval: the small print has
/// it.
std::string shown(const StressCell& cell) {
  const double errors = cell.error_rate() * cell.cases;
  std::string count = errors < 1e5 ? fmt::format("{:.0f}", errors) : fmt::format("{:.3g}", errors);
  if (errors == 0 || !cell.low || !cell.high) return count;
  return fmt::format("{} ({}–{} %)", count, percent_text(*cell.low), percent_text(*cell.high));
}

class StressFigure : public Figure {
 public:
  explicit StressFigure(StressResult result) : result_(std::move(result)) {
    for (const StressLine& line : result_.lines)
      for (const StressCell& cell : line.cells) add_column({cell.detector, cell.method});
  }

  double width_pt() const override {
    return std::max(kLeastWidthPt,
                    2 * kMarginPt + kNamePt + kMagnitudePt + kColumnPt * static_cast<double>(columns_.size()));
  }
  double height_pt() const override {
    return 2 * kMarginPt + kHeadPt + rows_pt() + kKeyPt + kSmallLinePt * static_cast<double>(small_print().size() + 1);
  }
  std::string description() const override {
    std::string text = "Errors of each detector by family of hostile cases.";
    for (const Column& column : columns_) {
      double errors = 0;
      double cases = 0;
      for (const StressLine& line : result_.lines)
        for (const StressCell& cell : line.cells)
          if (Column{cell.detector, cell.method} == column) {
            errors += cell.error_rate() * cell.cases;
            cases += cell.cases;
          }
      text += fmt::format(" {}, {}: {:.0f} errors in {:.0f} cases.", column.detector, column.method, errors, cases);
    }
    return text;
  }

  void draw(Canvas& canvas) const override {
    const double top_pt = height_pt() - kMarginPt - kHeadPt;
    for (std::size_t i = 0; i < columns_.size(); ++i) {
      const double middle_pt = column_pt(i) + kColumnPt / 2;
      canvas.text({middle_pt, top_pt + 11}, columns_[i].detector, kHeadStyle);
      canvas.text({middle_pt, top_pt + 3}, columns_[i].method, kMethodStyle);
    }
    double y_pt = top_pt;
    for (std::size_t i = 0; i < result_.lines.size(); ++i) {
      const StressLine& line = result_.lines[i];
      const bool first = i == 0 || !same_family(line, result_.lines[i - 1]);
      if (first && i > 0) y_pt -= kFamilyGapPt;
      y_pt -= kRowPt;
      if (first) canvas.text({kMarginPt, y_pt + kRowPt / 2}, name_of(line), kNameStyle);
      canvas.text({kMarginPt + kNamePt + kMagnitudePt - 5, y_pt + kRowPt / 2}, fmt::format("{:g}", line.magnitude),
                  kMagnitudeStyle);
      for (const StressCell& cell : line.cells) draw_cell(canvas, cell, y_pt);
    }
    draw_key(canvas, y_pt - 6);
    draw_small_print(canvas);
  }

 private:
  /// Those of one detector side by side.
  void add_column(const Column& column) {
    if (std::ranges::find(columns_, column) != columns_.end()) return;
    auto place = columns_.end();
    while (place != columns_.begin() && std::prev(place)->detector != column.detector) --place;
    columns_.insert(place == columns_.begin() ? columns_.end() : place, column);
  }

  double rows_pt() const {
    double height_pt = kRowPt * static_cast<double>(result_.lines.size());
    for (std::size_t i = 1; i < result_.lines.size(); ++i)
      if (!same_family(result_.lines[i], result_.lines[i - 1])) height_pt += kFamilyGapPt;
    return height_pt;
  }

  static double column_pt(std::size_t column) {
    return kMarginPt + kNamePt + kMagnitudePt + kColumnPt * static_cast<double>(column);
  }

  void draw_cell(Canvas& canvas, const StressCell& cell, double bottom_pt) const {
    const auto found = std::ranges::find(columns_, Column{cell.detector, cell.method});
    const double left_pt = column_pt(static_cast<std::size_t>(found - columns_.begin()));
    const Box box = {left_pt + 0.5, bottom_pt + 0.4, left_pt + kColumnPt - 0.5, bottom_pt + kRowPt - 0.4};
    const double rate = cell.error_rate();
    canvas.rectangle(box, rate > 0 ? number_ramp(shade_of(rate)) : kNoErrors);
    const Colour ink = rate > 0 && shade_of(rate) > 0.2 ? kWhite : kInk;
    const TextStyle style = {6, ink, Anchor::kCentre, Level::kMiddle, rate > 0 ? Weight::kBold : Weight::kRegular};
    canvas.text({left_pt + kColumnPt / 2, bottom_pt + kRowPt / 2}, shown(cell), style);
  }

  /// What the colours mean: none, then shares of a cell's cases.
  static void draw_key(Canvas& canvas, double top_pt) {
    constexpr double kStepPt = 1.5;
    constexpr std::size_t kSteps = 120;
    const Box none = {kMarginPt + kNamePt + 4, top_pt - 7, kMarginPt + kNamePt + kMagnitudePt - 8, top_pt};
    const Box bar = {column_pt(0) + 8, none.bottom_pt, column_pt(0) + 8 + kStepPt * kSteps, none.top_pt};
    canvas.text({kMarginPt, (bar.bottom_pt + bar.top_pt) / 2}, "Share of wrong cases", kKeyStyle);
    canvas.rectangle(none, kNoErrors);
    const TextStyle label = {6, kInk, Anchor::kCentre, Level::kTop};
    canvas.text({(none.left_pt + none.right_pt) / 2, none.bottom_pt - 3}, "none", label);
    for (std::size_t i = 0; i < kSteps; ++i) {
      const double left_pt = bar.left_pt + kStepPt * static_cast<double>(i);
      canvas.rectangle({left_pt, bar.bottom_pt, left_pt + kStepPt, bar.top_pt},
                       number_ramp((static_cast<double>(i) + 0.5) / kSteps));
    }
    for (const auto& [share, name] :
         {std::pair(1e-6, "0.0001 %"), std::pair(1e-4, "0.01 %"), std::pair(1e-2, "1 %"), std::pair(1.0, "100 %")}) {
      const double x_pt = bar.left_pt + shade_of(share) * kStepPt * kSteps;
      canvas.line({x_pt, bar.bottom_pt}, {x_pt, bar.bottom_pt - 2}, {kInk, 0.5, Dash::kSolid});
      canvas.text({x_pt, bar.bottom_pt - 3}, name, label);
    }
  }

  std::vector<std::string> small_print() const {
    bool has_intervals = false;
    double zero_high = 0;  // the highest share that cells without errors may have
    double fewest = result_.lines.front().cells.front().cases;
    double most = fewest;
    for (const StressLine& line : result_.lines)
      for (const StressCell& cell : line.cells) {
        has_intervals |= cell.low.has_value();
        if (cell.error_rate() == 0) zero_high = std::max(zero_high, cell.high.value_or(0));
        fewest = std::min(fewest, cell.cases);
        most = std::max(most, cell.cases);
      }
    const std::string cases =
        fewest == most ? fmt::format("{:.0f}", most) : fmt::format("{:.0f} to {:.0f}", fewest, most);
    std::vector<std::string> lines = {
        fmt::format("Errors among {} cases a cell: missed, false, on another triangle or actuator.", cases),
        "Numbers beside the families: magnitudes, as 'vestige stress -v' defines them."};
    if (has_intervals) {
      std::string text = "In parentheses: 95 % Wilson interval of the share of wrong cases.";
      if (zero_high > 0) text += fmt::format(" No error: the share is below {:.2g} %.", 100 * zero_high);
      lines.push_back(std::move(text));
    }
    if (!result_.renderer.empty()) lines.push_back(fmt::format("OpenGL: {}.", result_.renderer));
    std::string last;
    if (!result_.machine.empty()) last = fmt::format("Machine: {}. ", result_.machine);
    if (!result_.commit.empty()) last += fmt::format("Commit\u00a0{}.", result_.commit);
    if (!last.empty()) lines.push_back(last);
    return lines;
  }

  void draw_small_print(Canvas& canvas) const {
    const std::vector<std::string> lines = small_print();
    double y_pt = kMarginPt + kSmallLinePt * static_cast<double>(lines.size());
    for (const std::string& line : lines) {
      canvas.text({kMarginPt, y_pt}, line, kSmallStyle);
      y_pt -= kSmallLinePt;
    }
  }

  StressResult result_;
  std::vector<Column> columns_;
};

}  // namespace

std::unique_ptr<Figure> stress_figure(StressResult result) {
  return std::make_unique<StressFigure>(std::move(result));
}

}  // namespace vestige::plot
