#pragma once

#include <glm/vec3.hpp>
#include <optional>
#include <vector>

#include "traces/scenarios/skin.hpp"
#include "traces/scene/box.hpp"

namespace vestige {

/// The skin as seen from the front: a grid of the points that lie foremost in the rest pose. The front is +z, up is +y,
/// as glTF 2.0 §3.4 wants it. The longest side has 350 cells: 5 mm each on a human being.
class FrontView {
 public:
  explicit FrontView(const Skin& skin);

  int columns() const { return columns_; }  ///< along +x, the avatar's left
  int rows() const { return rows_; }        ///< upwards
  double cell_m() const { return cell_m_; }
  /// The cell that holds this place, which may be beyond the grid.
  int column_of(double x_m) const;
  int row_of(double y_m) const;
  /// The box around the avatar at rest.
  const Box& box_m() const { return box_m_; }

  struct Cell {
    SkinPoint point;
    double z_m;  ///< at rest
  };
  /// Null beyond the grid and where there is no skin.
  const Cell* at(int column, int row) const;

 private:
  void draw(const Skin& skin, std::uint32_t triangle);

  Box box_m_;
  double cell_m_ = 0;
  int columns_ = 0;
  int rows_ = 0;
  std::vector<std::optional<Cell>> cells_;  // row by row
};

}  // namespace vestige
