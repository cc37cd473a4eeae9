#include "analysis/plot/studio/region_image.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "analysis/colours/palette.hpp"

namespace vestige::plot {

RegionImage::RegionImage(const StudioShot& shot, const ActuatorAt& actuator_at)
    : width_(shot.view().width), height_(shot.view().height) {
  region_.reserve(width_ * height_);
  for (std::size_t row = 0; row < height_; ++row)
    for (std::size_t column = 0; column < width_; ++column) {
      const Sample& sample = shot.at(column, row);
      region_.push_back(sample.triangle == Sample::kNothing
                            ? kNone
                            : std::int32_t{actuator_at(sample.triangle, double{sample.u}, double{sample.v})});
    }
}

void RegionImage::outline(Raster& raster) const {
  for (std::size_t row = 1; row < height_; ++row)
    for (std::size_t column = 1; column < width_; ++column) {
      const std::int32_t here = at(column, row);
      for (const std::int32_t other : {at(column - 1, row), at(column, row - 1)})
        if (here != other && here != kNone && other != kNone)
          raster.at(column, row) = blend(raster.at(column, row), kInk, 0.65);
    }
}

std::vector<RegionLabel> RegionImage::labels() const {
  struct Sight {
    float depth = 0;  ///< of its innermost dot, in dots from its edge
    double column = 0;
    double row = 0;
    double dots = 0;
  };
  const std::vector<float> distance = distances();
  std::vector<Sight> sights;
  const auto each_dot = [&](const auto& visit) {
    for (std::size_t row = 0; row < height_; ++row)
      for (std::size_t column = 0; column < width_; ++column)
        if (const std::int32_t actuator = at(column, row); actuator > 0)
          visit(static_cast<std::size_t>(actuator), distance[row * width_ + column], static_cast<double>(column) + 0.5,
                static_cast<double>(row) + 0.5);
  };
  each_dot([&](std::size_t actuator, float depth, double column, double row) {
    if (actuator >= sights.size()) sights.resize(actuator + 1);
    Sight& sight = sights[actuator];
    sight.depth = std::max(sight.depth, depth);
    sight.column += column;
    sight.row += row;
    ++sight.dots;
  });

  // A strip is equally deep all along: of the dots that are nearly the deepest, the one nearest to the middle.
  constexpr float kNearlyDeepest = 0.9F;
  constexpr float kLeastDots = 4;  // of a smaller sight a label would hide all
  std::vector<RegionLabel> labels(sights.size());
  std::vector<double> off_middle(sights.size(), std::numeric_limits<double>::infinity());
  each_dot([&](std::size_t actuator, float depth, double column, double row) {
    const Sight& sight = sights[actuator];
    if (depth < kLeastDots || depth < kNearlyDeepest * sight.depth) return;
    const double off = std::hypot(column - sight.column / sight.dots, row - sight.row / sight.dots);
    if (off >= off_middle[actuator]) return;
    off_middle[actuator] = off;
    labels[actuator] = {actuator, column, row};
  });
  std::erase_if(labels, [](const RegionLabel& label) { return label.actuator == 0; });
  return labels;
}

/// Of each dot to the nearest of another region, in dots, to within a tenth: two sweeps, with steps of 1 and √2.
std::vector<float> RegionImage::distances() const {
  constexpr float kDiagonal = 1.41421356F;
  std::vector<float> distance(region_.size(), 0.0F);
  const auto sweep = [&](std::size_t column, std::size_t row, std::ptrdiff_t direction) {
    const std::size_t i = row * width_ + column;
    if (column == 0 || row == 0 || column + 1 == width_ || row + 1 == height_) return;
    float nearest = direction > 0 ? 1e9F : distance[i];
    const auto ask = [&](std::ptrdiff_t x, std::ptrdiff_t y, float step) {
      const auto other = static_cast<std::size_t>(static_cast<std::ptrdiff_t>(i) +
                                                  direction * (y * static_cast<std::ptrdiff_t>(width_) + x));
      nearest = std::min(nearest, region_[other] == region_[i] ? distance[other] + step : step);
    };
    ask(-1, 0, 1.0F);
    ask(-1, -1, kDiagonal);
    ask(0, -1, 1.0F);
    ask(1, -1, kDiagonal);
    distance[i] = nearest;
  };
  for (std::size_t row = 0; row < height_; ++row)
    for (std::size_t column = 0; column < width_; ++column) sweep(column, row, 1);
  for (std::size_t row = height_; row-- > 0;)
    for (std::size_t column = width_; column-- > 0;) sweep(column, row, -1);
  return distance;
}

}  // namespace vestige::plot
