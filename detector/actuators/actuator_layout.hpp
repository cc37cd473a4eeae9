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
#include "detector/actuators/surface_distance.hpp"
#include "detector/contact.hpp"
#include "traces/scene/avatar.hpp"

namespace vestige {

/// A contact as a layout of actuators sees it: where on the body it is, and how far from each actuator.
struct LocatedContact {
  std::uint16_t actuator = 0;  ///< by the layout's map; 0: skin that none covers
  double speed_m_per_s = 0;
  glm::dvec3 position_m = glm::dvec3(0);  ///< on the body at rest, wherever the body was in the trace
  /// Along the surface, metres, from actuator 0 on.
  std::span<const float> distance_m() const { return {distance_.data(), count_}; }

 private:
  friend class ActuatorLayout;
  std::vector<float> distance_;  // padded
  std::size_t count_ = 0;
  std::array<const float*, 3> detour_ = {};
  std::array<glm::dvec3, 2> axis_ = {};      // of the triangle's plane, length 1
  std::array<glm::dvec2, 3> gradient_ = {};  // of the corners' weights, in those axes
};

/// An actuator map on a body: where its actuators are on the skin, how much of it each covers, and how far it is along
/// the skin from any point to each. The body is the avatar at rest, as its file's nodes place it, in metres.
///
/// Actuators count from 0 here (the map's own numbers less 1). Distances are those of `SurfaceDistance` with bridges,
/// computed once for every vertex. Within a triangle the detour, distance less straight line, is interpolated, so that
/// a point next to an actuator is as near to it as it is.
class ActuatorLayout {
 public:
  ActuatorLayout(const Avatar& avatar, ActuatorMap map);

  const ActuatorMap& map() const { return map_; }
  const SurfaceDistance& surface() const { return surface_; }
  std::size_t actuator_count() const { return map_.actuator_count; }

  /// Where an actuator is: the skin's nearest point to the map's `position_m`; where the map gives none, the point of
  /// its region nearest to the region's middle (by area). None for an actuator without a region and a position, which
  /// can never fire.
  const std::optional<SkinPoint>& place(std::size_t actuator) const { return place_[actuator]; }
  /// Metres, on the body at rest. (0, 0, 0) for one without a place.
  const glm::dvec3& position_m(std::size_t actuator) const { return position_m_[actuator]; }
  /// Of the skin that fires it, square metres; and of all actuators, and of the whole skin.
  double area_m2(std::size_t actuator) const { return area_m2_[actuator]; }
  double mapped_area_m2() const;
  double skin_area_m2() const { return skin_area_m2_; }
  /// The share of the mapped skin whose texels other skin has too that is far from it (more than 50 mm, not touching):
  /// contact there fires an actuator that may be meant for the other. 0 where nothing is mapped.
  double ambiguous_share() const { return ambiguous_share_; }

  /// Along the surface between two actuators; +inf where one has no place.
  double between_m(std::size_t a, std::size_t b) const { return between_m_[a * actuator_count() + b]; }
  /// The median over actuators of the distance to the nearest other one; +inf for fewer than two.
  double spacing_m() const { return spacing_m_; }
  /// Actuators that are neighbours on the surface three by three: the dual of the cells of points that are nearest to
  /// each (Delaunay's triangles, along the surface). What lies between actuators lies in one of these.
  const std::vector<std::array<std::uint16_t, 3>>& neighbours() const { return neighbours_; }
  /// Those of them that an actuator belongs to, as indices into `neighbours`.
  std::span<const std::uint32_t> neighbours_of(std::size_t actuator) const;
  /// The actuators that share a border with an actuator's cell, ascending.
  std::span<const std::uint16_t> beside(std::size_t actuator) const;

  /// Finds a contact's actuator by the map, and where it is. `contact` must carry triangle, barycentric and texture
  /// coordinate; `located` is filled anew, its memory used again.
  void locate(const Contact& contact, LocatedContact& located) const;
  /// A point of the skin by itself, with no actuator and no speed.
  void locate(const SkinPoint& point, LocatedContact& located) const;

  /// Which way it is to an actuator, and how far: a vector of that length in the plane of the contact's triangle, in
  /// axes of its own, along which the distance shrinks fastest.
  glm::dvec2 towards_m(const LocatedContact& located, std::size_t actuator) const;

  /// Along the surface between two points of the skin: computed anew, in milliseconds.
  double distance_m(const SkinPoint& a, const SkinPoint& b) const;

 private:
  void place_actuators(const Avatar& avatar);
  void place_specks(const Avatar& avatar);
  void measure_distances();
  void find_neighbours();

  ActuatorMap map_;
  SurfaceDistance surface_;
  std::vector<std::optional<SkinPoint>> place_;
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
