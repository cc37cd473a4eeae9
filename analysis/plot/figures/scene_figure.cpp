#include "analysis/plot/figures/scene_figure.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "analysis/colours/palette.hpp"
#include "analysis/plot/canvas/axis.hpp"
#include "analysis/plot/canvas/scale_bar.hpp"
#include "analysis/plot/scene/crowd.hpp"
#include "analysis/plot/scene/moment_picture.hpp"
#include "analysis/plot/scene/scene_sight.hpp"

namespace vestige::plot {

namespace {

constexpr double kWidthPt = 510;
constexpr double kLeftPt = 3;
constexpr double kTitleRoomPt = 22;
constexpr double kCaptionPt = 16;
constexpr double kFootPt = 20;
constexpr std::size_t kMostColumns = 4;
constexpr double kMostCellHeightPt = 300;
constexpr Colour kPathColour = kBlue;
constexpr Colour kContactColour = kVermillion;

std::string in_words(std::size_t count, std::string_view what) {
  return grouped_count(static_cast<double>(count), what);
}

/// All colliders of the moments, ascending.
std::vector<std::uint32_t> colliders_in(const std::vector<Moment>& moments) {
  std::vector<std::uint32_t> ids;
  for (const Moment& moment : moments) {
    for (const Path& path : moment.paths) ids.push_back(path.collider);
    for (const RecordedContact& contact : moment.contacts) ids.push_back(contact.collider);
  }
  std::ranges::sort(ids);
  ids.erase(std::unique(ids.begin(), ids.end()), ids.end());
  return ids;
}

struct Panel {
  Raster raster;
  double time_s = 0;
  std::size_t contacts = 0;
};

class SceneFigure : public Figure {
 public:
  explicit SceneFigure(const Scene& scene) : title_(title_of(scene)), has_contacts_(scene.has_contacts) {
    style_.trail_s = scene.trail_s;
    style_.colliders = colliders_in(scene.moments);
    if (scene.colour_by == ColourBy::kCollider) {
      const std::size_t colours = kLineColours.size();
      style_.path_colours.assign(kLineColours.begin(), kLineColours.end());
      title_ += style_.colliders.size() <= colours ? std::string(", a colour for each")
                                                   : fmt::format(", {} colours in turn", colours);
      style_.contact_colours = style_.path_colours;
    } else {
      style_.path_colours = {kPathColour};
      style_.contact_colours = {kContactColour};
    }
    const glm::dvec3 origin_m = standing_at(scene.subjects, scene.moments.front().poses);
    const CrowdPoser poser(scene.subjects);
    std::vector<Crowd> crowds;
    crowds.reserve(scene.moments.size());
    for (const Moment& moment : scene.moments) crowds.push_back(poser.pose(moment.poses, origin_m));
    lay_out(crowds, scene.subjects.size() > 1 ? kAzimuthOfSeveralDegrees : kAzimuthDegrees);
    for (std::size_t i = 0; i < crowds.size(); ++i) panels_.push_back(make_panel(scene, scene.moments[i], crowds[i]));
  }

  double width_pt() const override { return kWidthPt; }
  double height_pt() const override {
    return kTitleRoomPt + static_cast<double>(rows_) * (cell_height_pt_ + kCaptionPt) + kFootPt;
  }
  std::string description() const override {
    return fmt::format("{} at {} moments from {:.3f} s to {:.3f} s.", title_, panels_.size(), panels_.front().time_s,
                       panels_.back().time_s);
  }

  void draw(Canvas& canvas) const override {
    canvas.text({kLeftPt, height_pt() - 9}, title_, {9, kInk, Anchor::kLeft, Level::kMiddle, Weight::kBold});
    for (std::size_t i = 0; i < panels_.size(); ++i) {
      const std::size_t row = i / columns_;
      const double left_pt = kLeftPt + static_cast<double>(i % columns_) * cell_width_pt_;
      const double top_pt = height_pt() - kTitleRoomPt - static_cast<double>(row) * (cell_height_pt_ + kCaptionPt);
      const Box cell = {left_pt, top_pt - cell_height_pt_, left_pt + cell_width_pt_, top_pt};
      canvas.image(cell, panels_[i].raster);
      canvas.frame(cell, {{190, 190, 190}, 0.4, Dash::kSolid});
      const double caption_pt = cell.bottom_pt - 7;
      canvas.text({cell.left_pt + 3, caption_pt}, fmt::format("{:.3f} s", panels_[i].time_s), {7, kInk});
      if (has_contacts_)
        canvas.text({cell.right_pt - 3, caption_pt}, in_words(panels_[i].contacts, "contact"),
                    {7, kInk, Anchor::kRight});
    }
    draw_key(canvas);
  }

