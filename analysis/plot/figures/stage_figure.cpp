#include "analysis/plot/figures/stage_figure.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <utility>

#include "analysis/colours/palette.hpp"
#include "analysis/plot/canvas/axis.hpp"
#include "analysis/plot/canvas/small_print.hpp"

namespace vestige::plot {

namespace {

constexpr double kWidthPt = 468;
constexpr double kMarginPt = 8;
constexpr double kTitlePt = 16;
constexpr double kLegendLinePt = 10;
constexpr std::size_t kLegendColumns = 3;
constexpr double kHeadPt = 18;  ///< the columns' titles
constexpr double kBarPt = 10;
constexpr double kRowPt = 12.5;
constexpr double kLeastGroupPt = 20;  ///< a name and its details
constexpr double kGroupGapPt = 5;
constexpr double kAxisRoomPt = 32;
constexpr double kCountsPt = 138;  ///< the right edge of the numbers of colliders
constexpr double kLeftPt = 144;
constexpr double kRightPt = 416;
constexpr double kInsetPt = 3;

constexpr TextStyle kTitleStyle = {9, kInk, Anchor::kLeft, Level::kFoot, Weight::kBold};
constexpr TextStyle kNameStyle = {8, kInk, Anchor::kLeft, Level::kMiddle, Weight::kBold};
constexpr TextStyle kDetailStyle = {6, kSmallPrint, Anchor::kLeft, Level::kMiddle};
constexpr TextStyle kCountStyle = {7, kInk, Anchor::kRight, Level::kMiddle};
constexpr TextStyle kTotalStyle = {8, kInk, Anchor::kRight, Level::kMiddle, Weight::kBold};
constexpr TextStyle kPartStyle = {6, kInk, Anchor::kCentre, Level::kMiddle};
constexpr TextStyle kLegendStyle = {7, kInk, Anchor::kLeft, Level::kMiddle, Weight::kBold};

struct StageLook {
  const char* name;
  const char* meaning;
  Colour colour;
};
/// In the order of `Stage`: what follows each other in a bar is told apart in grey print, too.
constexpr std::array<StageLook, kStageNames.size()> kLooks = {{
    {"pose", "joint matrices, segments", {165, 165, 165}},
    {"candidates", "bounds that leave pairs out", kSkyBlue},
    {"skinning", "vertices, on the CPU", kGreen},
    {"upload", "data, to the driver", kPurple},
    {"draw", "the shaders at work", kBlue},
    {"wait", "for the driver", {212, 220, 230}},
    {"read-back", "results, to the CPU", {70, 70, 95}},
    {"test", "segments against triangles", kOrange},
    {"decision", "exact answers, contacts", kVermillion},
}};
constexpr const char* kDrawAndWait = "the shaders";

double total_of(const StageBar& bar) {
  return std::accumulate(bar.stages.us.begin(), bar.stages.us.end(), 0.0);
}

/// About three digits.
std::string shown_us(double us) {
  if (us < 0.995) return fmt::format("{:.2f}", us);
  return us < 99.95 ? fmt::format("{:.1f}", us) : grouped(std::round(us));
}

/// Whether white letters are read better on it than dark ones.
bool is_dark(Colour colour) {
  return 0.299 * colour.red + 0.587 * colour.green + 0.114 * colour.blue < 140;
}

bool is_drawn(const StageBar& bar) {
  return bar.stages.us[static_cast<std::size_t>(Stage::kDraw)] > 0;
}

class StageFigure : public Figure {
 public:
  explicit StageFigure(StageResult result) : result_(std::move(result)) {
    for (const StageGroup& group : result_.groups)
      for (const StageBar& bar : group.bars) {
        if (is_drawn(bar)) (bar.stages.drawn_by_timer ? any_timer_ : any_clock_) = true;
        for (std::size_t i = 0; i < kLooks.size(); ++i) occurs_[i] = occurs_[i] || bar.stages.us[i] > 0;
      }
    small_print_ = small_print();
  }

