#include "analysis/plot/data/report_words.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>

namespace vestige::plot {

std::string words_of_name(std::string_view metric_name) {
  constexpr std::array<std::string_view, 7> kUnits = {"_mm", "_ms", "_s", "_m2", "_hz", "_bits", "_percent"};
  for (const std::string_view unit : kUnits)
    if (metric_name.ends_with(unit)) {
      metric_name.remove_suffix(unit.size());
      break;
    }
  std::string words(metric_name);
  std::ranges::replace(words, '_', ' ');
  return words;
}

std::string sentence_case(std::string text) {
  if (!text.empty()) text.front() = static_cast<char>(std::toupper(static_cast<unsigned char>(text.front())));
  return text;
}

std::string number_text(double value) {
  if (value == 0) return "0";
  const double size = std::abs(value);
  std::string text;
  if (size >= 1e7 || size < 1e-4) {
    text = fmt::format("{:.3g}", size);
  } else {
    const int decimals = std::clamp(2 - static_cast<int>(std::floor(std::log10(size))), 0, 6);
    text = fmt::format("{:.{}f}", size, decimals);
  }
  return value < 0 ? "\u2212" + text : text;
}

std::string p_text(double p) {
  return p < 0.001 ? "&lt;\u00a00.001" : fmt::format("{:.2g}", p);
}

std::string estimate_text(const Estimate& estimate, const ReportMetric& metric) {
  if (!estimate.mean) return "no value";
  std::string text = number_text(*estimate.mean);
  if (!metric.unit.empty()) text += "\u00a0" + metric.unit;
  if (estimate.has_interval())
    return text +
           fmt::format(" (95\u00a0% interval {} to {})", number_text(*estimate.low), number_text(*estimate.high));
  return text + (estimate.traces == 1 ? " (one trace)" : "");
}

}  // namespace vestige::plot
