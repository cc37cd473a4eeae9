#include "detector/detectors/contact_description.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <glm/geometric.hpp>
#include <limits>

#include "detector/nearest_in_triangle.hpp"

namespace vestige {

glm::dvec2 barycentric_of(const glm::dvec3& x, const Corners& triangle) {
  const auto& [a, b, c] = triangle;
  const glm::dvec3 ab = b - a;
  const glm::dvec3 ac = c - a;
  const glm::dvec3 ax = x - a;
  const glm::dvec3 normal = glm::cross(ab, ac);
  const double area = glm::dot(normal, normal);
  if (area > 0) {
    double u = std::clamp(glm::dot(glm::cross(ax, ac), normal) / area, 0.0, 1.0);
    double v = std::clamp(glm::dot(glm::cross(ab, ax), normal) / area, 0.0, 1.0);
    const double sum = u + v;
    if (sum > 1) {
      u /= sum;
      v = 1 - u;
    }
    return {u, v};
  }
  const auto along = [](const glm::dvec3& from, const glm::dvec3& edge) {
    const double length = glm::dot(edge, edge);
    return length > 0 ? std::clamp(glm::dot(from, edge) / length, 0.0, 1.0) : 0.0;
  };
  const glm::dvec3 bc = c - b;
  const double ab_length = glm::dot(ab, ab);
  const double ac_length = glm::dot(ac, ac);
  const double bc_length = glm::dot(bc, bc);
  if (ab_length >= ac_length && ab_length >= bc_length) return {along(ax, ab), 0};
  if (ac_length >= bc_length) return {0, along(ax, ac)};
  const double s = along(x - b, bc);
  return {1 - s, s};
}

namespace {

/// Fills in what follows from the triangle and u, v.
void describe_place(const Avatar& avatar, const ActuatorMap& map, Contact& contact) {
  const glm::uvec3& corner = avatar.triangles[contact.triangle];
  const glm::dvec2 uv_a(avatar.texture_coordinate[corner.x]);
  const glm::dvec2 uv_b(avatar.texture_coordinate[corner.y]);
  const glm::dvec2 uv_c(avatar.texture_coordinate[corner.z]);
  contact.texture_coordinate = uv_a + contact.barycentric.x * (uv_b - uv_a) + contact.barycentric.y * (uv_c - uv_a);
  contact.actuator = map.at(contact.triangle, contact.texture_coordinate);
}

bool is_share_of_corner(double weight) {
  return weight >= 0 && weight <= 1;  // false for NaN
}

/// Returns the weights of the point of a triangle that is nearest to `x`. A triangle without area is the union of its
/// edges, and an edge without length its first end.
glm::dvec3 nearest_weights(const glm::dvec3& x, const Corners& triangle) {
  const glm::dvec3 weights = nearest_in_triangle(x, triangle);
  if (is_share_of_corner(weights.x) && is_share_of_corner(weights.y) && is_share_of_corner(weights.z)) return weights;
  const std::array corner = {triangle.a, triangle.b, triangle.c};
  glm::dvec3 nearest(0);
  double least = std::numeric_limits<double>::infinity();
  for (int i = 0; i < 3; ++i) {
    const int next = (i + 1) % 3;
    const glm::dvec3& from = corner[static_cast<std::size_t>(i)];
    const glm::dvec3 edge = corner[static_cast<std::size_t>(next)] - from;
    const double length = glm::dot(edge, edge);
    const double share = length > 0 ? std::clamp(glm::dot(x - from, edge) / length, 0.0, 1.0) : 0.0;
    const glm::dvec3 away = from + share * edge - x;
    if (const double distance = glm::dot(away, away); distance < least) {
      least = distance;
      nearest = glm::dvec3(0);
      nearest[i] = 1 - share;
      nearest[next] = share;
    }
  }
  return nearest;
}

glm::dvec3 weighed(const glm::dvec3& weights, const Corners& corners) {
  return weights.x * corners.a + weights.y * corners.b + weights.z * corners.c;
}

}  // namespace

Contact describe_contact(const Avatar& avatar, const ActuatorMap& map, const Meeting& meeting, double duration_s) {
  const auto& [triangle, way, at_contact, first] = meeting;
  Contact contact;
  contact.triangle = triangle;
  contact.t = first.t;
  contact.side = first.side;
  const glm::dvec3 moved = way.end - way.start;
  contact.position = way.start + static_cast<double>(first.t) * moved;
  contact.barycentric = barycentric_of(contact.position, at_contact);
  describe_place(avatar, map, contact);
  const glm::dvec3 normal = glm::cross(at_contact.b - at_contact.a, at_contact.c - at_contact.a);
  const double length = glm::length(normal);
  if (duration_s > 0 && length > 0) contact.speed_m_per_s = std::abs(glm::dot(moved, normal)) / length / duration_s;
  return contact;
}

SpherePair sphere_pair(const Segment& segment, const MovingCorners& corners, std::uint32_t triangle, Method method) {
  SpherePair pair = {triangle,
                     {{glm::dvec3(segment.start), glm::dvec3(segment.end)}, double{segment.radius_m}},
                     method == Method::kCcd ? corners.before : corners.now,
                     corners.now};
  if (method == Method::kCarried)
    pair.sphere.centre.start = glm::dvec3(carried_start(segment.start, corners.before, corners.now));
  return pair;
}

Contact describe_touch(const Avatar& avatar, const ActuatorMap& map, const SpherePair& pair, const FirstTouch& touch,
                       double duration_s) {
  const Way& way = pair.sphere.centre;
  const Corners at_contact = corners_at(pair.before, pair.now, touch.t);
  const glm::dvec3 centre = way.start + static_cast<double>(touch.t) * (way.end - way.start);
  const glm::dvec3 weights = nearest_weights(centre, at_contact);
  Contact contact;
  contact.triangle = pair.triangle;
  contact.t = touch.t;
  contact.side = touch.side;
  contact.position = weighed(weights, at_contact);
  contact.barycentric = {weights.y, weights.z};
  describe_place(avatar, map, contact);
  const glm::dvec3 moved = (way.end - way.start) - (weighed(weights, pair.now) - weighed(weights, pair.before));
  glm::dvec3 line = centre - contact.position;
  constexpr double kCoincident = 1e-6;  // of the radius: a shorter line is little but rounding
  if (glm::length(line) < kCoincident * pair.sphere.radius)
    line = glm::cross(at_contact.b - at_contact.a, at_contact.c - at_contact.a);
  const double length = glm::length(line);
  if (duration_s > 0 && length > 0) contact.speed_m_per_s = std::abs(glm::dot(moved, line)) / length / duration_s;
  return contact;
}

}  // namespace vestige
