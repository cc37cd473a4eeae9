#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "analysis/plot/data/report_data.hpp"

namespace vestige::plot {

/// A picture of the report.
struct PageFigure {
  std::string stem;     ///< its files' name, without extension
  std::string svg;      ///< of `svg_of`
  std::string label;    ///< what is read out instead of it
  std::string caption;  ///< below it
};

struct PageActuator {
  std::string name;
  std::size_t contacts = 0;
};

/// What the report shows of a map.
struct MapSection {
  std::string map;
  std::vector<PageActuator> actuators;
  std::size_t contacts = 0;
  std::size_t unfelt = 0;  ///< of them, on skin without an actuator
  std::vector<std::string> warnings;
  std::vector<PageFigure> bodies;     ///< pairs of front and back
  std::vector<PageFigure> errors;     ///< over time, laws side by side
  std::vector<PageFigure> timelines;  ///< the map's best law first
};

/// How much of the contacts a map leaves unfelt, for maps without pictures too.
struct UnfeltShare {
  std::string map;
  std::size_t contacts = 0;
  std::size_t unfelt = 0;
};

struct ReportPage {
  const ReportData& data;
  std::vector<PageFigure> ranking;
  std::vector<MapSection> maps;  ///< best first
  std::vector<UnfeltShare> unfelt;
  std::string shown_trace;  ///< whose timelines and errors are drawn; empty: no trace has contacts
};

/// The report: one HTML document that refers to nothing outside itself and needs no script.
std::string report_html(const ReportPage& page);

}  // namespace vestige::plot
