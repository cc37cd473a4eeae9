#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "detector/stages.hpp"

namespace vestige::plot {

/// Microseconds of a frame, in the order of `Stage`. At least one is above 0.
struct SweepStages {
  std::array<double, kStageNames.size()> us = {};
  bool drawn_by_timer = false;  ///< the driver's timer tells drawing from waiting
};

/// One measured point of a sweep.
struct SweepPoint {
  double colliders = 0;  ///< at least 1
  double hz = 0;         ///< frames / total time, above 0
  /// The ends of the 95 % bootstrap interval of `hz`. Absent if the file does not have them.
  std::optional<double> hz_low;
  std::optional<double> hz_high;
  std::optional<SweepStages> stages = {};  ///< absent if the file does not have them
};

/// One line of the figure. It has at least one point, by rising number of colliders.
struct SweepSeries {
  std::string detector;
  std::string context;  ///< empty without OpenGL
  std::string skip;
  std::string method;
  std::string renderer;      ///< "on": measured while a renderer was drawing
  bool approximate = false;  ///< simpler shapes stand in for the avatar's skin
  double planes = 0;         ///< number of planes (render targets); 0 if the file does not have it
  double people = 1;         ///< measured at once
  bool first_only = false;   ///< only the first of them, or of several copies of them, has colliders
  std::size_t sweep = 0;     ///< index of the file
  std::vector<SweepPoint> points;
};

/// The small print about one file.
struct SweepSource {
  std::string renderer;  ///< with version and context; empty without OpenGL
  std::string machine;
  std::string avatar;
  std::string commit;
  std::string surface;  ///< "mapped": only the mapped triangles were tested
  bool complete = true;
};

struct Sweeps {
  std::vector<SweepSource> sources;
  std::vector<SweepSeries> series;
};

/// Reads sweep results into one figure. A path "DIR" stands for DIR/sweep.json. Throws `Error` with file and field.
Sweeps read_sweeps(const std::vector<std::filesystem::path>& paths);

}  // namespace vestige::plot
