#include "analysis/plot/studio/depth_map.hpp"

#include <gtest/gtest.h>

namespace vestige::plot {
namespace {

/// Rectangles of two triangles each at z = 1 before one large triangle at z = 0, the last one.
Surface sheet_before_wall(int count) {
  Surface surface;
  for (int y = 0; y <= count; ++y)
    for (int x = 0; x <= count; ++x) surface.position.emplace_back(3 * x, y, 1);
  const auto row = static_cast<std::uint32_t>(count) + 1;
  for (std::uint32_t y = 0; y + 1 < row; ++y)
    for (std::uint32_t x = 0; x + 1 < row; ++x) {
      const std::uint32_t corner = y * row + x;
      surface.triangles.emplace_back(corner + 1, corner + row + 1, corner);
      surface.triangles.emplace_back(corner + row, corner, corner + row + 1);
    }
  const auto wall = static_cast<std::uint32_t>(surface.position.size());
  for (const glm::vec3 corner : {glm::vec3(-999, -999, 0), glm::vec3(999, -999, 0), glm::vec3(0, 999, 0)})
    surface.position.push_back(corner);
  surface.triangles.emplace_back(wall, wall + 1, wall + 2);
  return surface;
}

/// The edges pass through the middle of dots, where rounding decides the side: a surface has no cracks there.
TEST(DepthMap, NothingBehindIsSeenBetweenTwoTrianglesThatShareAnEdge) {
  constexpr std::size_t kCount = 20;
  const Surface surface = sheet_before_wall(kCount);
  for (std::size_t dots = 3; dots < 24; ++dots) {
    View view;
    view.unit_per_dot = 1 / static_cast<double>(dots);
    view.left = view.bottom = 0.5 * view.unit_per_dot;
    view.width = 3 * kCount * dots - 1;
    view.height = kCount * dots - 1;
    std::size_t behind = 0;
    for (const Sample& sample : draw_surface(surface, view))
      if (sample.triangle >= surface.triangles.size() - 1) ++behind;
    EXPECT_EQ(behind, 0U) << dots << " dots a unit";
  }
}

}  // namespace
}  // namespace vestige::plot