  double width_pt() const override { return kWidthPt; }
  double height_pt() const override {
    return kMarginPt + kTitlePt + legend_pt() + kHeadPt + groups_pt() + kAxisRoomPt +
           static_cast<double>(small_print_.size()) * kSmallPrintLinePt + 4;
  }
  std::string description() const override {
    std::string text = "Where the time of a frame goes, in microseconds.";
    for (const StageGroup& group : result_.groups) {
      const StageBar& bar = group.bars.back();
      text += fmt::format(" {}, {}:", title(group), grouped_count(bar.colliders, "collider"));
      for (std::size_t i = 0; i < kLooks.size(); ++i)
        if (bar.stages.us[i] > 0) text += fmt::format(" {} {},", kLooks[i].name, shown_us(bar.stages.us[i]));
      text += fmt::format(" together {}.", shown_us(total_of(bar)));
    }
    return text;
  }

  void draw(Canvas& canvas) const override {
    double top_pt = height_pt() - kMarginPt - kTitlePt;
    canvas.text({kMarginPt, top_pt + 5}, "Where the time of a frame goes", kTitleStyle);
    draw_legend(canvas, top_pt);
    top_pt -= legend_pt();
    TextStyle head = kSmallPrintStyle;
    head.level = Level::kMiddle;
    head.anchor = Anchor::kRight;
    canvas.text({kCountsPt, top_pt - kHeadPt / 2}, "colliders", head);
    canvas.text({kWidthPt - kMarginPt, top_pt - kHeadPt / 2}, "\u00b5s a frame", head);
    head.anchor = Anchor::kLeft;
    canvas.text({kLeftPt, top_pt - kHeadPt / 2}, "each bar is a whole frame; the numbers in it are \u00b5s", head);
    top_pt -= kHeadPt;
    const Box plot = {kLeftPt, top_pt - groups_pt(), kRightPt, top_pt};
    const Axis x = {Scale::kLinear, 0, 100, plot.left_pt, plot.right_pt};
    for (const StageGroup& group : result_.groups) {
      draw_group(canvas, group, top_pt, x);
      top_pt -= group_pt(group) + kGroupGapPt;
    }
    draw_x_axis(canvas, plot, x, linear_ticks(0, 100, 6), "Share of the frame (%)");
    draw_small_print(canvas, kMarginPt, small_print_);
  }

 private:
  static std::string title(const StageGroup& group) {
    return group.details.empty() ? group.detector : fmt::format("{}, {}", group.detector, group.details);
  }
  static double group_pt(const StageGroup& group) {
    return std::max(kLeastGroupPt, static_cast<double>(group.bars.size()) * kRowPt);
  }
  double groups_pt() const {
    double height_pt = 0;
    for (const StageGroup& group : result_.groups) height_pt += group_pt(group) + kGroupGapPt;
    return height_pt;
  }
  std::size_t legend_lines() const {
    const auto entries = static_cast<std::size_t>(std::ranges::count(occurs_, true));
    return (entries + kLegendColumns - 1) / kLegendColumns;
  }
  double legend_pt() const { return static_cast<double>(legend_lines()) * kLegendLinePt + 4; }

  std::vector<std::string> small_print() const {
    std::string text =
        "Means over frames, measured in a pass of its own: reading the clock slows a detector down, and its own cost "
        "is "
        "taken off. ";
    if (any_timer_) text += "Draw is by the driver's timer; the rest of the time until all is drawn counts as wait. ";
    if (any_clock_)
      text += any_timer_ ? "Where there is no wait, draw is by the CPU's clock until its calls return. "
                         : "Draw is by the CPU's clock until its calls return, as the driver has no timer to be "
                           "believed; what it does later is a part of the read-back. ";
    const SweepSource& source = result_.source;
    if (!source.renderer.empty() && (any_timer_ || any_clock_)) text += fmt::format("OpenGL: {}. ", source.renderer);
    if (!source.machine.empty()) text += fmt::format("Machine: {}. ", source.machine);
    if (!source.avatar.empty()) text += fmt::format("Avatar: {}. ", source.avatar);
    if (source.surface == "mapped") text += "Mapped triangles only. ";
    if (!source.complete) text += "Not complete: the run was stopped before its end. ";
    text += fmt::format("Commit\u00a0{}.", source.commit);
    return wrapped(text, kSmallPrintStyle, kWidthPt - 2 * kMarginPt);
  }

