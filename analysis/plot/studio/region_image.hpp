#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "analysis/plot/canvas/canvas.hpp"
#include "analysis/plot/studio/studio.hpp"

namespace vestige::plot {

/// An actuator's number and the place of its label, in dots.
struct RegionLabel {
  std::size_t actuator = 0;
  double column = 0;
  double row = 0;
};

/// The actuator whose skin is visible at each dot of a picture.
class RegionImage {
 public:
  using ActuatorAt = std::function<std::uint16_t(std::uint32_t triangle, double u, double v)>;

  RegionImage(const StudioShot& shot, const ActuatorAt& actuator_at);

  /// Draws a dark line where regions meet, so that regions differ in grey too.
  void outline(Raster& raster) const;

  /// Returns a label for every visible actuator, except those of which only a sliver is visible. The label is at a dot
  /// far from other regions and near the middle of the visible skin.
  std::vector<RegionLabel> labels() const;

 private:
  static constexpr std::int32_t kNone = -1;  ///< not on the body

  std::int32_t at(std::size_t column, std::size_t row) const { return region_[row * width_ + column]; }
  std::vector<float> distances() const;

  std::size_t width_;
  std::size_t height_;
  std::vector<std::int32_t> region_;
};

}  // namespace vestige::plot
