#include "analysis/plot/figures/skipping_figure.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "analysis/colours/palette.hpp"
#include "analysis/plot/canvas/axis.hpp"
#include "analysis/plot/canvas/small_print.hpp"

namespace vestige::plot {

namespace {

constexpr double kWidthPt = 468;
constexpr double kMarginPt = 8;
constexpr double kTitlePt = 18;
constexpr double kHeadPt = 15;
constexpr double kRowPt = 13;
constexpr double kBarPt = 9;
constexpr double kGroupGapPt = 6;
constexpr double kAxisRoomPt = 32;
constexpr double kLeftPt = 172;
constexpr double kRightPt = 412;
constexpr double kInsetPt = 4;

constexpr TextStyle kTitleStyle = {9, kInk, Anchor::kLeft, Level::kFoot, Weight::kBold};
constexpr TextStyle kHeadStyle = {8, kInk, Anchor::kLeft, Level::kMiddle, Weight::kBold};
constexpr TextStyle kDetailStyle = {7, kSmallPrint, Anchor::kLeft, Level::kMiddle};
constexpr TextStyle kNameStyle = {7, kInk, Anchor::kLeft, Level::kMiddle};
constexpr TextStyle kNumberStyle = {7, kInk, Anchor::kLeft, Level::kMiddle};

struct Row {
  const char* name;
  double SkippedPairs::*pairs;
  Colour colour;
};
constexpr std::array<Row, 4> kRows = {{{"every collider and every triangle", &SkippedPairs::all, {165, 165, 165}},
                                       {"not proven apart by an earlier frame", &SkippedPairs::open, kSkyBlue},
                                       {"in a patch whose box the collider reaches", &SkippedPairs::tested, kOrange},
                                       {"that meet", &SkippedPairs::meeting, kVermillion}}};

/// About three digits.
std::string shown(double number) {
  if (number == 0) return "0";
  if (number < 99.95) return fmt::format("{:.3g}", number);
  return grouped(std::round(number));
}

class SkippingFigure : public Figure {
 public:
  explicit SkippingFigure(SkippingResult result) : result_(std::move(result)), small_print_(small_print()) {}

  double width_pt() const override { return kWidthPt; }
  double height_pt() const override {
    return kMarginPt + kTitlePt + groups_pt() + kAxisRoomPt +
           static_cast<double>(small_print_.size()) * kSmallPrintLinePt + 4;
  }
  std::string description() const override {
    std::string text = "Pairs of collider and triangle left in a frame after each kind of skipping.";
    for (const SkippingGroup& group : result_.groups) {
      text += fmt::format(" {}, {}:", group.name, details(group));
      for (const Row& row : kRows) text += fmt::format(" {} {},", shown(group.pairs.*row.pairs), row.name);
      text.back() = '.';
    }
    return text;
  }

  void draw(Canvas& canvas) const override {
    double top_pt = height_pt() - kMarginPt - kTitlePt;
    canvas.text({kMarginPt, top_pt + 7}, "Pairs that are left after each kind of skipping", kTitleStyle);
    const Box plot = {kLeftPt, top_pt - groups_pt(), kRightPt, top_pt};
    const Axis x = {Scale::kLog, low(), high(), plot.left_pt, plot.right_pt};
    for (const SkippingGroup& group : result_.groups) {
      canvas.text({kMarginPt, top_pt - kHeadPt / 2}, group.name, kHeadStyle);
      canvas.text({kMarginPt + text_width_pt(group.name, kHeadStyle) + kInsetPt, top_pt - kHeadPt / 2}, details(group),
                  kDetailStyle);
      top_pt -= kHeadPt;
      for (const Row& row : kRows) {
        draw_row(canvas, row, group.pairs.*row.pairs, top_pt - kRowPt / 2, x);
        top_pt -= kRowPt;
      }
      top_pt -= kGroupGapPt;
    }
    draw_x_axis(canvas, plot, x, ticks(x), "Pairs of collider and triangle in a frame");
    draw_small_print(canvas, kMarginPt, small_print_);
  }

 private:
  static std::string details(const SkippingGroup& group) {
    std::string text =
        fmt::format("{}, {} \u00b5s a frame", grouped_count(group.colliders, "collider"), shown(group.us));
    if (group.us_off > 0) text += fmt::format("; without skipping {}", shown(group.us_off));
    return text;
  }
  double groups_pt() const {
    return static_cast<double>(result_.groups.size()) *
           (kHeadPt + static_cast<double>(kRows.size()) * kRowPt + kGroupGapPt);
  }
  double low() const {
    double least = 1;
    for (const SkippingGroup& group : result_.groups)
      for (const Row& row : kRows)
        if (group.pairs.*row.pairs > 0) least = std::min(least, group.pairs.*row.pairs);
    return std::pow(10, std::floor(std::log10(least)) - (least == 1 ? 1 : 0));
  }
  double high() const {
    double most = 10;
    for (const SkippingGroup& group : result_.groups) most = std::max(most, group.pairs.all);
    return round_up_125(most);
  }

  /// Labels of large numbers have no room at each power of ten.
  static std::vector<Tick> ticks(const Axis& x) {
    constexpr double kMostDecades = 6;
    std::vector<Tick> ticks = log_ticks(x.low, x.high);
    if (std::log10(x.high / x.low) <= kMostDecades) return ticks;
    for (Tick& tick : ticks)
      if (std::lround(std::log10(tick.value)) % 2 != 0) tick.label.clear();
    return ticks;
  }

  static void draw_row(Canvas& canvas, const Row& row, double pairs, double y_pt, const Axis& x) {
    canvas.text({kMarginPt, y_pt}, row.name, kNameStyle);
    const double end_pt = pairs > x.low ? x.place_pt(pairs) : kLeftPt;
    if (end_pt > kLeftPt) canvas.rectangle({kLeftPt, y_pt - kBarPt / 2, end_pt, y_pt + kBarPt / 2}, row.colour);
    canvas.text({end_pt + kInsetPt, y_pt}, shown(pairs), kNumberStyle);
  }

  std::vector<std::string> small_print() const {
    const SweepSource& source = result_.source;
    std::string text =
        "Means over the frames that a sweep measured, of cpu with skipping. What an earlier frame proved apart is "
        "counted "
        "in pairs of a collider in reach and a part of the skin, and drawn as that share of all pairs. ";
    if (!source.machine.empty()) text += fmt::format("Machine: {}. ", source.machine);
    if (!source.avatar.empty()) text += fmt::format("Avatar: {}. ", source.avatar);
    text += fmt::format("Commit\u00a0{}.", source.commit);
    return wrapped(text, kSmallPrintStyle, kWidthPt - 2 * kMarginPt);
  }

  SkippingResult result_;
  std::vector<std::string> small_print_;
};

}  // namespace

std::unique_ptr<Figure> skipping_figure(SkippingResult result) {
  return std::make_unique<SkippingFigure>(std::move(result));
}

}  // namespace vestige::plot
