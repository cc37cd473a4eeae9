#include "detector/detectors/contact_description.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

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
  glm::dvec3 weights = nearest_in_triangle(centre, at_contact);
  if (!are_shares(weights)) weights = nearest_on_edges(centre, at_contact);  // a triangle without area has only edges
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
