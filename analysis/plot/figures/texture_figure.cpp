#include "analysis/plot/figures/texture_figure.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "analysis/colours/palette.hpp"
#include "analysis/plot/canvas/axis.hpp"
#include "analysis/plot/canvas/colour_bar.hpp"
#include "traces/base/number_text.hpp"

namespace vestige::plot {

namespace {

constexpr double kWidthPt = 468;
constexpr double kLeftPt = 54;
constexpr double kRightPt = 354;
constexpr double kLegendPt = 366;
constexpr double kAxisRoomPt = 36;
constexpr double kTopPt = 12;
constexpr double kLeastHeightPt = 120;
constexpr double kMostHeightPt = 420;
constexpr double kFrameHeightPt = 3;
constexpr double kLegendLinePt = 11;
/// The least width and height of a contact: about 0.4 mm in print.
constexpr std::size_t kLeastMarkDots = 5;

constexpr Colour kBackground = kWhite;

/// Dots [begin, end) of item `index` of `count` along `dots`.
struct Span {
  std::size_t begin;
  std::size_t end;
};

Span item_span(std::size_t index, std::size_t count, std::size_t dots) {
  const std::size_t begin = index * dots / count;
  return {begin, std::max((index + 1) * dots / count, begin + 1)};
}

/// `span` with at least `kLeastMarkDots`, around its middle, within [0, dots).
Span grown(Span span, std::size_t dots) {
  const std::size_t size = span.end - span.begin;
  if (size >= kLeastMarkDots || dots < kLeastMarkDots) return span;
  const std::size_t before = (kLeastMarkDots - size) / 2;
  const std::size_t begin = std::min(span.begin - std::min(span.begin, before), dots - kLeastMarkDots);
  return {begin, begin + kLeastMarkDots};
}

class TextureFigure : public Figure {
 public:
  explicit TextureFigure(TextureContacts textures) : textures_(std::move(textures)) {
    for (const TextureContact& contact : textures_.contacts) ++contacts_of_[contact.actuator];
  }

  double width_pt() const override { return kWidthPt; }
  double height_pt() const override { return kAxisRoomPt + plot_height_pt() + kTopPt; }
  std::string description() const override {
    return fmt::format("Collision textures of {} and {} with {}.", counted(textures_.frames, "frame"),
                       counted(textures_.colliders, "collider"), counted(textures_.contacts.size(), "contact"));
  }

  void draw(Canvas& canvas) const override {
    const Box plot = {kLeftPt, kAxisRoomPt, kRightPt, kAxisRoomPt + plot_height_pt()};
    canvas.image(plot, raster(plot));
    canvas.frame(plot, {kInk, 0.4, Dash::kSolid});
    const Axis x = {Scale::kLinear, 0, static_cast<double>(textures_.colliders), plot.left_pt, plot.right_pt};
    draw_x_axis(canvas, plot, x, linear_ticks(x.low, x.high, 6, 1), "Collider");
    const Axis y = {Scale::kLinear, 0, static_cast<double>(textures_.frames), plot.top_pt, plot.bottom_pt};
    draw_y_axis(canvas, plot, y, linear_ticks(y.low, y.high, 8, 1), "Frame");
    draw_legend(canvas, plot);
  }

 private:
  double plot_height_pt() const {
    const double wish_pt = static_cast<double>(textures_.frames) * kFrameHeightPt;
    return std::ceil(std::clamp(wish_pt, kLeastHeightPt, kMostHeightPt) / 6) * 6;
  }

  std::size_t highest_actuator() const { return contacts_of_.empty() ? 0 : contacts_of_.rbegin()->first; }
  /// Else numbers stand for themselves, on a ramp.
  bool has_categories() const { return highest_actuator() <= kActuatorColours.size(); }

