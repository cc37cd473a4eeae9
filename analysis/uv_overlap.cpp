#include "analysis/uv_overlap.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/vec2.hpp>

namespace vestige {

namespace {

constexpr double kMostTextures = 4;

/// Whether points on the edge from `a` to `b` belong to the triangle to its left: of two triangles that share an edge
/// and run along it in opposite directions, one says yes.
bool owns_edge(const glm::dvec2& a, const glm::dvec2& b) {
  return a.y != b.y ? a.y > b.y : a.x < b.x;
}

double doubled_area(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

bool covers(const std::array<glm::dvec2, 3>& corners, const glm::dvec2& p) {
  for (std::size_t i = 0; i < 3; ++i) {
    // The edge's ends in one order, so that both of its triangles compute the same number.
    const glm::dvec2& a = corners[i];
    const glm::dvec2& b = corners[(i + 1) % 3];
    const bool swap = b.x < a.x || (b.x == a.x && b.y < a.y);
    const double area = swap ? -doubled_area(b, a, p) : doubled_area(a, b, p);
    if (area < 0 || (area == 0 && !owns_edge(a, b))) return false;
  }
  return true;
}

class Painter {
 public:
  Painter(const Avatar& avatar, UvCoverage& coverage) : avatar_(avatar), coverage_(coverage) {}

  void paint(const glm::uvec3& triangle) {
    std::array<glm::dvec2, 3> corners;
    for (int i = 0; i < 3; ++i)
      corners[static_cast<std::size_t>(i)] =
          glm::dvec2(avatar_.texture_coordinate[triangle[i]]) * static_cast<double>(coverage_.side);
    const double area = doubled_area(corners[0], corners[1], corners[2]);
    if (area == 0) return;
    if (area < 0) std::swap(corners[1], corners[2]);
    const glm::dvec2 low = glm::floor(glm::min(corners[0], glm::min(corners[1], corners[2])));
    const glm::dvec2 high = glm::ceil(glm::max(corners[0], glm::max(corners[1], corners[2])));
    const double side = coverage_.side;
    const bool is_huge = std::max(high.x - low.x, high.y - low.y) > kMostTextures * side;
    const auto columns = static_cast<int>(std::min(high.x - low.x, is_huge ? side : kMostTextures * side));
    const auto rows = static_cast<int>(std::min(high.y - low.y, is_huge ? side : kMostTextures * side));
    for (int row = 0; row < rows; ++row)
      for (int column = 0; column < columns; ++column) {
        const glm::dvec2 texel = low + glm::dvec2(column, row);
        if (is_huge || covers(corners, texel + 0.5)) add(texel.x, texel.y);
      }
  }

 private:
  void add(double x, double y) {
    const double side = coverage_.side;
    const auto wrap = [&](double texel) {
      // Coordinates beyond 2^53 texels all fall on 0.
      return std::min(static_cast<std::uint32_t>(texel - side * std::floor(texel / side)), coverage_.side - 1);
    };
    std::uint8_t& layers = coverage_.layers[std::size_t{wrap(y)} * coverage_.side + wrap(x)];
    if (layers < 255) ++layers;
  }

  const Avatar& avatar_;
  UvCoverage& coverage_;
};

}  // namespace

UvCoverage uv_coverage(const Avatar& avatar, std::uint32_t side) {
  UvCoverage coverage;
  coverage.side = side;
  coverage.layers.assign(std::size_t{side} * side, 0);
  Painter painter(avatar, coverage);
  for (const glm::uvec3& triangle : avatar.triangles) painter.paint(triangle);
  coverage.covered_texels =
      static_cast<std::size_t>(std::ranges::count_if(coverage.layers, [](std::uint8_t n) { return n >= 1; }));
  coverage.overlap_texels =
      static_cast<std::size_t>(std::ranges::count_if(coverage.layers, [](std::uint8_t n) { return n >= 2; }));
  return coverage;
}

}  // namespace vestige
