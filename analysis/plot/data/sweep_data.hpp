#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace vestige::plot {

/// One measured point of a sweep.
struct SweepPoint {
  double colliders = 0;  ///< at least 1
  double hz = 0;         ///< frames / total time, above 0
  /// Both ends of the 95 % bootstrap interval of `hz`; absent in files that hold none.
  std::optional<double> hz_low;
  std::optional<double> hz_high;
};

/// One line of the figure; points by rising number of colliders, at least one.
struct SweepSeries {
  std::string detector;
  std::string context;  ///< empty without OpenGL
  std::string skip;
  std::string method;
  std::string renderer;   ///< "on": measured beside one
  std::size_t sweep = 0;  ///< which file it came from
  std::vector<SweepPoint> points;
};

/// What the small print says about one file.
struct SweepSource {
  std::string renderer;  ///< with version and context, empty without OpenGL
  std::string machine;
  std::string avatar;
  std::string commit;
  std::string surface;  ///< "mapped": of the mapped triangles only
  bool complete = true;
};

struct Sweeps {
  std::vector<SweepSource> sources;
  std::vector<SweepSeries> series;
};

/// Reads sweep results ("DIR" stands for DIR/sweep.json) into one figure. Throws `Error` naming file and field.
Sweeps read_sweeps(const std::vector<std::filesystem::path>& paths);

}  // namespace vestige::plot
