#include "analysis/plot/studio/surface.hpp"

#include <cmath>
#include <cstring>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <string>
#include <string_view>
#include <unordered_map>

#include "traces/scene/reference_skinning.hpp"

namespace vestige::plot {

namespace {

constexpr double kSoftEdgeCosine = 0.64;  // 50 degrees

bool is_finite(const glm::vec3& point) {
  return std::isfinite(point.x) && std::isfinite(point.y) && std::isfinite(point.z);
}

glm::dvec3 unit(const glm::dvec3& vector) {
  const double length = glm::length(vector);
  return length > 0 ? vector / length : glm::dvec3(0, 0, 0);
}

}  // namespace

glm::dvec3 Surface::point(std::uint32_t triangle, double u, double v) const {
  const glm::uvec3& corner = triangles[triangle];
  return (1 - u - v) * glm::dvec3(position[corner.x]) + u * glm::dvec3(position[corner.y]) +
         v * glm::dvec3(position[corner.z]);
}

glm::dvec3 Surface::normal(std::uint32_t triangle, double u, double v) const {
  const std::array<glm::vec3, 3>& normals = corner_normals[triangle];
  return unit((1 - u - v) * glm::dvec3(normals[0]) + u * glm::dvec3(normals[1]) + v * glm::dvec3(normals[2]));
}

void Surface::append(const Surface& other) {
  const auto first = static_cast<std::uint32_t>(position.size());
  position.insert(position.end(), other.position.begin(), other.position.end());
  for (const glm::uvec3& triangle : other.triangles) triangles.push_back(triangle + first);
  corner_normals.insert(corner_normals.end(), other.corner_normals.begin(), other.corner_normals.end());
  low = glm::min(low, other.low);
  high = glm::max(high, other.high);
}

SurfacePoser::SurfacePoser(const Avatar& avatar) : avatar_(avatar) {
  std::unordered_map<std::string, std::uint32_t> places;
  place_.reserve(avatar.position_bind.size());
  for (std::size_t vertex = 0; vertex < avatar.position_bind.size(); ++vertex) {
    const glm::vec3 bind = avatar.position_bind[vertex] + 0.0F;  // +0: no -0, whose bits differ
    std::string key(sizeof(bind) + sizeof(Influences), '\0');
    std::memcpy(key.data(), &bind, sizeof(bind));
    std::memcpy(key.data() + sizeof(bind), &avatar.influences[vertex], sizeof(Influences));
    place_.push_back(places.try_emplace(std::move(key), static_cast<std::uint32_t>(places.size())).first->second);
  }
  place_count_ = places.size();
}

Surface SurfacePoser::pose(const Pose& pose, const glm::dvec3& origin_m) const {
  Surface surface;
  std::vector<glm::dvec3> exact;
  skin_reference(avatar_, pose, origin_m, exact);
  surface.position.assign(exact.begin(), exact.end());
  surface.triangles = avatar_.triangles;
  surface.facing = avatar_.facing.axis;
  surface.low = glm::dvec3(std::numeric_limits<double>::max());
  surface.high = -surface.low;

  const std::size_t count = surface.triangles.size();
  std::vector<glm::dvec3> face(count);  // as long as twice the area
  std::vector<std::vector<std::uint32_t>> faces_at(place_count_);
  for (std::size_t t = 0; t < count; ++t) {
    const glm::uvec3& corner = surface.triangles[t];
    const glm::dvec3 a(surface.position[corner.x]);
    face[t] = glm::cross(glm::dvec3(surface.position[corner.y]) - a, glm::dvec3(surface.position[corner.z]) - a);
    for (int k = 0; k < 3; ++k) {
      faces_at[place_[corner[k]]].push_back(static_cast<std::uint32_t>(t));
      const glm::vec3& point = surface.position[corner[k]];
      if (!is_finite(point)) continue;
      surface.low = glm::min(surface.low, glm::dvec3(point));
      surface.high = glm::max(surface.high, glm::dvec3(point));
    }
  }
  if (surface.low.x > surface.high.x) surface.low = surface.high = glm::dvec3(0);

  surface.corner_normals.resize(count);
  for (std::size_t t = 0; t < count; ++t) {
    const glm::dvec3 own = unit(face[t]);
    for (int k = 0; k < 3; ++k) {
      glm::dvec3 sum(0);
      for (const std::uint32_t other : faces_at[place_[surface.triangles[t][k]]])
        if (glm::dot(own, unit(face[other])) > kSoftEdgeCosine) sum += face[other];
      surface.corner_normals[t][static_cast<std::size_t>(k)] = glm::vec3(unit(sum));
    }
  }
  return surface;
}

}  // namespace vestige::plot
