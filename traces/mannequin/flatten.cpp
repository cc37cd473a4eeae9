#include "traces/mannequin/flatten.hpp"

#include <Eigen/Geometry>
#include <Eigen/SparseCholesky>
#include <Eigen/SparseLU>
#include <cmath>
#include <glm/geometric.hpp>
#include <map>
#include <numbers>
#include <stdexcept>

namespace vestige::mannequin {

namespace {

/// Returns the chart's border vertices, in order.
std::vector<std::uint32_t> border_of(const Surface& surface, const Chart& chart) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, bool> edges;
  for (const std::uint32_t t : chart.triangles)
    for (int i = 0; i < 3; ++i) edges[{surface.triangles[t][i], surface.triangles[t][(i + 1) % 3]}] = true;
  std::map<std::uint32_t, std::uint32_t> next;
  for (const auto& [edge, present] : edges)
    if (!edges.contains({edge.second, edge.first}) && !next.insert(edge).second)
      throw std::runtime_error("a chart touches itself in a vertex");
  std::vector<std::uint32_t> loop = {next.begin()->first};
  while (next.at(loop.back()) != loop.front()) loop.push_back(next.at(loop.back()));
  if (loop.size() != next.size()) throw std::runtime_error("a chart has a hole");
  return loop;
}

using Sparse = Eigen::SparseMatrix<double>;
using Entries = std::vector<Eigen::Triplet<double>>;

/// The index in `Chart::vertices` of each vertex of the surface.
using Places = std::map<std::uint32_t, int>;

Places places_of(const Chart& chart) {
  Places places;
  for (std::size_t i = 0; i < chart.vertices.size(); ++i) places[chart.vertices[i]] = static_cast<int>(i);
  return places;
}

Sparse matrix_of(const Entries& entries, int count) {
  Sparse matrix(count, count);
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

/// Returns the barycentric map: the border on a circle, every other vertex in the middle of its neighbours.
Eigen::MatrixXd map_onto_disk(const Surface& surface, const Chart& chart, const Places& places) {
  const auto count = static_cast<int>(chart.vertices.size());
  const std::vector<std::uint32_t> border = border_of(surface, chart);
  Eigen::MatrixXd flat = Eigen::MatrixXd::Zero(count, 2);
  Entries entries;
  std::vector<bool> fixed(chart.vertices.size());
  for (std::size_t i = 0; i < border.size(); ++i) {
    const double angle = 2 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(border.size());
    const int v = places.at(border[i]);
    flat.row(v) << 0.3 * std::cos(angle), 0.3 * std::sin(angle);
    fixed[static_cast<std::size_t>(v)] = true;
    entries.emplace_back(v, v, 1);
  }
  for (const std::uint32_t t : chart.triangles)
    for (int i = 0; i < 3; ++i) {
      const int v = places.at(surface.triangles[t][i]);
      const int next = places.at(surface.triangles[t][(i + 1) % 3]);
      if (fixed[static_cast<std::size_t>(v)]) continue;
      entries.emplace_back(v, v, 1);
      entries.emplace_back(v, next, -1);
    }
  return Eigen::SparseLU<Sparse>(matrix_of(entries, count)).solve(flat);
}

/// A triangle's shape in space, in its own plane.
struct Flat {
  std::array<int, 3> corner;
  std::array<Eigen::Vector2d, 3> edge;  ///< from corner i to corner i + 1
  std::array<double, 3> cotangent;      ///< of the angle opposite to edge i
};

Flat lay_flat(const Surface& surface, std::uint32_t triangle, const Places& places) {
  std::array<glm::dvec3, 3> p;
  Flat f;
  for (int i = 0; i < 3; ++i) {
    p[static_cast<std::size_t>(i)] = surface.positions_m[surface.triangles[triangle][i]];
    f.corner[static_cast<std::size_t>(i)] = places.at(surface.triangles[triangle][i]);
  }
  const glm::dvec3 x = glm::normalize(p[1] - p[0]);
  const glm::dvec3 y = glm::cross(glm::normalize(glm::cross(p[1] - p[0], p[2] - p[0])), x);
  for (std::size_t i = 0; i < 3; ++i) {
    const glm::dvec3 e = p[(i + 1) % 3] - p[i];
    f.edge[i] = {glm::dot(e, x), glm::dot(e, y)};
    const glm::dvec3 a = p[i] - p[(i + 2) % 3];
    const glm::dvec3 b = p[(i + 1) % 3] - p[(i + 2) % 3];
    f.cotangent[i] = std::clamp(glm::dot(a, b) / glm::length(glm::cross(a, b)), 0.05, 20.0);
  }
  return f;
}

/// Returns the matrix of the global step, which never changes.
Sparse laplacian_of(const std::vector<Flat>& triangles, int count) {
  Entries laplacian = {{0, 0, 1e-6}};
  for (const Flat& f : triangles)
    for (std::size_t i = 0; i < 3; ++i) {
      const int v = f.corner[i];
      const int w = f.corner[(i + 1) % 3];
      const double k = f.cotangent[i];
      laplacian.insert(laplacian.end(), {{v, v, k}, {w, w, k}, {v, w, -k}, {w, v, -k}});
    }
  return matrix_of(laplacian, count);
}

/// The local step. Returns how each triangle, rotated to fit `flat`, pulls its corners.
Eigen::MatrixXd pulls_of(const std::vector<Flat>& triangles, const Eigen::MatrixXd& flat) {
  Eigen::MatrixXd right = Eigen::MatrixXd::Zero(flat.rows(), 2);
  for (const Flat& f : triangles) {
    // The rotation closest to the triangle's map: for a 2 x 2 matrix, its angle.
    double c = 0;
    double s = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      const Eigen::Vector2d u = flat.row(f.corner[(i + 1) % 3]) - flat.row(f.corner[i]);
      c += f.cotangent[i] * f.edge[i].dot(u);
      s += f.cotangent[i] * (f.edge[i].x() * u.y() - f.edge[i].y() * u.x());
    }
    const Eigen::Rotation2Dd rotation(std::atan2(s, c));
    for (std::size_t i = 0; i < 3; ++i) {
      const Eigen::Vector2d pull = f.cotangent[i] * (rotation * f.edge[i]);
      right.row(f.corner[(i + 1) % 3]) += pull;
      right.row(f.corner[i]) -= pull;
    }
  }
  return right;
}

}  // namespace

std::vector<glm::dvec2> flatten(const Surface& surface, const Chart& chart) {
  const Places places = places_of(chart);
  const auto count = static_cast<int>(chart.vertices.size());
  Eigen::MatrixXd flat = map_onto_disk(surface, chart, places);
  std::vector<Flat> triangles;
  for (const std::uint32_t t : chart.triangles) triangles.push_back(lay_flat(surface, t, places));
  const Eigen::SimplicialLDLT<Sparse> global(laplacian_of(triangles, count));
  constexpr int kSteps = 300;
  for (int step = 0; step < kSteps; ++step) flat = global.solve(pulls_of(triangles, flat));
  std::vector<glm::dvec2> result;
  result.reserve(chart.vertices.size());
  for (int i = 0; i < count; ++i) result.emplace_back(flat(i, 0), flat(i, 1));
  return result;
}

}  // namespace vestige::mannequin
