#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <string_view>
#include <vector>

#include "traces/places/skin.hpp"
#include "traces/scene/avatar.hpp"
#include "traces/scene/box.hpp"

namespace vestige {

/// An avatar's skin in its rest pose as one surface, in the axes of its file (glTF: metres, y up). Vertices that only a
/// texture seam splits count as one place.
class BodySurface {
 public:
  /// `avatar` must have triangles and must outlive this object.
  explicit BodySurface(const Avatar& avatar);

  const Avatar& avatar() const { return avatar_; }
  /// The bounds of all triangles, metres. Vertices without a triangle do not count.
  const Box& bounds() const { return bounds_; }
  double height_m() const { return bounds_.extent().y; }

  /// The rest position of each vertex, metres.
  const std::vector<glm::dvec3>& rest_m() const { return rest_m_; }
  glm::dvec3 position_m(const SkinPoint& point) const;
  glm::dvec2 texture_coordinate(const SkinPoint& point) const;
  /// Returns a triangle's corners in texels of a map of this size, not wrapped.
  std::array<glm::dvec2, 3> texels(std::uint32_t triangle, const glm::dvec2& map_size) const;
  std::array<glm::dvec3, 3> corners_m(std::uint32_t triangle) const;
  double area_m2(std::uint32_t triangle) const;
  double longest_edge_m(std::uint32_t triangle) const;
  /// Returns the places of a triangle's corners. Corners of other triangles at the same position share a place.
  glm::uvec3 places(std::uint32_t triangle) const;
  std::size_t place_count() const { return place_count_; }

 private:
  const Avatar& avatar_;
  std::vector<glm::dvec3> rest_m_;
  std::vector<std::uint32_t> place_;  ///< the place of each vertex
  std::size_t place_count_ = 0;
  Box bounds_;
};

/// Returns how many times over the triangles cover the texture.
double texture_layers(const BodySurface& surface);

/// Takes the finished share of a long work, 0 … 1.
using WorkProgress = std::function<void(double)>;

/// Calls `visit` for the number of each triangle, and `progress` now and then unless it is empty.
template <typename Visit>
void for_each_triangle(const BodySurface& surface, const WorkProgress& progress, const Visit& visit) {
  constexpr std::uint32_t kReported = 256;
  const auto count = static_cast<std::uint32_t>(surface.avatar().triangles.size());
  for (std::uint32_t i = 0; i < count; ++i) {
    if (progress && i % kReported == 0) progress(static_cast<double>(i) / count);
    visit(i);
  }
}

/// Returns whether any two vertices differ in their texture coordinates.
bool has_texture_coordinates(const Avatar& avatar);

/// Throws `Error` if the avatar has no texture coordinates. `name` is the avatar's name in the error.
void require_texture_coordinates(const Avatar& avatar, std::string_view name);

}  // namespace vestige
