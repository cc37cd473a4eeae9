#pragma once

#include <string>
#include <string_view>

#include "analysis/plot/data/report_data.hpp"

namespace vestige::plot {

/// Returns a metric's name in words, without a unit at its end: "localisation_error_mm" becomes "localisation error".
std::string words_of_name(std::string_view metric_name);

std::string sentence_case(std::string text);

/// Returns the value with three significant digits, without an exponent where that is readable. The minus sign is
/// U+2212.
std::string number_text(double value);

/// Returns a probability as HTML: "0.012", "&lt; 0.001".
std::string p_text(double p);

/// Returns the estimate as text: "12.3 mm (95 % interval 11.0 to 13.9)", "12.3 mm (one trace)" or "no value".
std::string estimate_text(const Estimate& estimate, const ReportMetric& metric);

}  // namespace vestige::plot
