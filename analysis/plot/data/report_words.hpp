#pragma once

#include <string>
#include <string_view>

#include "analysis/plot/data/report_data.hpp"

namespace vestige::plot {

/// "localisation_error_mm" as "localisation error"; a unit at the end is left out.
std::string words_of_name(std::string_view metric_name);

std::string sentence_case(std::string text);

/// Three significant digits, without an exponent where that is readable; U+2212 as minus.
std::string number_text(double value);

/// "12.3 mm (95 % interval 11.0 to 13.9)", "12.3 mm (one trace)", "no value".
std::string estimate_text(const Estimate& estimate, const ReportMetric& metric);

}  // namespace vestige::plot