  std::string name_of(std::size_t actuator) const {
    if (actuator > textures_.names.size()) return fmt::format("actuator {}", actuator);
    const std::string& name = textures_.names[actuator - 1];
    return name.empty() ? fmt::format("actuator {}", actuator) : fmt::format("{} {}", actuator, name);
  }

  Colour colour(std::size_t actuator) const {
    if (actuator == 0) return kUnmapped;
    if (has_categories()) return kActuatorColours[actuator - 1];
    return number_ramp(static_cast<double>(actuator - 1) / static_cast<double>(highest_actuator() - 1));
  }

  Raster raster(const Box& plot) const {
    const std::size_t columns = print_dots(plot.width_pt());
    const std::size_t rows = print_dots(plot.height_pt());
    // What a dot shows: the first contact in it, one with an actuator before one without.
    constexpr std::int32_t kNone = -1;
    std::vector<std::int32_t> shown(columns * rows, kNone);
    const auto paint = [&](Span across, Span down, std::int32_t actuator, auto may_replace) {
      for (std::size_t row = down.begin; row < down.end; ++row)
        for (std::size_t column = across.begin; column < across.end; ++column)
          if (std::int32_t& dot = shown[row * columns + column]; may_replace(dot)) dot = actuator;
    };
    for (const TextureContact& contact : textures_.contacts)
      paint(item_span(contact.collider, textures_.colliders, columns), item_span(contact.frame, textures_.frames, rows),
            contact.actuator, [](std::int32_t dot) { return dot <= 0; });
    // Growing marks to a visible size comes second: it must hide no other contact.
    for (const TextureContact& contact : textures_.contacts)
      paint(grown(item_span(contact.collider, textures_.colliders, columns), columns),
            grown(item_span(contact.frame, textures_.frames, rows), rows), contact.actuator,
            [](std::int32_t dot) { return dot == kNone; });
    Raster result(columns, rows, kBackground);
    for (std::size_t row = 0; row < rows; ++row)
      for (std::size_t column = 0; column < columns; ++column)
        if (const std::int32_t dot = shown[row * columns + column]; dot != kNone)
          result.at(column, row) = colour(static_cast<std::size_t>(dot));
    return result;
  }

  void draw_legend(Canvas& canvas, const Box& plot) const {
    double y_pt = plot.top_pt - 4;
    const auto entry = [&](std::size_t actuator, std::string_view name, std::size_t count) {
      canvas.rectangle({kLegendPt, y_pt - 3, kLegendPt + 10, y_pt + 3}, colour(actuator));
      const std::string behind = fmt::format(" ({})", grouped(static_cast<double>(count)));
      const double room_pt = kWidthPt - 2 - kLegendPt - 14 - text_width_pt(behind, {7, kInk});
      canvas.text({kLegendPt + 14, y_pt}, shortened(std::string(name), {7, kInk}, room_pt) + behind, {7, kInk});
      y_pt -= kLegendLinePt;
    };
    if (contacts_of_.empty()) canvas.text({kLegendPt, y_pt}, "no contact", {7, kInk});
    if (has_categories()) {
      for (const auto& [actuator, count] : contacts_of_)
        if (actuator > 0) entry(actuator, name_of(actuator), count);
    }
    if (const auto unmapped = contacts_of_.find(0); unmapped != contacts_of_.end())
      entry(0, "unmapped skin", unmapped->second);
    if (!has_categories()) {
      y_pt -= 14;
      const Box bar = {kLegendPt, std::max(plot.bottom_pt, y_pt - 96), kLegendPt + 6, y_pt};
      draw_colour_bar(canvas, bar, number_ramp, 1, static_cast<double>(highest_actuator()), "Actuator");
    }
  }

  TextureContacts textures_;
  std::map<std::uint16_t, std::size_t> contacts_of_;  ///< number of contacts by actuator
};

}  // namespace

std::unique_ptr<Figure> texture_figure(TextureContacts textures) {
  return std::make_unique<TextureFigure>(std::move(textures));
}

}  // namespace vestige::plot
