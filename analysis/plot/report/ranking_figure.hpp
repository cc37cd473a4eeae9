#pragma once

#include <memory>

#include "analysis/plot/canvas/figure.hpp"
#include "analysis/plot/data/report_data.hpp"

namespace vestige::plot {

/// Draws the best `most` candidates from the top, each with its headline score and 95 % interval. Candidates that
/// cannot be distinguished from the first are filled, the others hollow. `data` must outlive the figure.
std::unique_ptr<Figure> ranking_figure(const ReportData& data, std::size_t most);

}  // namespace vestige::plot