 private:
  /// "man.mcap: 40 colliders", and of several people how many they are.
  static std::string title_of(const Scene& scene) {
    std::string title = scene.subjects.front().title + ": ";
    if (scene.subjects.size() > 1) title += fmt::format("{} people, ", scene.subjects.size());
    return title + in_words(most_colliders(scene), "collider");
  }

  static std::size_t most_colliders(const Scene& scene) {
    std::size_t most = 0;
    for (const Moment& moment : scene.moments)
      most = std::max(most, static_cast<std::size_t>(std::ranges::count(moment.paths, true, &Path::is_current)));
    return most;
  }

  void lay_out(const std::vector<Crowd>& crowds, double azimuth_deg) {
    SightFinder finder(Camera::from(azimuth_deg, kElevationDegrees, crowds.front().surface.facing));
    for (const Crowd& crowd : crowds) finder.add(crowd.surface);
    sight_ = finder.sight();
    const std::size_t count = crowds.size();
    rows_ = (count + kMostColumns - 1) / kMostColumns;
    columns_ = (count + rows_ - 1) / rows_;
    cell_width_pt_ = whole_dots_pt((kWidthPt - 2 * kLeftPt) / static_cast<double>(std::max<std::size_t>(columns_, 3)));
    unit_per_pt_ = std::max(sight_.size_m.x / cell_width_pt_, sight_.size_m.y / kMostCellHeightPt);
    cell_height_pt_ = whole_dots_pt(sight_.size_m.y / unit_per_pt_ + 5.9);
  }

  Panel make_panel(const Scene& scene, const Moment& moment, const Crowd& crowd) const {
    const std::size_t width = print_dots(cell_width_pt_);
    const View view = sight_.view_of(crowd.surface, width, print_dots(cell_height_pt_),
                                     unit_per_pt_ * cell_width_pt_ / static_cast<double>(width));
    const Skin skin = {scene.subjects, [&](std::size_t person, std::uint16_t actuator) {
                         return region_skin(scene.subjects[person], actuator);
                       }};
    return {moment_picture(moment, crowd, sight_, view, style_, skin), moment.time_s, moment.contacts.size()};
  }

  /// Where the k-th of the lines lies that stand for paths in the key.
  static double height_in_key_pt(std::size_t k, std::size_t lines) {
    return 2.2 * (static_cast<double>(lines - 1) / 2 - static_cast<double>(k));
  }

  void draw_key(Canvas& canvas) const {
    const double y_pt = 7;
    draw_scale_bar(canvas, {kLeftPt + 2, y_pt}, unit_per_pt_, 60);
    double left_pt = kLeftPt + 96;
    const auto say = [&](const std::string& words) {
      canvas.text({left_pt, y_pt}, words, {7, kInk});
      left_pt += text_width_pt(words, {7, kInk}) + 12;
    };
    const std::size_t shown = std::min<std::size_t>(style_.path_colours.size(), 3);
    for (std::size_t k = 0; k < shown; ++k)
      for (int i = 0; i < 8; ++i)
        canvas.line({left_pt + i * 2.5, y_pt + height_in_key_pt(k, shown)},
                    {left_pt + (i + 1) * 2.5, y_pt + height_in_key_pt(k, shown)},
                    {blend(kWhite, style_.path_colours[k], 0.75 * (i + 1) / 8.0), 0.9, Dash::kSolid});
    left_pt += 24;
    say(fmt::format("path of {:g} ms", style_.trail_s * 1000));
    canvas.line({left_pt, y_pt}, {left_pt + 5, y_pt}, {kInk, 1.4, Dash::kSolid});
    canvas.mark({left_pt + 5, y_pt}, Mark::kCircle, 2.2, kInk, kInk);
    left_pt += 10;
    say("collider, segment of this frame");
    if (has_contacts_) {
      canvas.mark({left_pt + 2, y_pt}, Mark::kCircle, kContactPt, style_.contact_colours[0], style_.contact_colours[0]);
      left_pt += 8;
      say(fmt::format("contact in these {:g} ms", style_.trail_s * 1000));
    }
    say("pale: behind skin");
    if (sight_.follows) say("the view follows");
  }

  std::string title_;
  bool has_contacts_;
  MomentStyle style_;
  SceneSight sight_;
  std::size_t rows_ = 1;
  std::size_t columns_ = 1;
  double cell_width_pt_ = 0;
  double cell_height_pt_ = 0;
  double unit_per_pt_ = 1;
  std::vector<Panel> panels_;
};

}  // namespace

std::unique_ptr<Figure> scene_figure(const Scene& scene) {
  return std::make_unique<SceneFigure>(scene);
}

}  // namespace vestige::plot
