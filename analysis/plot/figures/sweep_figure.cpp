#include "analysis/plot/figures/sweep_figure.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <set>

#include "analysis/colours/palette.hpp"
#include "analysis/plot/canvas/axis.hpp"
#include "analysis/plot/canvas/free_place.hpp"
#include "analysis/plot/canvas/small_print.hpp"

namespace vestige::plot {

namespace {

/// Spanlang et al., HAVE 2010, Figure 2 and section 4: "over" these frequencies, hence marks that point upwards.
constexpr std::array<SweepPoint, 3> kPublished = {SweepPoint{1, 5000, {}, {}}, SweepPoint{40, 1000, {}, {}},
                                                  SweepPoint{100, 500, {}, {}}};
constexpr const char* kPublishedName = "HAVE 2010, GeForce GTX 285";

struct Reference {
  double hz;
  const char* label;
};
constexpr std::array<Reference, 2> kReferences = {Reference{1000, "1 kHz"}, Reference{500, "500 Hz"}};

constexpr double kWidthPt = 468;
constexpr double kPlotHeightPt = 240;
constexpr double kLeftPt = 48;
constexpr double kAxisRoomPt = 34;
constexpr double kLabelGapPt = 10;
constexpr double kLabelIndentPt = 16;
constexpr double kMarginPt = 8;
/// Up to here the axis is linear, as the paper's is; counts beyond it span decades.
constexpr double kLinearColliders = 200;
/// A line with more points than this is marked at some of them only.
constexpr std::size_t kMarkedPoints = 16;
constexpr std::array<Mark, 3> kMarks = {Mark::kCircle, Mark::kSquare, Mark::kDiamond};

constexpr TextStyle kLabelStyle = {8, kInk, Anchor::kLeft, Level::kMiddle};
constexpr TextStyle kNoteStyle = {7, kInk, Anchor::kLeft, Level::kFoot};

/// Letters are thinner than lines: the same colour needs more contrast.
Colour darkened(Colour colour) {
  const auto part = [](std::uint8_t value) { return static_cast<std::uint8_t>(value * 3 / 4); };
  return {part(colour.red), part(colour.green), part(colour.blue), colour.alpha};
}

/// Whether the same was also measured with another value of `setting`, from which a line must be told.
template <typename T>
bool has_twin(const Sweeps& sweeps, const SweepSeries& series, T SweepSeries::*setting) {
  return std::ranges::any_of(sweeps.series, [&](const SweepSeries& one) {
    return one.detector == series.detector && one.context == series.context && one.method == series.method &&
           one.sweep == series.sweep && one.*setting != series.*setting;
  });
}

bool is_without_skipping(const Sweeps& sweeps, const SweepSeries& series) {
  return series.skip == "off" && has_twin(sweeps, series, &SweepSeries::skip);
}

bool is_beside_renderer(const Sweeps& sweeps, const SweepSeries& series) {
  return series.renderer == "on" && has_twin(sweeps, series, &SweepSeries::renderer);
}

std::set<std::string> methods_of(const Sweeps& sweeps) {
  std::set<std::string> methods;
  for (const SweepSeries& series : sweeps.series) methods.insert(series.method);
  return methods;
}

/// The detectors that skip, as "cpu, geometry".
std::string skipping_detectors(const Sweeps& sweeps) {
  std::vector<std::string> detectors;
  for (const SweepSeries& series : sweeps.series)
    if (series.skip == "on" && std::ranges::find(detectors, series.detector) == detectors.end())
      detectors.push_back(series.detector);
  return fmt::format("{}", fmt::join(detectors, ", "));
}

/// Names each series by its detector and by whatever else tells it from the others.
std::vector<std::string> series_names(const Sweeps& sweeps) {
  std::set<std::string> contexts;
  for (const SweepSeries& series : sweeps.series)
    if (!series.context.empty()) contexts.insert(series.context);
  const std::set<std::string> methods = methods_of(sweeps);
  std::vector<std::string> names;
  for (const SweepSeries& series : sweeps.series) {
    std::string name = series.detector;
    if (series.approximate) name += " (approximate)";
    if (series.people > 1) name += fmt::format(", {} people", series.people);
    if (contexts.size() > 1 && !series.context.empty()) name.append(", ").append(series.context);
    if (methods.size() > 1) name.append(", ").append(series.method);
    if (has_twin(sweeps, series, &SweepSeries::planes))
      name += fmt::format(", {} plane{}", series.planes, series.planes == 1 ? "" : "s");
    if (is_without_skipping(sweeps, series)) name += ", no skipping";
    if (is_beside_renderer(sweeps, series)) name += ", rendering";
    if (sweeps.sources.size() > 1) name += fmt::format(" [{}]", series.sweep + 1);
    names.push_back(name);
  }
  return names;
}

std::vector<std::string> wrapped(const std::string& text) {
  return plot::wrapped(text, kSmallPrintStyle, kWidthPt - 2 * kMarginPt);
}

std::vector<std::string> small_print(const Sweeps& sweeps) {
  std::vector<std::string> lines;
  bool has_interval = false;
  bool has_area = false;
  for (const SweepSeries& series : sweeps.series) {
    has_interval |= series.points.front().hz_low.has_value();
    has_area |= series.points.size() > 1;
  }
  std::string first = "Frequency is frames / total time, whole round trip.";
  if (has_interval) first += fmt::format(" {}: 95 % bootstrap interval.", has_area ? "Shaded" : "Upright lines");
  first += " Triangles: published lower bounds.";
  if (const std::string skipping = skipping_detectors(sweeps); !skipping.empty())
    first += fmt::format(" {} skip skin that no collider can touch, unless a name says otherwise.", skipping);
  if (const auto methods = methods_of(sweeps); methods.size() == 1 && !methods.begin()->empty())
    first += fmt::format(" Method: {}.", *methods.begin());
  lines = wrapped(first);
  for (std::size_t i = 0; i < sweeps.sources.size(); ++i) {
    const SweepSource& source = sweeps.sources[i];
    std::string text = sweeps.sources.size() > 1 ? fmt::format("[{}] ", i + 1) : "";
    if (!source.renderer.empty()) text += fmt::format("OpenGL: {}. ", source.renderer);
    if (!source.machine.empty()) text += fmt::format("Machine: {}. ", source.machine);
    if (!source.avatar.empty()) text += fmt::format("Avatar: {}. ", source.avatar);
    if (source.surface == "mapped") text += "Mapped triangles only. ";
    if (!source.complete) text += "Not complete: the run was stopped before its end. ";
    text += fmt::format("Commit\u00a0{}.", source.commit);
    for (std::string& line : wrapped(text)) lines.push_back(std::move(line));
  }
  return lines;
}

class SweepFigure : public Figure {
 public:
  explicit SweepFigure(Sweeps sweeps)
      : sweeps_(std::move(sweeps)), names_(series_names(sweeps_)), small_print_(small_print(sweeps_)) {}

