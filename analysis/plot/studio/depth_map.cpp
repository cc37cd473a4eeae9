#include "analysis/plot/studio/depth_map.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace vestige::plot {

namespace {

struct Corner {
  double x;  ///< dots
  double y;  ///< dots from the top
  double z;
};

/// The first and last of `count` dots whose middle may lie within [low, high]; last < first: none.
struct Reach {
  std::ptrdiff_t first;
  std::ptrdiff_t last;
};

Reach reach(double low, double high, std::size_t count) {
  const double most = static_cast<double>(count) - 1;
  return {static_cast<std::ptrdiff_t>(std::clamp(std::ceil(low - 0.5), 0.0, most + 1)),
          static_cast<std::ptrdiff_t>(std::clamp(std::floor(high - 0.5), -1.0, most))};
}

/// A dot's middle on the edge of two triangles belongs to both, whatever was rounded: what lies behind is not seen
/// between.
constexpr double kEdgeSlack = 1e-9;

}  // namespace

std::vector<Sample> draw_surface(const Surface& surface, const View& view) {
  std::vector<Sample> samples(view.width * view.height);
  std::vector<Corner> corners;
  corners.reserve(surface.position.size());
  for (const glm::vec3& position : surface.position) {
    const glm::dvec3 seen = view.camera.seen(glm::dvec3(position));
    corners.push_back({(seen.x - view.left) / view.unit_per_dot,
                       static_cast<double>(view.height) - (seen.y - view.bottom) / view.unit_per_dot, seen.z});
  }
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    const glm::uvec3& index = surface.triangles[t];
    const Corner a = corners[index.x];
    const Corner b = corners[index.y];
    const Corner c = corners[index.z];
    const double area = (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
    if (!std::isfinite(area) || area == 0) continue;
    const auto [left, right] = std::minmax({a.x, b.x, c.x});
    const auto [top, bottom] = std::minmax({a.y, b.y, c.y});
    const Reach columns = reach(left, right, view.width);
    const Reach rows = reach(top, bottom, view.height);
    for (std::ptrdiff_t row = rows.first; row <= rows.last; ++row) {
      const double y = static_cast<double>(row) + 0.5;
      for (std::ptrdiff_t column = columns.first; column <= columns.last; ++column) {
        const double x = static_cast<double>(column) + 0.5;
        const double u = ((x - a.x) * (c.y - a.y) - (y - a.y) * (c.x - a.x)) / area;
        const double v = ((b.x - a.x) * (y - a.y) - (b.y - a.y) * (x - a.x)) / area;
        if (u < -kEdgeSlack || v < -kEdgeSlack || u + v > 1 + kEdgeSlack) continue;
        const auto depth = static_cast<float>(a.z + u * (b.z - a.z) + v * (c.z - a.z));
        Sample& sample = samples[static_cast<std::size_t>(row) * view.width + static_cast<std::size_t>(column)];
        if (depth > sample.depth)
          sample = {static_cast<std::uint32_t>(t), static_cast<float>(u), static_cast<float>(v), depth};
      }
    }
  }
  return samples;
}

}  // namespace vestige::plot
