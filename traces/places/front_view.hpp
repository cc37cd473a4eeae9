#pragma once

#include <glm/vec3.hpp>
#include <optional>
#include <vector>

#include "traces/places/skin.hpp"
#include "traces/scene/box.hpp"

namespace vestige {

/// The skin seen from the front: a grid of the foremost points in the rest pose. Its places are turned about +y so that
/// the avatar faces +z (`Avatar::facing`). The longest side has 350 cells, which are 5 mm each on a human being.
class FrontView {
 public:
  explicit FrontView(const Skin& skin);

  int columns() const { return columns_; }  ///< along +x, the avatar's left
  int rows() const { return rows_; }        ///< upwards
  double cell_m() const { return cell_m_; }
  /// The cell that contains this place; it may lie outside the grid.
  int column_of(double x_m) const;
  int row_of(double y_m) const;
  /// The bounding box of the avatar at rest, turned to face +z.
  const Box& box_m() const { return box_m_; }

  struct Cell {
    SkinPoint point;
    double z_m;  ///< at rest
  };
  /// Returns null outside the grid and where there is no skin.
  const Cell* at(int column, int row) const;

 private:
  void draw(const std::vector<glm::dvec3>& rest_m, const glm::uvec3& corners, std::uint32_t triangle);

  Box box_m_;
  double cell_m_ = 0;
  int columns_ = 0;
  int rows_ = 0;
  std::vector<std::optional<Cell>> cells_;  // row by row
};

}  // namespace vestige