  double width_pt() const override { return kWidthPt; }
  double height_pt() const override {
    return kMarginPt + plot_height_pt() + kAxisRoomPt + static_cast<double>(small_print_.size()) * kSmallPrintLinePt +
           4;
  }
  std::string description() const override {
    std::string text =
        fmt::format("Detection frequency over number of colliders. Published: {}. Measured:", kPublishedName);
    for (std::size_t i = 0; i < names_.size(); ++i) {
      const SweepPoint& last = sweeps_.series[i].points.back();
      text += fmt::format(" {} ({:.4g} Hz at {}).", names_[i], last.hz, grouped_count(last.colliders, "collider"));
    }
    return text;
  }

  void draw(Canvas& canvas) const override {
    double label_width_pt = 0;
    for (const std::string& name : names_) label_width_pt = std::max(label_width_pt, text_width_pt(name, kLabelStyle));
    const Box plot = {kLeftPt, height_pt() - kMarginPt - plot_height_pt(),
                      kWidthPt - label_width_pt - kLabelIndentPt - 6, height_pt() - kMarginPt};
    const Axis x = x_axis(plot);
    const Axis y = y_axis(plot);
    draw_frame(canvas, plot, x, y);
    FreePlace free_place(plot);
    for (std::size_t i = 0; i < sweeps_.series.size(); ++i) draw_band(canvas, i, x, y);
    for (std::size_t i = 0; i < sweeps_.series.size(); ++i) free_place.take(draw_line(canvas, i, x, y));
    for (const Reference& reference : kReferences) {
      const double y_pt = y.place_pt(reference.hz);
      const std::array<Place, 2> line = {Place{plot.left_pt, y_pt}, Place{plot.right_pt, y_pt}};
      free_place.take(line);
    }
    draw_published(canvas, x, y, free_place);
    draw_reference_labels(canvas, plot, y, free_place);
    draw_labels(canvas, plot, x, y);
    draw_small_print(canvas, kMarginPt, small_print_);
  }

