#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "analysis/plot/data/report_data.hpp"

namespace vestige::plot {

/// A picture of the report.
struct PageFigure {
  std::string stem;     ///< name of its files, without extension
  std::string svg;      ///< made by `svg_of`
  std::string label;    ///< read out by screen readers instead of the picture
  std::string caption;  ///< shown below the picture
};

struct PageActuator {
  std::string name;
  std::size_t contacts = 0;
};

/// A page of 'vestige view' that shows a map on the trace that tells most about it.
struct MapView {
  std::string file;  ///< beside the report, with '/'; empty: there is no page
  std::string trace;
  std::optional<double> value;         ///< of the headline
  std::vector<std::string> not_there;  ///< traces that would tell more, but whose files are gone or have changed
  std::string problem = {};            ///< why there is no page; empty: no trace is there
};

/// The part of the report about one map.
struct MapSection {
  std::string map;
  std::vector<PageActuator> actuators;
  std::size_t contacts = 0;
  std::size_t unmapped = 0;  ///< contacts on skin without an actuator
  std::vector<std::string> warnings;
  std::optional<MapView> view;
  std::vector<PageFigure> bodies;     ///< pairs of front and back views
  std::vector<PageFigure> errors;     ///< errors over time, laws side by side
  std::vector<PageFigure> timelines;  ///< the map's best law first
};

struct ReportPage {
  const ReportData& data;
  std::vector<PageFigure> ranking;
  std::vector<MapSection> maps;  ///< best first
  /// The trace whose timelines and errors are drawn. Empty: no trace has contacts.
  std::string shown_trace;
};

/// Returns the report: one HTML document that needs nothing outside itself and no script. It refers to the pages of
/// `MapView` alone.
std::string report_html(const ReportPage& page);

}  // namespace vestige::plot
