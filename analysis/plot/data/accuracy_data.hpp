#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace vestige::plot {

/// A value, above or equal to 0, and its 95 % interval. The interval may be missing: then both ends are the value.
struct ValueRange {
  double value = 0;
  double low = 0;
  double high = 0;
};

/// One detector with one method at one rate of the trace. Errors are events for 100 true ones, within the tolerance.
struct AccuracyPoint {
  double rate_hz = 0;  ///< above 0
  ValueRange load_ms;  ///< processor time for a second of the scene, above 0
  ValueRange wrong;    ///< all three kinds
  ValueRange missed;
  ValueRange false_events;
  ValueRange wrong_actuator;
  bool on_front = false;  ///< no other point has both less load and fewer errors
};

/// Has at least one point. Points are by rising rate.
struct AccuracySeries {
  std::string detector;
  std::string method;
  bool approximate = false;
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
  double tolerance_ms = 0;
  double keep = 1;  ///< share of the triangles that `decimated` was to keep, 0 … 1
  std::string animation;
  std::string avatar;
  std::string renderer;  ///< empty without OpenGL
  std::string machine;
  std::string commit;
};

/// Reads accuracy.json and run.json of a folder. Throws `Error` with file and field.
AccuracyResult read_accuracy(const std::filesystem::path& folder);

}  // namespace vestige::plot
