#pragma once

#include <memory>
#include <string>
#include <vector>

#include "analysis/plot/canvas/figure.hpp"

namespace vestige::plot {

/// The distance between where each contact of a trace is and where it is felt, under one law.
struct ErrorSeries {
  std::string law;
  std::vector<double> time_s;   ///< time of each contact, ascending
  std::vector<float> error_mm;  ///< NaN: not felt
};

/// Draws laws side by side on the same axes. Each contact is a dot, with the running median over the dots. Below, a
/// strip shows when contacts are not felt. `series` has at least one entry, and all entries are of one trace.
std::unique_ptr<Figure> error_figure(std::vector<ErrorSeries> series, double begin_s, double end_s);

}  // namespace vestige::plot