 private:
  /// Enough for all the labels on the right.
  double plot_height_pt() const {
    return std::max(kPlotHeightPt, static_cast<double>(names_.size() + 1) * kLabelGapPt);
  }

  /// Colour tells detectors and contexts apart, paleness numbers of planes, dashes say that nothing was skipped, dots
  /// that a renderer ran beside it, marks tell files apart: what belongs together looks alike.
  Colour colour(std::size_t index) const {
    std::vector<std::array<std::string, 3>> kinds;
    const auto kind = [](const SweepSeries& series) {
      return std::array{series.detector, series.context, series.method};
    };
    for (const SweepSeries& series : sweeps_.series)
      if (std::ranges::find(kinds, kind(series)) == kinds.end()) kinds.push_back(kind(series));
    const auto found = std::ranges::find(kinds, kind(sweeps_.series[index]));
    std::vector<std::string> detectors;
    detectors.reserve(kinds.size());
    for (const auto& one : kinds) detectors.push_back(one.front());
    return line_colours(detectors)[static_cast<std::size_t>(found - kinds.begin())];
  }

  /// The more planes, the paler.
  Colour line_colour(std::size_t index) const {
    constexpr double kPalest = 0.6;
    const SweepSeries& series = sweeps_.series[index];
    if (!has_twin(sweeps_, series, &SweepSeries::planes)) return colour(index);
    std::set<double> counts;
    for (const SweepSeries& one : sweeps_.series)
      if (one.detector == series.detector) counts.insert(one.planes);
    const auto fewer = std::distance(counts.begin(), counts.find(series.planes));
    return blend(colour(index), kWhite, kPalest * static_cast<double>(fewer) / static_cast<double>(counts.size() - 1));
  }

  Axis x_axis(const Box& plot) const {
    double most = kPublished.back().colliders;
    for (const SweepSeries& series : sweeps_.series) most = std::max(most, series.points.back().colliders);
    if (most <= kLinearColliders) return {Scale::kLinear, 0, most * 1.02, plot.left_pt, plot.right_pt};
    return {Scale::kLog, 0.9, most * 1.1, plot.left_pt, plot.right_pt};
  }

  Axis y_axis(const Box& plot) const {
    double least = kPublished.back().hz;
    double most = kPublished.front().hz;
    for (const SweepSeries& series : sweeps_.series) {
      for (const SweepPoint& point : series.points) {
        least = std::min({least, point.hz, point.hz_low.value_or(point.hz)});
        most = std::max({most, point.hz, point.hz_high.value_or(point.hz)});
      }
    }
    return {Scale::kLog, round_down_125(least * 0.9), round_up_125(most * 1.1), plot.bottom_pt, plot.top_pt};
  }

