#include "traces/places/skin.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <iterator>
#include <tuple>

#include "traces/scene/pose.hpp"
#include "traces/scene/reference_skinning.hpp"
#include "traces/scene/welding.hpp"

namespace vestige {

namespace {

/// The key of vertices with the same bind position and the same influences, which every pose moves alike. Keys have an
/// order, by bits.
auto weld_key(const Avatar& avatar, std::uint32_t vertex) {
  const Influences& influences = avatar.influences[vertex];
  const glm::vec3 position = avatar.position_bind[vertex] + 0.0F;  // -0 is 0
  return std::tuple(std::bit_cast<std::array<std::uint32_t, 3>>(position), influences.palette,
                    std::bit_cast<std::array<std::uint32_t, kMaxInfluences>>(influences.weight));
}

std::vector<std::uint32_t> weld_vertices(const Avatar& avatar) {
  return weld(avatar.position_bind.size(), [&](std::uint32_t vertex) { return weld_key(avatar, vertex); });
}

/// Returns area-weighted normals in the space of bind positions, indexed by `weld_`.
std::vector<glm::dvec3> bind_normals(const Avatar& avatar, const std::vector<std::uint32_t>& welded) {
  std::vector<glm::dvec3> normals(avatar.position_bind.size(), glm::dvec3(0));
  for (const glm::uvec3& triangle : avatar.triangles) {
    const glm::dvec3 a(avatar.position_bind[triangle.x]);
    const glm::dvec3 b(avatar.position_bind[triangle.y]);
    const glm::dvec3 c(avatar.position_bind[triangle.z]);
    const glm::dvec3 normal = glm::cross(b - a, c - a);
    for (int corner = 0; corner < 3; ++corner) normals[welded[triangle[corner]]] += normal;
  }
  for (glm::dvec3& normal : normals) {
    const double length = glm::length(normal);
    if (length > 0) normal /= length;
  }
  return normals;
}

}  // namespace

Skin::Skin(const Avatar& avatar)
    : avatar_(avatar), weld_(weld_vertices(avatar)), normal_bind_(bind_normals(avatar, weld_)) {
  skin_reference(avatar, rest_pose(avatar), glm::dvec3(0), rest_m_);
  double sum = 0;
  for (const glm::uvec3& triangle : avatar.triangles) {
    const glm::dvec3& a = rest_m_[triangle.x];
    const double area = 0.5 * glm::length(glm::cross(rest_m_[triangle.y] - a, rest_m_[triangle.z] - a));
    if (std::isfinite(area)) sum += area;
    area_up_to_.push_back(sum);
  }
}

SkinPoint Skin::random_point(Random& random) const {
  const double whole = area_up_to_.back();
  if (!(whole > 0)) return {static_cast<std::uint32_t>(random.index(area_up_to_.size())), glm::dvec3(1, 0, 0)};
  const auto found = std::ranges::upper_bound(area_up_to_, random.uniform(0, whole));
  const auto triangle = std::min(std::distance(area_up_to_.begin(), found), std::ssize(area_up_to_) - 1);
  const double root = std::sqrt(random.uniform(0, 1));
  const double share = random.uniform(0, 1);
  return {static_cast<std::uint32_t>(triangle), {1 - root, root * (1 - share), root * share}};
}

SkinPlace Skin::place(const SkinPoint& point, const std::vector<glm::dmat4>& palette) const {
  SkinPlace place = {glm::dvec3(0), glm::dvec3(0)};
  const glm::uvec3& triangle = avatar_.triangles[point.triangle];
  for (int corner = 0; corner < 3; ++corner) {
    const std::uint32_t vertex = triangle[corner];
    place.position_m += point.weight[corner] * skin_vertex(avatar_, palette, vertex);
    glm::dvec3 normal(0);
    const Influences& influences = avatar_.influences[vertex];
    for (std::size_t k = 0; k < kMaxInfluences && influences.weight[k] > 0; ++k)
      normal +=
          double{influences.weight[k]} * (glm::dmat3(palette[influences.palette[k]]) * normal_bind_[weld_[vertex]]);
    const double length = glm::length(normal);
    if (length > 0) place.normal += point.weight[corner] / length * normal;
  }
  const double length = glm::length(place.normal);
  place.normal = length > 0 ? place.normal / length : glm::dvec3(0, 0, 1);
  return place;
}

glm::dvec3 Skin::face_normal(std::uint32_t triangle, const std::vector<glm::dmat4>& palette) const {
  const glm::uvec3& corners = avatar_.triangles[triangle];
  const glm::dvec3 a = skin_vertex(avatar_, palette, corners.x);
  const glm::dvec3 normal = glm::cross(skin_vertex(avatar_, palette, corners.y) - a,  //
                                       skin_vertex(avatar_, palette, corners.z) - a);
  const double length = glm::length(normal);
  return length > 0 ? normal / length : glm::dvec3(0);
}

}  // namespace vestige
