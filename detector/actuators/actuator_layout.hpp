#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "detector/actuator_map.hpp"
#include "detector/actuators/posed_places.hpp"
#include "detector/actuators/surface_distance.hpp"
#include "detector/contact.hpp"
#include "traces/scene/avatar.hpp"

namespace vestige {

/// A contact relative to a layout of actuators: its place on the body, and its distance to each actuator.
struct LocatedContact {
  std::uint16_t actuator = 0;  ///< by the layout's map; 0 if no actuator covers the skin
  double speed_m_per_s = 0;
  double depth_m = 0;  ///< of a sphere
  /// The actuators whose places on the posed skin are within a sphere, and how deep; only for a law that asks for them.
  std::span<const CoveredPlace> covered;
  glm::dvec3 position_m = glm::dvec3(0);  ///< on the body at rest, wherever the body was in the trace
  /// Distances along the surface to the actuators, in metres, from actuator 0 on.
  std::span<const float> distance_m() const { return {distance_.data(), count_}; }

 private:
  friend class ActuatorLayout;
  std::vector<float> distance_;  // padded
  std::size_t count_ = 0;
  std::array<const float*, 3> detour_ = {};
  std::array<glm::dvec3, 2> axis_ = {};      // of the triangle's plane, length 1
  std::array<glm::dvec2, 3> gradient_ = {};  // of the corners' weights, in those axes
};

/// An actuator map on a body: the place of each actuator on the skin, the skin area that it covers, and the distance
/// along the skin from any point to it. The body is the avatar at rest, as the nodes of its file place it, in metres.
///
/// Actuators count from 0 here (the map's own numbers minus 1). Distances are those of `SurfaceDistance` with bridges,
/// computed once for every vertex. Within a triangle, the detour (distance minus straight line) is interpolated. So the
/// computed distance of a point next to an actuator is as small as the real one.
class ActuatorLayout {
 public:
  ActuatorLayout(const Avatar& avatar, ActuatorMap map);

  const ActuatorMap& map() const { return map_; }
  const SurfaceDistance& surface() const { return surface_; }
  /// Which way the body faces at rest.
  Facing facing() const { return facing_; }
  std::size_t actuator_count() const { return map_.actuator_count; }

  /// Returns the place of an actuator: the skin's nearest point to the map's `position_m`. If the map gives no
  /// position, the place is the point of the actuator's region nearest to the region's middle (by area). Returns
  /// nothing for an actuator with neither a region nor a position; such an actuator can never fire.
  const std::optional<SkinPoint>& place(std::size_t actuator) const { return place_[actuator]; }
  /// The places, to be moved with the skin.
  const PosedPlaces& posed_places() const { return posed_places_; }
  /// The place in metres, on the body at rest; (0, 0, 0) for an actuator without a place.
  const glm::dvec3& position_m(std::size_t actuator) const { return position_m_[actuator]; }
  /// Area of the skin that fires one actuator, that fires any actuator, and of the whole skin, in square metres.
  double area_m2(std::size_t actuator) const { return area_m2_[actuator]; }
  double mapped_area_m2() const;
  double skin_area_m2() const { return skin_area_m2_; }
  /// The share of the mapped skin whose texels belong also to other skin that is more than 50 mm away. A contact there
  /// fires an actuator that may be meant for the other skin. 0 if nothing is mapped.
  double ambiguous_share() const { return ambiguous_share_; }

  /// Distance along the surface between two actuators; +inf if one has no place.
  double between_m(std::size_t a, std::size_t b) const { return between_m_[a * actuator_count() + b]; }
  /// The median, over all actuators, of the distance to the nearest other actuator; +inf for fewer than two.
  double spacing_m() const { return spacing_m_; }
  /// Triples of actuators that are neighbours on the surface. A cell is the set of points nearest to one actuator; the
  /// triples are the dual of the cells (Delaunay's triangles, along the surface). A point between actuators lies in one
  /// of these triangles.
  const std::vector<std::array<std::uint16_t, 3>>& neighbours() const { return neighbours_; }
  /// The triples that an actuator belongs to, as indices into `neighbours`.
  std::span<const std::uint32_t> neighbours_of(std::size_t actuator) const;
  /// The actuators whose cells share a border with an actuator's cell, ascending.
  std::span<const std::uint16_t> beside(std::size_t actuator) const;

  /// Finds a contact's actuator by the map, and the contact's place. `contact` must carry triangle, barycentric and
  /// texture coordinate. The function replaces `located` and reuses its memory.
  void locate(const Contact& contact, LocatedContact& located) const;
  /// Locates a point of the skin, with no actuator and no speed.
  void locate(const SkinPoint& point, LocatedContact& located) const;

  /// Returns the direction and the distance to an actuator: a vector of that length, in two axes of the plane of the
  /// contact's triangle. The distance shrinks fastest along the vector.
  glm::dvec2 towards_m(const LocatedContact& located, std::size_t actuator) const;

  /// Returns the distance along the surface between two points of the skin. Each call computes it anew, in
  /// milliseconds.
  double distance_m(const SkinPoint& a, const SkinPoint& b) const;

 private:
  void place_actuators(const Avatar& avatar);
  void place_specks(const Avatar& avatar);
  void measure_distances();
  void find_neighbours();

  ActuatorMap map_;
  Facing facing_;
  SurfaceDistance surface_;
  std::vector<std::optional<SkinPoint>> place_;
  PosedPlaces posed_places_;
  std::vector<glm::dvec3> position_m_;
  std::vector<double> area_m2_;
  double skin_area_m2_ = 0;
  double ambiguous_share_ = 0;
  std::size_t stride_ = 0;                  // actuators, padded
  std::array<std::vector<float>, 3> axes_;  // x, y and z of the positions, padded
  std::vector<float> detour_;               // vertices x stride
  std::vector<double> between_m_;
  double spacing_m_ = std::numeric_limits<double>::infinity();
  std::vector<std::array<std::uint16_t, 3>> neighbours_;
  std::vector<std::uint32_t> first_neighbours_;
  std::vector<std::uint32_t> neighbour_list_;
  std::vector<std::uint32_t> first_beside_;
  std::vector<std::uint16_t> beside_list_;
};

}  // namespace vestige
