#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "analysis/plot/canvas/figure.hpp"

namespace vestige::plot {

/// What every actuator was told, frame by frame.
struct Timeline {
  std::vector<double> time_s;      ///< rising
  std::vector<std::uint8_t> duty;  ///< frames x actuators, 0 off … 255 full
  std::size_t actuator_count = 0;  ///< at least 1
  std::vector<std::string> names;  ///< one for each actuator, or none
};

/// Reads `time_s,actuator_1,…,actuator_n`. Throws `Error` naming file and line.
Timeline read_timeline(const std::filesystem::path& path);

/// One row for each actuator, by its number and name, time to the right, duty as darkness. Where frames are denser than
/// printed dots, a dot shows the highest duty within it, so that no pulse is lost.
std::unique_ptr<Figure> timeline_figure(Timeline timeline);

}  // namespace vestige::plot