  static Place place(const SweepPoint& point, const Axis& x, const Axis& y) {
    return {x.place_pt(point.colliders), y.place_pt(point.hz)};
  }

  static void draw_frame(Canvas& canvas, const Box& plot, const Axis& x, const Axis& y) {
    const std::vector<Tick> y_ticks = log_ticks(y.low, y.high);
    for (const Tick& tick : y_ticks) {
      const double y_pt = y.place_pt(tick.value);
      if (!tick.label.empty()) canvas.line({plot.left_pt, y_pt}, {plot.right_pt, y_pt}, {kGrid, 0.4, Dash::kSolid});
    }
    for (const Reference& reference : kReferences) {
      const double y_pt = y.place_pt(reference.hz);
      canvas.line({plot.left_pt, y_pt}, {plot.right_pt, y_pt}, {kSmallPrint, 0.5, Dash::kDotted});
    }
    std::vector<Tick> x_ticks = x.scale == Scale::kLog ? log_ticks(1, x.high) : linear_ticks(0, x.high, 6);
    // Counts start with 1.
    if (x.scale == Scale::kLinear) x_ticks.front() = {1, "1"};
    draw_x_axis(canvas, plot, x, x_ticks, "Number of colliders");
    draw_y_axis(canvas, plot, y, y_ticks, "Detection frequency (Hz)");
  }

  void draw_band(Canvas& canvas, std::size_t index, const Axis& x, const Axis& y) const {
    const std::vector<SweepPoint>& points = sweeps_.series[index].points;
    const Colour shade = faded(line_colour(index), 0.22);
    // A single point has no area.
    if (const SweepPoint& only = points.front(); points.size() == 1 && only.hz_low)
      canvas.line(place({only.colliders, *only.hz_low, {}, {}}, x, y),
                  place({only.colliders, *only.hz_high, {}, {}}, x, y), {line_colour(index), 0.8, Dash::kSolid});
    for (std::size_t i = 1; i < points.size(); ++i) {
      const SweepPoint& from = points[i - 1];
      const SweepPoint& to = points[i];
      if (!from.hz_low || !to.hz_low) continue;
      const double left_pt = x.place_pt(from.colliders);
      const double right_pt = x.place_pt(to.colliders);
      const std::array<Place, 4> corners = {
          Place{left_pt, y.place_pt(*from.hz_low)}, Place{right_pt, y.place_pt(*to.hz_low)},
          Place{right_pt, y.place_pt(*to.hz_high)}, Place{left_pt, y.place_pt(*from.hz_high)}};
      canvas.polygon(corners, shade);
    }
  }

  std::vector<Place> draw_line(Canvas& canvas, std::size_t index, const Axis& x, const Axis& y) const {
    const SweepSeries& series = sweeps_.series[index];
    std::vector<Place> line;
    for (const SweepPoint& point : series.points) line.push_back(place(point, x, y));
    Dash dash = is_without_skipping(sweeps_, series) ? Dash::kDashed : Dash::kSolid;
    if (is_beside_renderer(sweeps_, series)) dash = Dash::kDotted;
    canvas.polyline(line, {line_colour(index), 1.2, dash});
    const std::size_t step = (line.size() + kMarkedPoints - 1) / kMarkedPoints;
    for (std::size_t i = line.size(); i > 0; i -= std::min(step, i))
      canvas.mark(line[i - 1], kMarks[series.sweep % kMarks.size()], 3.6, line_colour(index), kWhite);
    return line;
  }

