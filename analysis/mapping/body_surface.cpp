#include "analysis/mapping/body_surface.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <map>
#include <tuple>

#include "detector/actuators/texture_stretch.hpp"
#include "traces/base/error.hpp"
#include "traces/scene/reference_skinning.hpp"

namespace vestige {

BodySurface::BodySurface(const Avatar& avatar) : avatar_(avatar) {
  const Pose rest = rest_pose(avatar);
  skin_reference(avatar, rest, rest.origin_m, rest_m_);
  std::map<std::tuple<double, double, double>, std::uint32_t> places;
  for (const glm::dvec3& p : rest_m_) {
    const auto next = static_cast<std::uint32_t>(places.size());
    place_.push_back(places.try_emplace({p.x, p.y, p.z}, next).first->second);
  }
  place_count_ = places.size();
  bounds_ = {rest_m_[avatar.triangles.front().x], rest_m_[avatar.triangles.front().x]};
  for (std::uint32_t i = 0; i < avatar.triangles.size(); ++i)
    for (const glm::dvec3& corner : corners_m(i))
      bounds_ = {glm::min(bounds_.low, corner), glm::max(bounds_.high, corner)};
}

std::array<glm::dvec3, 3> BodySurface::corners_m(std::uint32_t triangle) const {
  const glm::uvec3& corner = avatar_.triangles[triangle];
  return {rest_m_[corner.x], rest_m_[corner.y], rest_m_[corner.z]};
}

glm::dvec3 BodySurface::position_m(const SkinPoint& point) const {
  const auto [a, b, c] = corners_m(point.triangle);
  return point.weight.x * a + point.weight.y * b + point.weight.z * c;
}

glm::dvec2 BodySurface::texture_coordinate(const SkinPoint& point) const {
  // The sums have the same order as in describe_contact, so that a point and a contact there have the same texel.
  const glm::uvec3& corner = avatar_.triangles[point.triangle];
  const glm::dvec2 a(avatar_.texture_coordinate[corner.x]);
  const glm::dvec2 b(avatar_.texture_coordinate[corner.y]);
  const glm::dvec2 c(avatar_.texture_coordinate[corner.z]);
  return a + point.weight.y * (b - a) + point.weight.z * (c - a);
}

std::array<glm::dvec2, 3> BodySurface::texels(std::uint32_t triangle, const glm::dvec2& map_size) const {
  const glm::uvec3& corner = avatar_.triangles[triangle];
  const auto texel_of = [&](std::uint32_t vertex) { return glm::dvec2(avatar_.texture_coordinate[vertex]) * map_size; };
  return {texel_of(corner.x), texel_of(corner.y), texel_of(corner.z)};
}

double BodySurface::area_m2(std::uint32_t triangle) const {
  const auto [a, b, c] = corners_m(triangle);
  return glm::length(glm::cross(b - a, c - a)) / 2;
}

double BodySurface::longest_edge_m(std::uint32_t triangle) const {
  const auto [a, b, c] = corners_m(triangle);
  return std::max({glm::distance(a, b), glm::distance(b, c), glm::distance(c, a)});
}

glm::uvec3 BodySurface::places(std::uint32_t triangle) const {
  const glm::uvec3& corner = avatar_.triangles[triangle];
  return {place_[corner.x], place_[corner.y], place_[corner.z]};
}

double texture_layers(const BodySurface& surface) {
  double layers = 0;
  for (std::uint32_t i = 0; i < surface.avatar().triangles.size(); ++i) {
    const auto [a, b, c] = surface.texels(i, glm::dvec2(1));
    const double area = std::abs((b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x)) / 2;
    if (fits_texture({a, b, c}, glm::dvec2(1))) layers += area;
  }
  return layers;
}

bool has_texture_coordinates(const Avatar& avatar) {
  const auto& coordinates = avatar.texture_coordinate;
  return std::ranges::any_of(coordinates, [&](const glm::vec2& c) { return c != coordinates.front(); });
}

void require_texture_coordinates(const Avatar& avatar, std::string_view name) {
  if (has_texture_coordinates(avatar)) return;
  throw Error(
      name, "has no texture coordinates, so a map cannot tell its regions apart",
      "make the map --per-triangle, or unwrap the avatar (Blender: Edit Mode, UV > Smart UV Project) and export "
      "it with its UVs");
}

}  // namespace vestige
