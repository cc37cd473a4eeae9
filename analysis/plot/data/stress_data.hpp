#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace vestige::plot {

/// How one detector answered one family at one magnitude.
struct StressCell {
  std::string detector;
  std::string method;
  double cases = 0;  ///< at least 1
  double missed = 0;
  double false_contacts = 0;
  double elsewhere = 0;  ///< on another triangle, or on another actuator
  /// The 95 % Wilson interval of `error_rate`, 0 … 1. Absent if the file does not have it.
  std::optional<double> low;
  std::optional<double> high;

  double error_rate() const { return (missed + false_contacts + elsewhere) / cases; }
};

/// A family at one magnitude, and the answers of all detectors to it.
struct StressLine {
  std::string name;
  std::string variant;
  double magnitude = 0;
  std::vector<StressCell> cells;
};

struct StressResult {
  std::vector<StressLine> lines;  ///< as in the file, at least one
  std::string machine;            ///< empty without a run.json
  std::string renderer;
  std::string commit;
};

/// Reads DIR/stress.json, and DIR/run.json if it exists. Throws `Error` with file and field.
StressResult read_stress(const std::filesystem::path& folder);

}  // namespace vestige::plot
