#include "analysis/plot/report/map_pictures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <utility>

#include "analysis/colours/palette.hpp"
#include "analysis/colours/region_colours.hpp"
#include "analysis/plot/canvas/axis.hpp"
#include "analysis/plot/canvas/heat.hpp"
#include "analysis/plot/canvas/scale_bar.hpp"
#include "analysis/plot/data/report_words.hpp"
#include "analysis/plot/studio/contact_density.hpp"
#include "analysis/plot/studio/region_image.hpp"
#include "analysis/plot/studio/subject.hpp"
#include "traces/base/number_text.hpp"
#include "traces/scene/pose.hpp"

namespace vestige::plot {

namespace {

constexpr double kBodiesPt = 240;  ///< both sides
constexpr double kMostHeightPt = 180;
constexpr double kBarRoomPt = 54;
constexpr double kSideNamePt = 13;
constexpr double kFootPt = 14;

struct SidePicture {
  Raster raster;
  std::vector<RegionLabel> labels;
};

/// Two sides of a body, and a key where colours are numbers.
class PairFigure : public Figure {
 public:
  struct Layout {
    std::array<BodySide, 2> sides;
    double cell_width_pt = 0;
    double cell_height_pt = 0;
    double m_per_pt = 1;
    double extent_m = 1;
    std::optional<double> bar_high;
  };

  PairFigure(const Layout& layout, std::vector<SidePicture> pictures, std::string description)
      : layout_(layout), pictures_(std::move(pictures)), description_(std::move(description)) {}

  double width_pt() const override { return 2 * layout_.cell_width_pt + (layout_.bar_high ? kBarRoomPt : 0); }
  double height_pt() const override { return layout_.cell_height_pt + kSideNamePt + kFootPt; }
  std::string description() const override { return description_; }

  void draw(Canvas& canvas) const override {
    for (std::size_t i = 0; i < pictures_.size(); ++i) draw_side(canvas, i);
    if (layout_.bar_high)
      draw_heat_bar(canvas, {2 * layout_.cell_width_pt + 8, height_pt()}, std::min(110.0, layout_.cell_height_pt - 46),
                    *layout_.bar_high, layout_.extent_m);
    draw_scale_bar(canvas, {3, 7}, layout_.m_per_pt, 50);
  }

 private:
  void draw_side(Canvas& canvas, std::size_t side) const {
    const SidePicture& picture = pictures_[side];
    const double left_pt = static_cast<double>(side) * layout_.cell_width_pt;
    const Box cell = {left_pt, height_pt() - layout_.cell_height_pt, left_pt + layout_.cell_width_pt, height_pt()};
    canvas.image(cell, picture.raster);
    const double pt_per_dot = cell.width_pt() / static_cast<double>(picture.raster.width());
    // Many actuators leave little room for each number.
    const int size_pt = picture.labels.size() > 12 ? 4 : 6;
    for (const RegionLabel& label : picture.labels) {
      const Place place = {cell.left_pt + label.column * pt_per_dot, cell.top_pt - label.row * pt_per_dot};
      const double circle_pt = size_pt * (label.actuator < 10 ? 1.3 : label.actuator < 100 ? 1.55 : 1.9);
      canvas.mark(place, Mark::kCircle, circle_pt, kWhite, kInk);
      canvas.text(place, fmt::format("{}", label.actuator), {size_pt, kBlack, Anchor::kCentre});
    }
    canvas.text({(cell.left_pt + cell.right_pt) / 2, cell.bottom_pt - 6}, layout_.sides[side].name,
                {7, kInk, Anchor::kCentre});
  }

