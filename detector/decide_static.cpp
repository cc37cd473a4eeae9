#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "detector/decision.hpp"

namespace vestige {

namespace {

struct SegmentHit {
  double t = 0;
  int side = 0;
};

bool is_zero(const glm::dvec3& v) {
  return v.x == 0 && v.y == 0 && v.z == 0;
}

/// The first t at which p + t d meets the closed edge a + s e, when the two are coplanar lines.
std::optional<double> first_on_edge(const glm::dvec3& p, const glm::dvec3& d, const glm::dvec3& a,
                                    const glm::dvec3& e) {
  const glm::dvec3 to_edge = a - p;
  if (glm::dot(glm::cross(to_edge, e), d) != 0) return std::nullopt;
  const glm::dvec3 normal = glm::cross(d, e);
  if (!is_zero(normal)) {
    const double scale = glm::dot(normal, normal);
    const double t = glm::dot(glm::cross(to_edge, e), normal) / scale;
    const double s = glm::dot(glm::cross(to_edge, d), normal) / scale;
    if (t < 0 || t > 1 || s < 0 || s > 1) return std::nullopt;
    return t;
  }
  if (is_zero(d)) {  // a resting collider: is it on the edge?
    const double along = -glm::dot(to_edge, e);
    const bool on_edge = is_zero(glm::cross(to_edge, e)) && along >= 0 && along <= glm::dot(e, e);
    const bool on_point = !is_zero(e) || is_zero(to_edge);
    return on_edge && on_point ? std::optional(0.0) : std::nullopt;
  }
  if (!is_zero(glm::cross(to_edge, d))) return std::nullopt;  // parallel, apart
  const double length = glm::dot(d, d);
  const double first = glm::dot(to_edge, d) / length;
  const double second = glm::dot(to_edge + e, d) / length;
  if (std::max(first, second) < 0 || std::min(first, second) > 1) return std::nullopt;
  return std::max(std::min(first, second), 0.0);
}

/// Is x, a point of the triangle's plane, inside the closed triangle? `normal` is not zero.
bool contains(const glm::dvec3& x, const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c,
              const glm::dvec3& normal) {
  const double ab = glm::dot(glm::cross(b - a, x - a), normal);
  const double bc = glm::dot(glm::cross(c - b, x - b), normal);
  const double ca = glm::dot(glm::cross(a - c, x - c), normal);
  return ab >= 0 && bc >= 0 && ca >= 0;
}

/// The first overlap, given that all lie in one plane. `normal` is zero for a triangle without area.
std::optional<SegmentHit> flat_hit(const glm::dvec3& p, const glm::dvec3& d, const glm::dvec3& a, const glm::dvec3& b,
                                   const glm::dvec3& c, const glm::dvec3& normal) {
  if (!is_zero(normal) && contains(p, a, b, c, normal)) return SegmentHit{0, 0};
  std::optional<double> first;
  for (const auto& t : {first_on_edge(p, d, a, b - a), first_on_edge(p, d, b, c - b), first_on_edge(p, d, c, a - c)})
    if (t && (!first || *t < *first)) first = t;
  if (!first) return std::nullopt;
  return SegmentHit{*first, 0};
}

/// Segment and triangle in one plane, or a triangle without area.
std::optional<SegmentHit> coplanar_hit(const glm::dvec3& p, const glm::dvec3& d, const glm::dvec3& a,
                                       const glm::dvec3& b, const glm::dvec3& c, const glm::dvec3& normal) {
  if (!is_zero(normal)) {
    // In the plane's own two dimensions: without the coordinate in which the normal is longest. There the edges'
    // lines are coplanar with the segment exactly, not only up to rounding.
    const glm::dvec3 size = glm::abs(normal);
    const int dropped = size.x >= size.y && size.x >= size.z ? 0 : (size.y >= size.z ? 1 : 2);
    const auto flat = [dropped](glm::dvec3 v) {
      v[dropped] = 0;
      return v;
    };
    const glm::dvec3 flat_normal = glm::cross(flat(b) - flat(a), flat(c) - flat(a));
    return flat_hit(flat(p), flat(d), flat(a), flat(b), flat(c), flat_normal);
  }
  return flat_hit(p, d, a, b, c, normal);
}

std::optional<SegmentHit> segment_triangle(const glm::dvec3& p, const glm::dvec3& q, const glm::dvec3& a,
                                           const glm::dvec3& b, const glm::dvec3& c) {
  const glm::dvec3 normal = glm::cross(b - a, c - a);
  const double above_p = glm::dot(normal, p - a);
  const double above_q = glm::dot(normal, q - a);
  if ((above_p > 0 && above_q > 0) || (above_p < 0 && above_q < 0)) return std::nullopt;
  const glm::dvec3 d = q - p;
  if (above_p == 0 && above_q == 0) return coplanar_hit(p, d, a, b, c, normal);

  // Signed volumes of d with each edge. cross(x, y) is exactly -cross(y, x), so the triangle on the other side of an
  // edge sees exactly the opposite value.
  const glm::dvec3 to_a = a - p;
  const glm::dvec3 to_b = b - p;
  const glm::dvec3 to_c = c - p;
  const double ab = glm::dot(d, glm::cross(to_a, to_b));
  const double bc = glm::dot(d, glm::cross(to_b, to_c));
  const double ca = glm::dot(d, glm::cross(to_c, to_a));
  const bool all_left = ab >= 0 && bc >= 0 && ca >= 0;
  const bool all_right = ab <= 0 && bc <= 0 && ca <= 0;
  if (!all_left && !all_right) return std::nullopt;
  return SegmentHit{above_p / (above_p - above_q), above_p - above_q > 0 ? 1 : -1};
}

}  // namespace

Decision decide_static(const Way& way, const Corners& triangle) {
  const auto hit = segment_triangle(way.start, way.end, triangle.a, triangle.b, triangle.c);
  if (!hit) return {};
  return {FirstContact{static_cast<float>(hit->t) + 0.0F, static_cast<std::int8_t>(hit->side)}, false};
}

}  // namespace vestige
