#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace vestige::plot {

/// One detector with one method at one rate of the trace.
struct AccuracyPoint {
  double rate_hz = 0;  ///< above 0
  /// Median run time of a frame times the rate: seconds for a second of motion. Above 0.
  double load = 0;
  double missed_share = 0;  ///< share of the true contact events, 0 … 1
};

/// Has at least one point. Points are by rising rate.
struct AccuracySeries {
  std::string detector;
  std::string method;
  std::vector<AccuracyPoint> points;
};

/// One scene.
struct AccuracyPanel {
  std::string colliders;
  double collider_count = 0;
  double true_events = 0;
  std::vector<AccuracySeries> series;
};

struct AccuracyResult {
  std::vector<AccuracyPanel> panels;  ///< all have the same series in the same order
  double truth_rate_hz = 0;
  std::string animation;
  std::string avatar;
  std::string renderer;  ///< empty without OpenGL
  std::string machine;
  std::string commit;
};

/// Reads accuracy.json and run.json of a folder. Throws `Error` with file and field.
AccuracyResult read_accuracy(const std::filesystem::path& folder);

}  // namespace vestige::plot
