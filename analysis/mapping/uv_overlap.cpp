#include "analysis/mapping/uv_overlap.hpp"

#include <algorithm>
#include <array>
#include <glm/vec2.hpp>
#include <limits>

#include "detector/actuators/uv_texels.hpp"

namespace vestige {

namespace {

class CoveragePainter {
 public:
  CoveragePainter(const Avatar& avatar, UvCoverage& coverage)
      : avatar_(avatar), coverage_(coverage), last_(coverage.layers.size(), kNone), full_(coverage.side, 0) {}

  void paint(std::uint32_t number) {
    const glm::uvec3& triangle = avatar_.triangles[number];
    const double side = coverage_.side;
    std::array<glm::dvec2, 3> corners;
    for (int i = 0; i < 3; ++i)
      corners[static_cast<std::size_t>(i)] = glm::dvec2(avatar_.texture_coordinate[triangle[i]]) * side;
    for_texels_of(
        corners, coverage_.side, coverage_.side,
        [&](std::uint32_t row, std::uint32_t column, std::uint32_t count) { paint_row(number, row, column, count); });
  }

 private:
  static constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

  void paint_row(std::uint32_t number, std::uint32_t line, std::uint32_t column, std::uint32_t count) {
    if (full_[line] == coverage_.side) return;
    const std::size_t row = std::size_t{line} * coverage_.side;
    for (std::uint32_t i = 0; i < count; ++i) {
      const std::size_t texel = row + column;
      column = column + 1 == coverage_.side ? 0 : column + 1;
      // A triangle that wraps around may cover a texel twice. It still counts once.
      if (last_[texel] == number) continue;
      last_[texel] = number;
      if (coverage_.layers[texel] < 255 && ++coverage_.layers[texel] == 255) ++full_[line];
    }
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
  CoveragePainter painter(avatar, coverage);
  for (std::uint32_t number = 0; number < avatar.triangles.size(); ++number) painter.paint(number);
  coverage.covered_texels =
      static_cast<std::size_t>(std::ranges::count_if(coverage.layers, [](std::uint8_t n) { return n >= 1; }));
  coverage.overlap_texels =
      static_cast<std::size_t>(std::ranges::count_if(coverage.layers, [](std::uint8_t n) { return n >= 2; }));
  return coverage;
}

}  // namespace vestige
