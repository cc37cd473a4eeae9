#include "analysis/plot/figures/body_figure.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "analysis/colours/palette.hpp"
#include "analysis/colours/region_colours.hpp"
#include "analysis/plot/canvas/axis.hpp"
#include "analysis/plot/canvas/heat.hpp"
#include "analysis/plot/canvas/scale_bar.hpp"
#include "analysis/plot/studio/body_sides.hpp"
#include "analysis/plot/studio/contact_density.hpp"
#include "analysis/plot/studio/region_image.hpp"
#include "analysis/plot/studio/studio.hpp"
#include "traces/base/number_text.hpp"

namespace vestige::plot {

namespace {

constexpr double kWidthPt = 510;
constexpr double kLeftPt = 3;
constexpr double kTitleRoomPt = 24;
constexpr double kRowTitlePt = 16;
constexpr double kSideNamePt = 13;
constexpr double kLegendLinePt = 11;
constexpr double kLegendWidthPt = 120;
constexpr double kFootPt = 18;
constexpr double kBarRoomPt = 66;
constexpr double kGapPt = 12;
constexpr double kMostCellHeightPt = 300;
/// Wider bodies get a row each for map and contacts.
constexpr double kSlender = 0.62;
constexpr Colour kContactColour = kBlack;

struct Picture {
  Raster raster;
  std::vector<RegionLabel> labels;
};

class BodyFigure : public Figure {
 public:
  explicit BodyFigure(Body body)
      : body_(std::move(body)),
        surface_(SurfacePoser(body_.subject.avatar).pose(rest_pose(body_.subject.avatar), glm::dvec3(0))) {
    extent_ = extent_of(surface_);
    sides_ = sides_of(surface_);
    lay_out(shown_width_of(surface_), (surface_.high - surface_.low).y);
    contacts_of_.assign(body_.subject.map.actuator_count + 1, 0);
    // By the map that is drawn, which need not be the one that the contacts were recorded with.
    for (const RecordedContact& contact : body_.contacts)
      ++contacts_of_[body_.subject.actuator_at(contact.triangle, contact.barycentric.x, contact.barycentric.y)];
    if (body_.has_contacts) {
      density_.emplace(surface_, body_.contacts, kHeatSigma * extent_);
      unit_ = unit_for(extent_);
      bar_high_ = heat_bar_high(density_->highest() * unit_.side_m * unit_.side_m);
    }
    make_pictures();
  }

  double width_pt() const override { return kWidthPt; }
  double height_pt() const override {
    return kTitleRoomPt + static_cast<double>(rows()) * row_height_pt() + legend_height_pt() + kFootPt;
  }
  std::string description() const override {
    return fmt::format("{}: {} on the avatar{}.", body_.subject.title,
                       counted(body_.subject.map.actuator_count, "actuator region"),
                       body_.has_contacts ? fmt::format(", {} and the density of contacts", contacts_in_words()) : "");
  }

  void draw(Canvas& canvas) const override {
    canvas.text({kLeftPt, height_pt() - 10}, body_.subject.title,
                {9, kInk, Anchor::kLeft, Level::kMiddle, Weight::kBold});
    const double top_pt = height_pt() - kTitleRoomPt;
    const std::string dots = body_.has_contacts ? fmt::format(", with {}", contacts_in_words()) : std::string();
    draw_group(canvas, kLeftPt, top_pt, map_title() + dots, regions_);
    if (body_.has_contacts) {
      const bool below = rows() == 2;
      const double left_pt = below ? kLeftPt : kLeftPt + 2 * cell_width_pt_ + kGapPt;
      const double heat_top_pt = below ? top_pt - row_height_pt() : top_pt;
      draw_group(canvas, left_pt, heat_top_pt, "Density of contacts", heat_);
      draw_heat_bar(canvas, {left_pt + 2 * cell_width_pt_ + 14, heat_top_pt - kRowTitlePt},
                    std::min(120.0, cell_height_pt_ - 30), bar_high_, extent_);
    }
    draw_legend(canvas, top_pt);
    draw_scale_bar(canvas, {kLeftPt, 7}, unit_per_pt_, 60);
  }

