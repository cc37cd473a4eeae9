#include "analysis/plot/scene/moment_picture.hpp"

#include <algorithm>

#include "analysis/colours/palette.hpp"
#include "analysis/colours/region_colours.hpp"
#include "analysis/plot/studio/region_image.hpp"
#include "analysis/plot/studio/studio.hpp"
#include "traces/scene/radius.hpp"

namespace vestige::plot {

namespace {

using Overlay = StudioShot::Overlay;

constexpr Colour kSkin = {206, 203, 199};
constexpr std::size_t kManyColliders = 200;
constexpr double kHidden = 0.18;  ///< opacity behind the body, of that in front
constexpr Colour kSphereColour = {40, 70, 110};
constexpr double kSphere = 0.85;  ///< opacity of a sphere's rim

/// The layers over the skin, lowest first, and what is drawn into them.
class Layers {
 public:
  Layers(const StudioShot& shot, const SceneSight& sight, const MomentStyle& style, const glm::dvec3& origin_m)
      : sight_(sight), style_(style), origin_m_(origin_m), colours_(style.path_colours.size()) {
    overlays_.reserve(2 * colours_ + 3);
    overlays_.emplace_back(shot, kSphereColour);
    for (const Colour& colour : style.path_colours) overlays_.emplace_back(shot, colour);
    overlays_.emplace_back(shot, kInk);
    overlays_.emplace_back(shot, kWhite);
    for (const Colour& colour : style.contact_colours) overlays_.emplace_back(shot, colour);
  }

  const std::vector<Overlay>& all() const { return overlays_; }

  void add_sphere(const Path& path) {
    if (path.is_current && is_sphere_radius(path.radius_m))
      overlays_.front().sphere(path.stops.back().position_m - origin_m_, double{path.radius_m}, kSphere, kHidden);
  }

  void add_path(const Path& path, bool many) {
    Overlay& paths = overlays_[1 + colour_of(path.collider)];
    Overlay& segments = overlays_[1 + colours_];
    const double width = dots_of(many ? 0.5 : 0.9);
    const double tolerance = 0.002 * sight_.extent_m;
    const auto opacity = [&](double age_s) { return 0.75 * std::clamp(1 - age_s / style_.trail_s, 0.06, 1.0); };
    for (std::size_t i = 1; i < path.stops.size(); ++i) {
      const Path::Stop& from = path.stops[i - 1];
      const Path::Stop& to = path.stops[i];
      paths.line({from.position_m - origin_m_, opacity(from.age_s)}, {to.position_m - origin_m_, opacity(to.age_s)},
                 width, kHidden, tolerance);
    }
    if (!path.is_current) return;
    const glm::dvec3 head = path.stops.back().position_m - origin_m_;
    if (!is_sphere_radius(path.radius_m)) segments.dot(head, dots_of(many ? 1.2 : 2.2), 1, kHidden, tolerance);
    if (path.stops.size() < 2) return;
    const glm::dvec3 tail = path.stops[path.stops.size() - 2].position_m - origin_m_;
    segments.line({tail, 1}, {head, 1}, dots_of(many ? 0.8 : 1.4), kHidden, tolerance);
  }

  void add_contact(const glm::dvec3& at, std::uint32_t collider, double age_s) {
    const double dot = dots_of(kContactPt);
    const double tolerance = 0.01 * sight_.extent_m;
    Overlay& rings = overlays_[2 + colours_];
    Overlay& contacts = overlays_[3 + colours_ + colour_of(collider)];
    if (style_.marks == ContactMarks::kAlike) {
      rings.dot(at, 1.5 * dot, 1, 0, tolerance);
      contacts.dot(at, dot, 1, 0.35, tolerance);
      return;
    }
    const double opacity = std::clamp(1 - age_s / style_.fade_s, 0.0, 1.0);
    rings.line({at, opacity}, {at, opacity}, 1.5 * dot, 0, tolerance);
    contacts.line({at, opacity}, {at, opacity}, dot, 0.35, tolerance);
  }

 private:
  double dots_of(double length_pt) const { return length_pt * style_.dots_per_pt; }

  /// The same collider has the same colour at every moment.
  std::size_t colour_of(std::uint32_t collider) const {
    const auto place = std::ranges::lower_bound(style_.colliders, collider) - style_.colliders.begin();
    return static_cast<std::size_t>(place) % colours_;
  }

  const SceneSight& sight_;
  const MomentStyle& style_;
  glm::dvec3 origin_m_;
  std::size_t colours_;
  std::vector<Overlay> overlays_;  ///< spheres, paths by colour, segments, rings, contacts by colour
};

}  // namespace

Colour region_skin(const Subject& subject, std::uint16_t actuator) {
  return actuator == 0 ? kSkin : blend(region_colour(actuator, subject.map.actuator_count), kSkin, 0.6);
}

Raster moment_picture(const Moment& moment, const Crowd& crowd, const SceneSight& sight, const View& view,
                      const MomentStyle& style, const Skin& skin) {
  const StudioShot shot(crowd.surface, view, sight.ground_y_m);
  Layers layers(shot, sight, style, crowd.origin_m);
  const bool many = moment.paths.size() > kManyColliders;
  for (const Path& path : moment.paths) {
    layers.add_sphere(path);
    layers.add_path(path, many);
  }
  for (const RecordedContact& contact : moment.contacts) {
    const std::size_t person = contact.avatar - 1U;
    const std::uint32_t triangle = crowd.first_triangle[person] + contact.triangle;
    if (triangle >= crowd.first_triangle[person + 1]) continue;  // of a person whose pose is missing
    layers.add_contact(crowd.surface.point(triangle, contact.barycentric.x, contact.barycentric.y), contact.collider,
                       moment.time_s - contact.time_s);
  }
  const auto actuator_at = [&](std::size_t person, std::uint32_t triangle, double u, double v) {
    return skin.people[person].actuator_at(triangle - crowd.first_triangle[person], u, v);
  };
  const Paint paint = [&](std::uint32_t triangle, double u, double v) {
    const std::size_t person = crowd.person_of(triangle);
    return skin.colour_of(person, actuator_at(person, triangle, u, v));
  };
  Raster picture = shot.picture(paint, layers.all());
  if (style.borders == Borders::kRegions)
    RegionImage(shot, [&](std::uint32_t triangle, double u, double v) {
      return actuator_at(crowd.person_of(triangle), triangle, u, v);
    }).outline(picture);
  return picture;
}

}  // namespace vestige::plot
