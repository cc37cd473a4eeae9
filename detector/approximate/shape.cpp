#include "detector/approximate/shape.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <vector>

namespace vestige {

namespace {

/// Areas of the triangles, or equal weights if no triangle has any.
std::vector<double> weights_of(std::span<const Corners> triangles) {
  std::vector<double> weights;
  weights.reserve(triangles.size());
  double sum = 0;
  for (const auto& [a, b, c] : triangles) {
    weights.push_back(glm::length(glm::cross(b - a, c - a)) / 2);
    sum += weights.back();
  }
  if (!(sum > 0)) std::ranges::fill(weights, 1.0);
  return weights;
}

}  // namespace

Chord within_slab(Chord chord, double position, double speed, double half) {
  if (half < 0) return Chord::none();
  if (speed == 0) return std::abs(position) <= half ? chord : Chord::none();
  const double first = (-half - position) / speed;
  const double second = (half - position) / speed;
  return {std::max(chord.enter, std::min(first, second)), std::min(chord.leave, std::max(first, second))};
}

MainAxes main_axes(std::span<const Corners> triangles) {
  const std::vector<double> weights = weights_of(triangles);
  glm::dvec3 middle(0);
  double area = 0;
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    middle += weights[i] / 3 * (triangles[i].a + triangles[i].b + triangles[i].c);
    area += weights[i];
  }
  middle /= area;
  // The integral of x x^T over a triangle is area / 12 (a a^T + b b^T + c c^T + s s^T), with s = a + b + c.
  glm::dmat3 moments(0);
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    const glm::dvec3 a = triangles[i].a - middle;
    const glm::dvec3 b = triangles[i].b - middle;
    const glm::dvec3 c = triangles[i].c - middle;
    for (const glm::dvec3& x : {a, b, c, a + b + c}) moments += weights[i] / 12 * glm::outerProduct(x, x);
  }
  Eigen::Matrix3d matrix;
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 3; ++column) matrix(row, column) = moments[column][row];
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(matrix);  // ascending
  const auto direction = [&](int i) {
    const Eigen::Vector3d vector = solver.eigenvectors().col(i);
    return glm::dvec3(vector.x(), vector.y(), vector.z());
  };
  const glm::dvec3 longest = direction(2);
  const glm::dvec3 second = direction(1);
  return {middle, glm::dmat3(longest, second, glm::cross(longest, second))};
}

}  // namespace vestige
