#include "traces/places/front_view.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/vec2.hpp>

namespace vestige {

namespace {

constexpr double kCells = 350;

/// Returns twice the signed area.
double area(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

}  // namespace

FrontView::FrontView(const Skin& skin) {
  const Avatar& avatar = skin.avatar();
  std::vector<glm::dvec3> rest_m = skin.rest_m();
  for (glm::dvec3& place_m : rest_m) place_m = turned_to_front(place_m, avatar.facing.axis);
  box_m_ = box_around(rest_m);
  const glm::dvec3 extent = box_m_.extent();
  const double longest = std::max(extent.x, extent.y);
  if (!(longest > 0) || !std::isfinite(longest)) return;
  cell_m_ = longest / kCells;
  columns_ = static_cast<int>(std::ceil(extent.x / cell_m_)) + 1;
  rows_ = static_cast<int>(std::ceil(extent.y / cell_m_)) + 1;
  cells_.resize(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_));
  for (std::uint32_t i = 0; i < avatar.triangles.size(); ++i) draw(rest_m, avatar.triangles[i], i);
}

int FrontView::column_of(double x_m) const {
  return static_cast<int>(std::floor((x_m - box_m_.low.x) / cell_m_));
}

int FrontView::row_of(double y_m) const {
  return static_cast<int>(std::floor((y_m - box_m_.low.y) / cell_m_));
}

const FrontView::Cell* FrontView::at(int column, int row) const {
  if (column < 0 || column >= columns_ || row < 0 || row >= rows_) return nullptr;
  const auto& cell =
      cells_[static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) + static_cast<std::size_t>(column)];
  return cell ? &*cell : nullptr;
}

void FrontView::draw(const std::vector<glm::dvec3>& rest_m, const glm::uvec3& corners, std::uint32_t triangle) {
  const glm::dvec3& a = rest_m[corners.x];
  const glm::dvec3& b = rest_m[corners.y];
  const glm::dvec3& c = rest_m[corners.z];
  const double whole = area(a, b, c);
  if (whole == 0 || !std::isfinite(whole)) return;  // seen edge-on
  const glm::dvec3 low = glm::min(a, glm::min(b, c));
  const glm::dvec3 high = glm::max(a, glm::max(b, c));
  for (int row = row_of(low.y); row <= row_of(high.y); ++row) {
    for (int column = column_of(low.x); column <= column_of(high.x); ++column) {
      const glm::dvec3 centre(box_m_.low.x + (column + 0.5) * cell_m_, box_m_.low.y + (row + 0.5) * cell_m_, 0);
      const glm::dvec3 weight(area(centre, b, c) / whole, area(centre, c, a) / whole, area(centre, a, b) / whole);
      if (weight.x < 0 || weight.y < 0 || weight.z < 0) continue;
      const double z_m = weight.x * a.z + weight.y * b.z + weight.z * c.z;
      auto& cell =
          cells_[static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) + static_cast<std::size_t>(column)];
      if (!cell || z_m > cell->z_m) cell = Cell{{triangle, weight}, z_m};
    }
  }
}

}  // namespace vestige
