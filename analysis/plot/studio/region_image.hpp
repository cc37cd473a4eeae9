#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "analysis/plot/canvas/canvas.hpp"
#include "analysis/plot/studio/studio.hpp"

namespace vestige::plot {

/// An actuator's number and where it is written, in dots.
struct RegionLabel {
  std::size_t actuator = 0;
  double column = 0;
  double row = 0;
};

/// Which actuator's skin is seen at each dot of a picture.
class RegionImage {
 public:
  using ActuatorAt = std::function<std::uint16_t(std::uint32_t triangle, double u, double v)>;

  RegionImage(const StudioShot& shot, const ActuatorAt& actuator_at);

  /// A dark line where regions meet, so that they are told apart in grey too.
  void outline(Raster& raster) const;

  /// For every actuator that is seen, and not only as a sliver, a dot far from other regions and near its middle.
  std::vector<RegionLabel> labels() const;

 private:
  static constexpr std::int32_t kNone = -1;  ///< beside the body

  std::int32_t at(std::size_t column, std::size_t row) const { return region_[row * width_ + column]; }
  std::vector<float> distances() const;

  std::size_t width_;
  std::size_t height_;
  std::vector<std::int32_t> region_;
};

}  // namespace vestige::plot
