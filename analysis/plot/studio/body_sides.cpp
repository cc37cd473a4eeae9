#include "analysis/plot/studio/body_sides.hpp"

#include <algorithm>
#include <glm/common.hpp>

#include "analysis/plot/studio/studio.hpp"

namespace vestige::plot {

namespace {

/// Returns the extents across (x), up (y), and from back to front (z).
glm::dvec3 size_of(const Surface& surface) {
  return glm::abs(turned_to_front(surface.high - surface.low, surface.facing));
}

bool is_long(const Surface& surface) {
  const glm::dvec3 size = size_of(surface);
  return size.z > 1.2 * size.x;
}

}  // namespace

std::array<BodySide, 2> sides_of(const Surface& surface) {
  if (is_long(surface)) return {{{"left", 90}, {"right", -90}}};
  return {{{"front", 0}, {"back", 180}}};
}

double shown_width_of(const Surface& surface) {
  const glm::dvec3 size = size_of(surface);
  return is_long(surface) ? size.z : size.x;
}

double extent_of(const Surface& surface) {
  const glm::dvec3 size = surface.high - surface.low;
  const double extent = std::max({size.x, size.y, size.z});
  return extent > 0 ? extent : 1;
}

View view_of_side(const Surface& surface, const BodySide& side, double width_pt, double height_pt, double unit_per_pt) {
  View view = view_of_cell(Camera::from(side.azimuth_degrees, 0, surface.facing), width_pt, height_pt, unit_per_pt);
  const glm::dvec3 seen = view.camera.seen((surface.low + surface.high) / 2.0);
  view.left = seen.x - static_cast<double>(view.width) / 2 * view.unit_per_dot;
  view.bottom = seen.y - static_cast<double>(view.height) / 2 * view.unit_per_dot;
  return view;
}

}  // namespace vestige::plot
