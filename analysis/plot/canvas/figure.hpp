#pragma once

#include <string>

#include "analysis/plot/canvas/canvas.hpp"

namespace vestige::plot {

/// A drawing that is the same in every file format.
class Figure {
 public:
  virtual ~Figure() = default;
  virtual double width_pt() const = 0;
  virtual double height_pt() const = 0;
  /// Returns one sentence for readers who cannot see the picture.
  virtual std::string description() const = 0;
  virtual void draw(Canvas& canvas) const = 0;
};

}  // namespace vestige::plot
