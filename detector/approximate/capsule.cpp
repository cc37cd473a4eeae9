#include "detector/approximate/capsule.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <limits>

namespace vestige {

namespace {

/// Limits a chord to the times at which |position + t speed| <= radius, for vectors of 2 or 3 numbers.
template <typename Vector>
Chord within_ball(Chord chord, const Vector& position, const Vector& speed, double radius) {
  const double a = glm::dot(speed, speed);
  const double b = glm::dot(position, speed);
  const double c = glm::dot(position, position) - radius * radius;
  if (a == 0) return c <= 0 ? chord : Chord::none();
  const double d = b * b - a * c;
  if (d < 0) return Chord::none();
  const double root = std::sqrt(d);
  return {std::max(chord.enter, (-b - root) / a), std::min(chord.leave, (-b + root) / a)};
}

/// The places of a triangle's area at which what is meant over it is measured (exact for polynomials of degree 2).
std::array<glm::dvec3, 3> samples(const Corners& triangle) {
  const auto& [a, b, c] = triangle;
  return {(a + b) / 2.0, (b + c) / 2.0, (c + a) / 2.0};
}

double across(const glm::dvec3& place) {
  return std::sqrt(place.y * place.y + place.z * place.z);
}

/// Returns the direction of (y, z) as a share of a whole turn, in [0, 1]. Equal steps of it are not quite equal angles,
/// but it has the same bits on every machine, as an arc tangent has not.
double turn_of(double y, double z) {
  const double sum = std::abs(y) + std::abs(z);
  if (!(sum > 0)) return 0;
  return (z >= 0 ? 1 - y / sum : 3 + y / sum) / 4;
}

/// Returns the direction, of length 1, with this share of a whole turn.
glm::dvec2 direction_of(double turn) {
  const double y = std::abs(4 * turn - 2) - 1;
  const double z = 1 - std::abs(y);
  return glm::normalize(glm::dvec2(y, turn < 0.5 ? z : -z));
}

}  // namespace

Capsule Capsule::fit(std::span<const Corners> triangles) {
  const MainAxes main = main_axes(triangles);
  double low = std::numeric_limits<double>::infinity();
  double high = -low;
  double area = 0;
  double distance = 0;
  double widest = 0;
  for (const Corners& triangle : triangles) {
    const auto& [a, b, c] = triangle;
    for (const glm::dvec3& corner : {a, b, c}) {
      const glm::dvec3 place = (corner - main.middle) * main.axes;
      low = std::min(low, place.x);
      high = std::max(high, place.x);
      widest = std::max(widest, across(place));
    }
    const double weight = glm::length(glm::cross(b - a, c - a)) / 6;
    for (const glm::dvec3& sample : samples(triangle)) {
      const glm::dvec3 place = (sample - main.middle) * main.axes;
      area += weight;
      distance += weight * across(place);
    }
  }
  const double mean = area > 0 ? distance / area : widest;
  const double half = (high - low) / 2;
  Capsule capsule;
  capsule.axes = main.axes;
  capsule.middle = main.middle + (low + high) / 2 * main.axes[0];
  capsule.radius = std::min(mean, half);
  capsule.half_length = half - capsule.radius;
  return capsule;
}

double Capsule::height(const glm::dvec3& point) const {
  const glm::dvec3 place = (point - middle) * axes;
  return glm::length(place - glm::dvec3(std::clamp(place.x, -half_length, half_length), 0, 0)) - radius;
}

Chord Capsule::chord(const glm::dvec3& start, const glm::dvec3& end) const {
  if (radius < 0) return Chord::none();
  const glm::dvec3 position = (start - middle) * axes;
  const glm::dvec3 speed = (end - start) * axes;
  const glm::dvec3 tip(half_length, 0, 0);
  // A convex shape of three convex parts: the first entry and the last exit of all.
  Chord whole = Chord::none();
  const auto add = [&](const Chord& part) {
    if (part.misses()) return;
    whole = whole.misses() ? part : Chord{std::min(whole.enter, part.enter), std::max(whole.leave, part.leave)};
  };
  add(within_ball(within_slab({}, position.x, speed.x, half_length), glm::dvec2(position.y, position.z),
                  glm::dvec2(speed.y, speed.z), radius));
  add(within_ball({}, position - tip, speed, radius));
  add(within_ball({}, position + tip, speed, radius));
  return whole;
}

glm::dvec3 Capsule::normal(const glm::dvec3& point) const {
  const glm::dvec3 place = (point - middle) * axes;
  const glm::dvec3 out = place - glm::dvec3(std::clamp(place.x, -half_length, half_length), 0, 0);
  const double length = glm::length(out);
  return length > 0 ? axes * (out / length) : axes[1];
}

std::size_t Capsule::cell(const glm::dvec3& point) const {
  const glm::dvec3 place = (point - middle) * axes;
  const double reach = half_length + radius;
  const auto cell_of = [](double share, std::size_t count) {
    return std::min(static_cast<std::size_t>(std::clamp(share, 0.0, 1.0) * static_cast<double>(count)), count - 1);
  };
  return cell_of(reach > 0 ? (place.x / reach + 1) / 2 : 0.5, kCellsAlong) * kCellsAround +
         cell_of(turn_of(place.y, place.z), kCellsAround);
}

glm::dvec3 Capsule::middle_of_cell(std::size_t cell) const {
  const std::size_t ring = cell / kCellsAround;
  const double along = (2.0 * static_cast<double>(ring) + 1) / kCellsAlong - 1;
  const double x = along * (half_length + radius);
  const double beyond = std::max(0.0, std::abs(x) - half_length);
  const double out = std::sqrt(std::max(0.0, radius * radius - beyond * beyond));
  const glm::dvec2 direction = direction_of((static_cast<double>(cell % kCellsAround) + 0.5) / kCellsAround);
  return middle + axes * glm::dvec3(x, out * direction);
}

glm::dvec3 Capsule::reach(const glm::dmat3& matrix) const {
  const glm::dmat3 rows = glm::transpose(matrix);
  return glm::abs(matrix * axes[0]) * half_length +
         radius * glm::dvec3(glm::length(rows[0]), glm::length(rows[1]), glm::length(rows[2]));
}

}  // namespace vestige
