#include "analysis/uv_overlap.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/vec2.hpp>
#include <limits>

namespace vestige {

namespace {

/// Where a triangle's outline crosses the middle of a row of texels: from `begin` up to, but not with, `end`. Two
/// triangles with a common edge compute the same crossing, so that no texel belongs to both.
struct Span {
  double begin = std::numeric_limits<double>::infinity();
  double end = -std::numeric_limits<double>::infinity();
};

class Painter {
 public:
  Painter(const Avatar& avatar, UvCoverage& coverage)
      : avatar_(avatar), coverage_(coverage), last_(coverage.layers.size(), kNone), full_(coverage.side, 0) {}

  void paint(std::uint32_t number) {
    const glm::uvec3& triangle = avatar_.triangles[number];
    const double side = coverage_.side;
    std::array<glm::dvec2, 3> corners;
    for (int i = 0; i < 3; ++i)
      corners[static_cast<std::size_t>(i)] = glm::dvec2(avatar_.texture_coordinate[triangle[i]]) * side;
    const auto [low, high] = std::minmax({corners[0].y, corners[1].y, corners[2].y});
    // Rows whose middle lies in [low, high); of one that wraps around the texture more than once, one turn.
    const double first = std::ceil(low - 0.5);
    const double rows = std::min(std::ceil(high - 0.5) - first, side);
    for (int row = 0; row < static_cast<int>(rows); ++row)
      paint_row(number, first + row, cross(corners, first + row + 0.5));
  }

 private:
  static constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

  static Span cross(const std::array<glm::dvec2, 3>& corners, double y) {
    Span span;
    for (std::size_t i = 0; i < 3; ++i) {
      const bool upwards = corners[i].y < corners[(i + 1) % 3].y;
      const glm::dvec2& a = corners[upwards ? i : (i + 1) % 3];
      const glm::dvec2& b = corners[upwards ? (i + 1) % 3 : i];
      if (y < a.y || y >= b.y) continue;
      const double x = a.x + (y - a.y) / (b.y - a.y) * (b.x - a.x);
      span.begin = std::min(span.begin, x);
      span.end = std::max(span.end, x);
    }
    return span;
  }

  void paint_row(std::uint32_t number, double y, const Span& span) {
    const double side = coverage_.side;
    const double first = std::ceil(span.begin - 0.5);
    const double columns = std::min(std::ceil(span.end - 0.5) - first, side);
    if (!(columns > 0)) return;
    const std::uint32_t line = wrap(y);
    if (full_[line] == coverage_.side) return;
    const std::size_t row = std::size_t{line} * coverage_.side;
    std::uint32_t column = wrap(first);
    for (int i = 0; i < static_cast<int>(columns); ++i) {
      const std::size_t texel = row + column;
      column = column + 1 == coverage_.side ? 0 : column + 1;
      // A triangle that wraps around may come by again: it is still one.
      if (last_[texel] == number) continue;
      last_[texel] = number;
      if (coverage_.layers[texel] < 255 && ++coverage_.layers[texel] == 255) ++full_[line];
    }
  }

  std::uint32_t wrap(double texel) const {
    const double side = coverage_.side;
    // Coordinates beyond 2^53 texels all fall on the first or last.
    return std::min(static_cast<std::uint32_t>(texel - side * std::floor(texel / side)), coverage_.side - 1);
  }

  const Avatar& avatar_;
  UvCoverage& coverage_;
  std::vector<std::uint32_t> last_;  ///< the triangle that was the last to cover each texel
  std::vector<std::uint32_t> full_;  ///< texels of each row that count no further
};

}  // namespace

UvCoverage uv_coverage(const Avatar& avatar, std::uint32_t side) {
  UvCoverage coverage;
  coverage.side = side;
  coverage.layers.assign(std::size_t{side} * side, 0);
  Painter painter(avatar, coverage);
  for (std::uint32_t number = 0; number < avatar.triangles.size(); ++number) painter.paint(number);
  coverage.covered_texels =
      static_cast<std::size_t>(std::ranges::count_if(coverage.layers, [](std::uint8_t n) { return n >= 1; }));
  coverage.overlap_texels =
      static_cast<std::size_t>(std::ranges::count_if(coverage.layers, [](std::uint8_t n) { return n >= 2; }));
  return coverage;
}

}  // namespace vestige