  Layout layout_;
  std::vector<SidePicture> pictures_;
  std::string description_;
};

}  // namespace

MapPictures::MapPictures(const Avatar& avatar, std::vector<RecordedContact> contacts)
    : avatar_(avatar),
      contacts_(std::move(contacts)),
      surface_(SurfacePoser(avatar).pose(rest_pose(avatar), glm::dvec3(0))),
      extent_m_(extent_of(surface_)),
      sides_(sides_of(surface_)) {
  const double width_m = std::max(shown_width_of(surface_), extent_m_ / 100) * 1.05;
  const double height_m = std::max((surface_.high - surface_.low).y, extent_m_ / 100) * 1.04;
  m_per_pt_ = std::max(width_m / whole_dots_pt(kBodiesPt / 2), height_m / kMostHeightPt);
  cell_width_pt_ = std::min(whole_dots_pt(width_m / m_per_pt_ + 5.9), whole_dots_pt(kBodiesPt / 2));
  cell_height_pt_ = whole_dots_pt(height_m / m_per_pt_ + 5.9);
  const double side_m = unit_for(extent_m_).side_m;
  bar_high_ = heat_bar_high(ContactDensity(surface_, contacts_, kHeatSigma * extent_m_).highest() * side_m * side_m);
  for (const BodySide& side : sides_)
    shots_.emplace_back(surface_, view_of_side(surface_, side, cell_width_pt_, cell_height_pt_, m_per_pt_),
                        std::nullopt);
}

MapPictures::~MapPictures() = default;

std::vector<RecordedContact> MapPictures::unfelt_contacts(const ActuatorMap& map) const {
  std::vector<RecordedContact> unfelt;
  for (const RecordedContact& contact : contacts_)
    if (actuator_at(avatar_, map, contact.triangle, contact.barycentric.x, contact.barycentric.y) == 0)
      unfelt.push_back(contact);
  return unfelt;
}

std::unique_ptr<Figure> MapPictures::regions(const ActuatorMap& map) const {
  const std::size_t count = map.actuator_count;
  std::vector<SidePicture> pictures;
  for (const StudioShot& shot : shots_) {
    const auto actuator = [&](std::uint32_t triangle, double u, double v) {
      return actuator_at(avatar_, map, triangle, u, v);
    };
    const RegionImage image(shot, actuator);
    Raster raster = shot.picture([&](std::uint32_t triangle, double u, double v) {
      return region_colour(actuator_at(avatar_, map, triangle, u, v), count);
    });
    image.outline(raster);
    pictures.push_back({std::move(raster), image.labels()});
  }
  return std::make_unique<PairFigure>(
      PairFigure::Layout{sides_, cell_width_pt_, cell_height_pt_, m_per_pt_, extent_m_, std::nullopt},
      std::move(pictures),
      fmt::format("{} on the body, {} and {}.", counted(count, "actuator region"), sides_[0].name, sides_[1].name));
}

std::unique_ptr<Figure> MapPictures::contacts(const ActuatorMap& map) const {
  return heat(map, contacts_,
              fmt::format("Density of {} on the body, {} and {}, with the outlines of the regions.",
                          counted(contacts_.size(), "contact"), sides_[0].name, sides_[1].name));
}

std::unique_ptr<Figure> MapPictures::unfelt(const ActuatorMap& map) const {
  const std::vector<RecordedContact> contacts = unfelt_contacts(map);
  return heat(map, contacts,
              fmt::format("Density of the {} that no actuator covers, {} and {}.", counted(contacts.size(), "contact"),
                          sides_[0].name, sides_[1].name));
}

std::unique_ptr<Figure> MapPictures::heat(const ActuatorMap& map, const std::vector<RecordedContact>& contacts,
                                          std::string description) const {
  const ContactDensity density(surface_, contacts, kHeatSigma * extent_m_);
  const double side_m = unit_for(extent_m_).side_m;
  const double scale = side_m * side_m / bar_high_;
  std::vector<SidePicture> pictures;
  for (const StudioShot& shot : shots_) {
    const RegionImage image(
        shot, [&](std::uint32_t triangle, double u, double v) { return actuator_at(avatar_, map, triangle, u, v); });
    Raster raster = shot.picture(
        [&](std::uint32_t triangle, double u, double v) { return heat_ramp(density.at(triangle, u, v) * scale); });
    image.outline(raster);
    pictures.push_back({std::move(raster), {}});
  }
  return std::make_unique<PairFigure>(
      PairFigure::Layout{sides_, cell_width_pt_, cell_height_pt_, m_per_pt_, extent_m_, bar_high_}, std::move(pictures),
      std::move(description));
}

}  // namespace vestige::plot
