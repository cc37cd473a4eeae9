#pragma once

#include <memory>
#include <string>
#include <vector>

#include "analysis/plot/canvas/figure.hpp"

namespace vestige::plot {

/// How far from where it is each contact of a trace is felt, under one law.
struct ErrorSeries {
  std::string law;
  std::vector<double> time_s;   ///< of each contact, ascending
  std::vector<float> error_mm;  ///< NaN: not felt
};

/// Laws side by side on the same axes: a dot for each contact, the running median over it, and below, where time has
/// contacts that are not felt. `series`: at least one; all of one trace.
std::unique_ptr<Figure> error_figure(std::vector<ErrorSeries> series, double begin_s, double end_s);

}  // namespace vestige::plot