  static void draw_published(Canvas& canvas, const Axis& x, const Axis& y, FreePlace& free_place) {
    for (const SweepPoint& point : kPublished) {
      const Place at = place(point, x, y);
      canvas.mark(at, Mark::kTriangleUp, 7, kBlack, kWhite);
      free_place.take({at.x_pt - 5, at.y_pt - 4, at.x_pt + 5, at.y_pt + 6});
    }
    const double width_pt = text_width_pt(kPublishedName, kNoteStyle);
    constexpr double kHeightPt = 9;
    std::vector<Box> boxes;
    for (const double distance_pt : {7.0, 16.0, 28.0, 44.0, 64.0}) {
      for (const std::size_t which : {std::size_t{0}, std::size_t{1}, std::size_t{2}}) {
        const Place at = place(kPublished[which], x, y);
        const double right_pt = at.x_pt + 6;
        const double left_pt = at.x_pt - 6 - width_pt;
        const double middle_pt = at.x_pt - width_pt / 2;
        const double above_pt = at.y_pt + distance_pt;
        const double below_pt = at.y_pt - distance_pt - kHeightPt;
        const double beside_pt = at.y_pt - kHeightPt / 2;
        const double gap_pt = distance_pt - 7;
        for (const Place corner : {Place{right_pt + gap_pt, beside_pt}, Place{right_pt, above_pt},
                                   Place{middle_pt, above_pt}, Place{right_pt, below_pt}, Place{middle_pt, below_pt},
                                   Place{left_pt, above_pt}, Place{left_pt, below_pt}})
          boxes.push_back({corner.x_pt, corner.y_pt, corner.x_pt + width_pt, corner.y_pt + kHeightPt});
      }
    }
    const Box box = free_place.take_first(boxes);
    canvas.text({box.left_pt, box.bottom_pt + 2}, kPublishedName, kNoteStyle);
  }

  static void draw_reference_labels(Canvas& canvas, const Box& plot, const Axis& y, FreePlace& free_place) {
    for (const Reference& reference : kReferences) {
      const double y_pt = y.place_pt(reference.hz);
      const double width_pt = text_width_pt(reference.label, kNoteStyle);
      std::vector<Box> boxes;
      const int places = static_cast<int>((plot.width_pt() - width_pt) / 6);
      for (int i = 0; i < places; ++i) {
        const double right_pt = plot.right_pt - 2 - i * 6;
        boxes.push_back({right_pt - width_pt, y_pt + 1, right_pt, y_pt + 8});
        boxes.push_back({right_pt - width_pt, y_pt - 8, right_pt, y_pt - 1});
      }
      const Box box = free_place.take_first(boxes);
      TextStyle style = kNoteStyle;
      style.colour = kSmallPrint;
      canvas.text({box.left_pt, box.bottom_pt + 1}, reference.label, style);
    }
  }

  void draw_labels(Canvas& canvas, const Box& plot, const Axis& x, const Axis& y) const {
    std::vector<double> heights_pt;
    for (const SweepSeries& series : sweeps_.series) heights_pt.push_back(y.place_pt(series.points.back().hz));
    spread(heights_pt, kLabelGapPt, plot.bottom_pt + 3, plot.top_pt - 3);
    for (std::size_t i = 0; i < names_.size(); ++i) {
      const Place end = place(sweeps_.series[i].points.back(), x, y);
      const double left_pt = plot.right_pt + kLabelIndentPt;
      const std::array<Place, 3> leader = {Place{end.x_pt + 2.5, end.y_pt},
                                           Place{std::max(end.x_pt + 2.5, plot.right_pt + 3), end.y_pt},
                                           Place{left_pt - 2, heights_pt[i]}};
      const bool far = end.x_pt < plot.right_pt - 2 * kLabelIndentPt;
      canvas.polyline(leader, {line_colour(i), 0.5, far ? Dash::kDotted : Dash::kSolid});
      TextStyle style = kLabelStyle;
      style.colour = darkened(colour(i));
      canvas.text({left_pt, heights_pt[i]}, names_[i], style);
    }
  }

  Sweeps sweeps_;
  std::vector<std::string> names_;
  std::vector<std::string> small_print_;
};

}  // namespace

std::unique_ptr<Figure> sweep_figure(Sweeps sweeps) {
  return std::make_unique<SweepFigure>(std::move(sweeps));
}

}  // namespace vestige::plot