 private:
  void lay_out(double width, double height) {
    width = std::max(width, extent_ / 100) * 1.05;
    height = std::max(height, extent_ / 100) * 1.04;
    stacked_ = body_.has_contacts && width / height > kSlender;
    const double room_pt = kWidthPt - 2 * kLeftPt - (body_.has_contacts ? kBarRoomPt : 0);
    const double columns = body_.has_contacts && !stacked_ ? 4 : 2;
    const double most_width_pt = (room_pt - (columns > 2 ? kGapPt : 0)) / columns;
    unit_per_pt_ = std::max(width / whole_dots_pt(most_width_pt), height / kMostCellHeightPt);
    cell_width_pt_ = std::min(whole_dots_pt(width / unit_per_pt_ + 5.9), whole_dots_pt(most_width_pt));
    cell_height_pt_ = whole_dots_pt(height / unit_per_pt_ + 5.9);
  }

  std::size_t rows() const { return stacked_ ? 2 : 1; }
  double row_height_pt() const { return kRowTitlePt + cell_height_pt_ + kSideNamePt; }

  std::string map_title() const {
    if (body_.subject.map.actuator_count == 0) return "No actuator map";
    return "Actuator map, " + counted(body_.subject.map.actuator_count, "region");
  }
  std::string contacts_in_words() const { return grouped_count(static_cast<double>(body_.contacts.size()), "contact"); }

  void make_pictures() {
    const std::size_t count = body_.subject.map.actuator_count;
    for (const BodySide& side : sides_) {
      const StudioShot shot(surface_, view_of_side(surface_, side, cell_width_pt_, cell_height_pt_, unit_per_pt_),
                            std::nullopt);
      std::vector<StudioShot::Overlay> dots = {{shot, kWhite}, {shot, kContactColour}};
      const double width_dots = static_cast<double>(print_dots(contact_size_pt()));
      for (const RecordedContact& contact : body_.contacts) {
        const glm::dvec3 point = surface_.point(contact.triangle, contact.barycentric.x, contact.barycentric.y);
        dots[0].dot(point, width_dots * 1.7, 0.85, 0, 0.01 * extent_);
        dots[1].dot(point, width_dots, 1, 0, 0.01 * extent_);
      }
      const RegionImage regions(
          shot, [&](std::uint32_t triangle, double u, double v) { return body_.subject.actuator_at(triangle, u, v); });
      Raster raster =
          shot.picture([&](std::uint32_t triangle, double u,
                           double v) { return region_colour(body_.subject.actuator_at(triangle, u, v), count); },
                       dots);
      regions.outline(raster);
      regions_.push_back({std::move(raster), regions.labels()});
      if (!density_) continue;
      const double scale = unit_.side_m * unit_.side_m / bar_high_;
      heat_.push_back({shot.picture([&](std::uint32_t triangle, double u, double v) {
                         return heat_ramp(density_->at(triangle, u, v) * scale);
                       }),
                       {}});
    }
  }

  double contact_size_pt() const {
    const std::size_t count = body_.contacts.size();
    const double size_pt = count <= 300 ? 2 : count <= 1000 ? 1.5 : count <= 3000 ? 1.2 : 0.8;
    return size_pt * std::clamp(cell_height_pt_ / kMostCellHeightPt, 0.5, 1.0);
  }

  void draw_group(Canvas& canvas, double left_pt, double top_pt, const std::string& title,
                  const std::vector<Picture>& pictures) const {
    canvas.text({left_pt, top_pt - 5}, title, {8, kInk});
    for (std::size_t i = 0; i < pictures.size(); ++i) {
      const double cell_left_pt = left_pt + static_cast<double>(i) * cell_width_pt_;
      const double cell_top_pt = top_pt - kRowTitlePt;
      const Box cell = {cell_left_pt, cell_top_pt - cell_height_pt_, cell_left_pt + cell_width_pt_, cell_top_pt};
      canvas.image(cell, pictures[i].raster);
      const double pt_per_dot = cell.width_pt() / static_cast<double>(pictures[i].raster.width());
      for (const RegionLabel& label : pictures[i].labels) {
        const Place place = {cell.left_pt + label.column * pt_per_dot, cell.top_pt - label.row * pt_per_dot};
        canvas.mark(place, Mark::kCircle, label.actuator < 10 ? 9 : 11, kWhite, kInk);
        canvas.text(place, fmt::format("{}", label.actuator), {7, kBlack, Anchor::kCentre});
      }
      canvas.text({(cell.left_pt + cell.right_pt) / 2, cell.bottom_pt - 6}, sides_[i].name, {7, kInk, Anchor::kCentre});
    }
  }

