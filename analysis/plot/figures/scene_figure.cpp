#include "analysis/plot/figures/scene_figure.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "analysis/colours/palette.hpp"
#include "analysis/colours/region_colours.hpp"
#include "analysis/plot/canvas/axis.hpp"
#include "analysis/plot/canvas/scale_bar.hpp"
#include "analysis/plot/studio/studio.hpp"
#include "traces/scene/radius.hpp"

namespace vestige::plot {

namespace {

constexpr double kWidthPt = 510;
constexpr double kLeftPt = 3;
constexpr double kTitleRoomPt = 22;
constexpr double kCaptionPt = 16;
constexpr double kFootPt = 20;
constexpr std::size_t kMostColumns = 4;
constexpr double kMostCellHeightPt = 300;
constexpr double kAzimuthDegrees = 35;
/// Most people reach out with their right hand: from that side it hides nothing.
constexpr double kAzimuthOfSeveralDegrees = -70;
constexpr double kElevationDegrees = 14;
/// Room for colliders around the body, in heights of it.
constexpr double kRoom = 0.13;
constexpr std::size_t kManyColliders = 200;

constexpr Colour kSkin = {206, 203, 199};
constexpr Colour kPathColour = kBlue;
constexpr Colour kContactColour = kVermillion;
constexpr double kHidden = 0.18;
constexpr Colour kSphereColour = {40, 70, 110};
constexpr double kSphere = 0.85;  ///< opacity of a sphere's rim
constexpr double kContactPt = 3.2;

/// Where the avatar stands in the world.
glm::dvec3 standing_at(const Avatar& avatar, const Pose& pose) {
  std::vector<glm::dmat4> world;
  world_matrices(avatar, pose, world);
  const glm::dvec3 root(world[static_cast<std::size_t>(avatar.root_node)][3]);
  const glm::dvec3 at = pose.origin_m + root;
  return std::isfinite(at.x + at.y + at.z) ? at : pose.origin_m;
}

std::string in_words(std::size_t count, std::string_view what) {
  return fmt::format("{} {}{}", grouped(static_cast<double>(count)), what, count == 1 ? "" : "s");
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

/// All people at a moment.
struct Crowd {
  Surface surface;
  std::vector<std::uint32_t> first_triangle;  ///< of each person, and behind them the number of triangles

  /// Which person a triangle of the surface belongs to.
  std::size_t person_of(std::uint32_t triangle) const {
    return static_cast<std::size_t>(std::ranges::upper_bound(first_triangle, triangle) - first_triangle.begin()) - 1;
  }
};

/// Poses people. Those whose pose is missing are left out.
class CrowdPoser {
 public:
  explicit CrowdPoser(const std::vector<Subject>& subjects) {
    for (const Subject& subject : subjects) posers_.emplace_back(subject.avatar);
  }

  Crowd pose(const std::vector<Pose>& poses, const glm::dvec3& origin_m) const {
    Crowd crowd;
    for (std::size_t i = 0; i < posers_.size(); ++i) {
      crowd.first_triangle.push_back(static_cast<std::uint32_t>(crowd.surface.triangles.size()));
      if (poses[i].nodes.empty()) continue;
      Surface surface = posers_[i].pose(poses[i], origin_m);
      if (crowd.surface.triangles.empty())
        crowd.surface = std::move(surface);
      else
        crowd.surface.append(surface);
    }
    crowd.first_triangle.push_back(static_cast<std::uint32_t>(crowd.surface.triangles.size()));
    return crowd;
  }

 private:
  std::vector<SurfacePoser> posers_;
};

/// Where the first person stands in the world whose pose is not missing.
glm::dvec3 standing_at(const Scene& scene) {
  for (const Moment& moment : scene.moments)
    for (std::size_t i = 0; i < scene.subjects.size(); ++i)
      if (!moment.poses[i].nodes.empty()) return standing_at(scene.subjects[i].avatar, moment.poses[i]);
  return glm::dvec3(0);
}

struct Panel {
  Raster raster;
  double time_s = 0;
  std::size_t contacts = 0;
};

class SceneFigure : public Figure {
 public:
  explicit SceneFigure(const Scene& scene)
      : title_(title_of(scene)),
        trail_s_(scene.trail_s),
        has_contacts_(scene.has_contacts),
        colliders_(colliders_in(scene.moments)) {
    if (scene.colour_by == ColourBy::kCollider) {
      path_colours_.assign(kLineColours.begin(), kLineColours.end());
      contact_colours_ = path_colours_;
      title_ += colliders_.size() <= path_colours_.size() ? std::string(", a colour for each")
                                                          : fmt::format(", {} colours in turn", path_colours_.size());
    }
    // Far from the world's origin floats are coarse: everything is drawn relative to where the avatar first stands.
    const glm::dvec3 origin_m = standing_at(scene);
    const CrowdPoser poser(scene.subjects);
    std::vector<Crowd> crowds;
    crowds.reserve(scene.moments.size());
    for (const Moment& moment : scene.moments) crowds.push_back(poser.pose(moment.poses, origin_m));
    lay_out(crowds, scene.subjects.size() > 1 ? kAzimuthOfSeveralDegrees : kAzimuthDegrees);
    for (std::size_t i = 0; i < crowds.size(); ++i)
      panels_.push_back(make_panel(scene, scene.moments[i], crowds[i], origin_m));
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
    camera_ = Camera::from(azimuth_deg, kElevationDegrees, crowds.front().surface.facing);
    glm::dvec3 low = crowds.front().surface.low;
    glm::dvec3 high = crowds.front().surface.high;
    glm::dvec3 largest(0);
    for (const auto& [surface, first_triangle] : crowds) {
      low = glm::min(low, surface.low);
      high = glm::max(high, surface.high);
      largest = glm::max(largest, surface.high - surface.low);
    }
    ground_y_ = low.y;
    extent_ = std::max({largest.x, largest.y, largest.z});
    if (!(extent_ > 0)) extent_ = 1;
    // An avatar that covers much ground is followed; one that stays is seen to move.
    const glm::dvec3 all = high - low;
    follows_ = std::max(all.x, all.z) > 1.5 * std::max(largest.x, largest.z) + 0.5 * extent_;
    middle_ = (low + high) / 2.0;
    seen_low_ = glm::dvec3(std::numeric_limits<double>::max());
    glm::dvec3 seen_high = -seen_low_;
    for (const auto& [surface, first_triangle] : crowds) {
      for (const glm::uvec3& triangle : surface.triangles) {
        for (int corner = 0; corner < 3; ++corner) {
          const glm::dvec3 point(surface.position[triangle[corner]]);
          const glm::dvec3 seen = camera_.seen(point - middle_of(surface));
          if (!std::isfinite(seen.x + seen.y)) continue;
          seen_low_ = glm::min(seen_low_, seen);
          seen_high = glm::max(seen_high, seen);
        }
      }
    }
    seen_low_ -= glm::dvec3(kRoom * extent_);
    seen_high += glm::dvec3(kRoom * extent_);
    const double width = std::max(seen_high.x - seen_low_.x, 2 * kRoom * extent_);
    seen_width_ = width;
    const double height = std::max(seen_high.y - seen_low_.y, 2 * kRoom * extent_);
    const std::size_t count = crowds.size();
    rows_ = (count + kMostColumns - 1) / kMostColumns;
    columns_ = (count + rows_ - 1) / rows_;
    cell_width_pt_ = whole_dots_pt((kWidthPt - 2 * kLeftPt) / static_cast<double>(std::max<std::size_t>(columns_, 3)));
    unit_per_pt_ = std::max(width / cell_width_pt_, height / kMostCellHeightPt);
    cell_height_pt_ = whole_dots_pt(height / unit_per_pt_ + 5.9);
  }

  /// What stays in place in the picture.
  glm::dvec3 middle_of(const Surface& surface) const {
    if (!follows_) return middle_;
    const glm::dvec3 own = (surface.low + surface.high) / 2.0;
    return {own.x, middle_.y, own.z};
  }

  Panel make_panel(const Scene& scene, const Moment& moment, const Crowd& crowd, const glm::dvec3& origin_m) const {
    const Surface& surface = crowd.surface;
    View view = view_of_cell(camera_, cell_width_pt_, cell_height_pt_, unit_per_pt_);
    const glm::dvec3 seen = camera_.seen(middle_of(surface)) + seen_low_;
    view.left = seen.x - (static_cast<double>(view.width) * view.unit_per_dot - seen_width_) / 2;
    view.bottom = seen.y;
    const StudioShot shot(surface, view, ground_y_);

    std::vector<StudioShot::Overlay> overlays;  // spheres, paths by colour, segments, rings, contacts by colour
    const std::size_t colours = path_colours_.size();
    overlays.reserve(2 * colours + 3);
    StudioShot::Overlay& spheres = overlays.emplace_back(shot, kSphereColour);
    for (const Path& path : moment.paths)
      if (path.is_current && is_sphere_radius(path.radius_m))
        spheres.sphere(path.stops.back().position_m - origin_m, double{path.radius_m}, kSphere, kHidden);
    for (const Colour& colour : path_colours_) overlays.emplace_back(shot, colour);
    StudioShot::Overlay& segments = overlays.emplace_back(shot, kInk);
    StudioShot::Overlay& rings = overlays.emplace_back(shot, kWhite);
    for (const Colour& colour : contact_colours_) overlays.emplace_back(shot, colour);
    const bool many = moment.paths.size() > kManyColliders;
    for (const Path& path : moment.paths)
      draw_path(path, origin_m, many, overlays[1 + colour_of(path.collider)], segments);
    const double dot = dots_of(kContactPt);
    for (const RecordedContact& contact : moment.contacts) {
      const std::size_t person = contact.avatar - 1U;
      const std::uint32_t triangle = crowd.first_triangle[person] + contact.triangle;
      if (triangle >= crowd.first_triangle[person + 1]) continue;  // of a person whose pose is missing
      const glm::dvec3 at = surface.point(triangle, contact.barycentric.x, contact.barycentric.y);
      rings.dot(at, 1.5 * dot, 1, 0, 0.01 * extent_);
      overlays[colours + 3 + colour_of(contact.collider)].dot(at, dot, 1, 0.35, 0.01 * extent_);
    }
    const Paint paint = [&](std::uint32_t triangle, double u, double v) {
      const std::size_t person = crowd.person_of(triangle);
      const Subject& subject = scene.subjects[person];
      const std::uint16_t actuator = subject.actuator_at(triangle - crowd.first_triangle[person], u, v);
      return actuator == 0 ? kSkin : blend(region_colour(actuator, subject.map.actuator_count), kSkin, 0.6);
    };
    return {shot.picture(paint, overlays), moment.time_s, moment.contacts.size()};
  }

  /// Which of the colours a collider has. The same collider has the same one at every moment.
  std::size_t colour_of(std::uint32_t collider) const {
    const auto place = std::ranges::lower_bound(colliders_, collider) - colliders_.begin();
    return static_cast<std::size_t>(place) % path_colours_.size();
  }

  static double dots_of(double length_pt) { return length_pt * kPrintDotsPerInch / 72; }

  void draw_path(const Path& path, const glm::dvec3& origin_m, bool many, StudioShot::Overlay& paths,
                 StudioShot::Overlay& segments) const {
    const double width = dots_of(many ? 0.5 : 0.9);
    const double tolerance = 0.002 * extent_;
    const auto opacity = [&](double age_s) { return 0.75 * std::clamp(1 - age_s / trail_s_, 0.06, 1.0); };
    for (std::size_t i = 1; i < path.stops.size(); ++i) {
      const Path::Stop& from = path.stops[i - 1];
      const Path::Stop& to = path.stops[i];
      paths.line({from.position_m - origin_m, opacity(from.age_s)}, {to.position_m - origin_m, opacity(to.age_s)},
                 width, kHidden, tolerance);
    }
    if (!path.is_current) return;
    const glm::dvec3 head = path.stops.back().position_m - origin_m;
    if (!is_sphere_radius(path.radius_m)) segments.dot(head, dots_of(many ? 1.2 : 2.2), 1, kHidden, tolerance);
    if (path.stops.size() < 2) return;
    const glm::dvec3 tail = path.stops[path.stops.size() - 2].position_m - origin_m;
    segments.line({tail, 1}, {head, 1}, dots_of(many ? 0.8 : 1.4), kHidden, tolerance);
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
    const std::size_t shown = std::min<std::size_t>(path_colours_.size(), 3);
    for (std::size_t k = 0; k < shown; ++k)
      for (int i = 0; i < 8; ++i)
        canvas.line({left_pt + i * 2.5, y_pt + height_in_key_pt(k, shown)},
                    {left_pt + (i + 1) * 2.5, y_pt + height_in_key_pt(k, shown)},
                    {blend(kWhite, path_colours_[k], 0.75 * (i + 1) / 8.0), 0.9, Dash::kSolid});
    left_pt += 24;
    say(fmt::format("path of {:g} ms", trail_s_ * 1000));
    canvas.line({left_pt, y_pt}, {left_pt + 5, y_pt}, {kInk, 1.4, Dash::kSolid});
    canvas.mark({left_pt + 5, y_pt}, Mark::kCircle, 2.2, kInk, kInk);
    left_pt += 10;
    say("collider, segment of this frame");
    if (has_contacts_) {
      canvas.mark({left_pt + 2, y_pt}, Mark::kCircle, kContactPt, contact_colours_[0], contact_colours_[0]);
      left_pt += 8;
      say(fmt::format("contact in these {:g} ms", trail_s_ * 1000));
    }
    say("pale: behind skin");
    if (follows_) say("the view follows");
  }

  std::string title_;
  double trail_s_;
  bool has_contacts_;
  std::vector<std::uint32_t> colliders_;  ///< ascending
  std::vector<Colour> path_colours_ = {kPathColour};
  std::vector<Colour> contact_colours_ = {kContactColour};  ///< as many
  Camera camera_;
  double ground_y_ = 0;
  double extent_ = 1;
  bool follows_ = false;
  glm::dvec3 middle_ = glm::dvec3(0);
  glm::dvec3 seen_low_ = glm::dvec3(0);  ///< the picture's lower left corner, from what stays in place
  double seen_width_ = 0;
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