  /// Down the columns, so that stages that follow each other are beneath each other.
  void draw_legend(Canvas& canvas, double top_pt) const {
    const double column_pt = (kWidthPt - 2 * kMarginPt) / kLegendColumns;
    const std::size_t lines = legend_lines();
    std::size_t column = 0;
    std::size_t line = 0;
    for (std::size_t i = 0; i < kLooks.size(); ++i) {
      if (!occurs_[i]) continue;
      const double left_pt = kMarginPt + static_cast<double>(column) * column_pt;
      const double y_pt = top_pt - (static_cast<double>(line) + 0.5) * kLegendLinePt;
      canvas.rectangle({left_pt, y_pt - 3, left_pt + 9, y_pt + 3}, kLooks[i].colour);
      canvas.text({left_pt + 13, y_pt}, kLooks[i].name, kLegendStyle);
      const bool with_wait = static_cast<Stage>(i) == Stage::kDraw && !any_timer_;
      canvas.text({left_pt + 16 + text_width_pt(kLooks[i].name, kLegendStyle), y_pt},
                  with_wait ? kDrawAndWait : kLooks[i].meaning, kDetailStyle);
      if (++line < lines) continue;
      line = 0;
      ++column;
    }
  }

  static void draw_group(Canvas& canvas, const StageGroup& group, double top_pt, const Axis& x) {
    const double room_pt = kCountsPt - kMarginPt - 24;
    const double name_pt = top_pt - kRowPt / 2;
    canvas.text({kMarginPt, name_pt}, shortened(group.detector, kNameStyle, room_pt), kNameStyle);
    canvas.text({kMarginPt, name_pt - 9}, shortened(group.details, kDetailStyle, room_pt), kDetailStyle);
    for (const StageBar& bar : group.bars) {
      draw_bar(canvas, bar, top_pt - kRowPt / 2, x);
      top_pt -= kRowPt;
    }
  }

  static void draw_bar(Canvas& canvas, const StageBar& bar, double y_pt, const Axis& x) {
    canvas.text({kCountsPt, y_pt}, grouped(bar.colliders), kCountStyle);
    const double total_us = total_of(bar);
    double done_us = 0;
    for (std::size_t i = 0; i < kLooks.size(); ++i) {
      const double us = bar.stages.us[i];
      const double left_pt = x.place_pt(100 * done_us / total_us);
      done_us += us;
      const Box part = {left_pt, y_pt - kBarPt / 2, x.place_pt(100 * done_us / total_us), y_pt + kBarPt / 2};
      canvas.rectangle(part, kLooks[i].colour);
      TextStyle style = kPartStyle;
      if (is_dark(kLooks[i].colour)) style.colour = kWhite;
      if (const std::string text = shown_us(us); text_width_pt(text, style) + kInsetPt <= part.width_pt())
        canvas.text({(part.left_pt + part.right_pt) / 2, y_pt}, text, style);
    }
    canvas.text({kWidthPt - kMarginPt, y_pt}, shown_us(total_us), kTotalStyle);
  }

  StageResult result_;
  std::array<bool, kLooks.size()> occurs_ = {};
  bool any_timer_ = false;
  bool any_clock_ = false;
  std::vector<std::string> small_print_;
};

}  // namespace

std::unique_ptr<Figure> stage_figure(StageResult result) {
  return std::make_unique<StageFigure>(std::move(result));
}

}  // namespace vestige::plot