  std::size_t legend_entries() const {
    return body_.subject.map.actuator_count == 0 ? 0 : body_.subject.map.actuator_count + 1;
  }
  /// Where the pictures and their colour bar end.
  double pictures_right_pt() const {
    const double columns = body_.has_contacts && !stacked_ ? 4 : 2;
    return kLeftPt + columns * cell_width_pt_ + (columns > 2 ? kGapPt : 0) + (body_.has_contacts ? kBarRoomPt : 10);
  }
  bool legend_is_beside() const {
    return kWidthPt - pictures_right_pt() >= kLegendWidthPt &&
           static_cast<double>(legend_entries()) * kLegendLinePt <= cell_height_pt_;
  }
  std::size_t legend_columns() const { return legend_is_beside() ? 1 : 3; }
  std::size_t legend_rows() const { return (legend_entries() + legend_columns() - 1) / legend_columns(); }
  double legend_height_pt() const {
    return legend_is_beside() ? 0 : static_cast<double>(legend_rows()) * kLegendLinePt + 4;
  }

  void draw_legend(Canvas& canvas, double pictures_top_pt) const {
    const std::size_t count = body_.subject.map.actuator_count;
    const bool beside = legend_is_beside();
    const double begin_pt = beside ? pictures_right_pt() : kLeftPt;
    const double column_pt = (kWidthPt - begin_pt) / static_cast<double>(legend_columns());
    const double top_pt = pictures_top_pt - (beside ? kRowTitlePt : static_cast<double>(rows()) * row_height_pt());
    for (std::size_t i = 0; i < legend_entries(); ++i) {
      // Column by column; unmapped skin comes last.
      const std::size_t actuator = i == count ? 0 : i + 1;
      const std::size_t column = i / legend_rows();
      const double left_pt = begin_pt + column_pt * static_cast<double>(column);
      const double y_pt = top_pt - (static_cast<double>(i % legend_rows()) + 0.5) * kLegendLinePt;
      const Box swatch = {left_pt, y_pt - 4, left_pt + 13, y_pt + 4};
      const Colour colour = region_colour(actuator, count);
      canvas.rectangle(swatch, colour);
      canvas.frame(swatch, {kInk, 0.3, Dash::kSolid});
      if (actuator > 0)
        canvas.text({(swatch.left_pt + swatch.right_pt) / 2, y_pt}, fmt::format("{}", actuator),
                    {7, ink_on(colour), Anchor::kCentre});
      const std::size_t contacts = contacts_of_[actuator];
      const std::string behind =
          !body_.has_contacts
              ? ""
              : fmt::format(": {} contact{}", grouped(static_cast<double>(contacts)), contacts == 1 ? "" : "s");
      const double room_pt = column_pt - 20 - text_width_pt(behind, {7, kInk});
      canvas.text({swatch.right_pt + 4, y_pt},
                  shortened(actuator == 0 ? "no actuator" : name_of(actuator), {7, kInk}, room_pt) + behind, {7, kInk});
    }
  }

  std::string name_of(std::size_t actuator) const {
    const ActuatorMap& map = body_.subject.map;
    const auto region = static_cast<std::uint32_t>(actuator - 1);
    if (map.firing.is_own(region)) return map.names[region];
    return fmt::format("{} → {}", map.names[region], vestige::describe(map.firing.of(region), map.names));
  }

  Body body_;
  Surface surface_;
  double extent_ = 1;
  std::array<BodySide, 2> sides_ = {};
  bool stacked_ = false;
  double cell_width_pt_ = 0;
  double cell_height_pt_ = 0;
  double unit_per_pt_ = 1;
  std::vector<std::size_t> contacts_of_;  ///< by actuator
  std::optional<ContactDensity> density_;
  AreaUnit unit_ = {"m²", 1};
  double bar_high_ = 1;  ///< in contacts per `unit_`
  std::vector<Picture> regions_;
  std::vector<Picture> heat_;
};

}  // namespace

std::unique_ptr<Figure> body_figure(Body body) {
  return std::make_unique<BodyFigure>(std::move(body));
}

}  // namespace vestige::plot
