#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "analysis/plot/canvas/figure.hpp"

namespace vestige::plot {

/// The duty of every actuator in every frame.
struct Timeline {
  std::vector<double> time_s;               ///< rising
  std::vector<std::uint8_t> duty;           ///< frames x actuators, 0 off … 255 full
  std::size_t actuator_count = 0;           ///< at least 1
  std::vector<std::string> names;           ///< one for each actuator, or empty
  std::vector<std::uint32_t> numbers = {};  ///< one for each actuator; empty: from 1 on
};

/// Reads a file with columns `time_s,actuator_1,…,actuator_n`. Throws `Error` with file and line.
Timeline read_timeline(const std::filesystem::path& path);

/// Returns the actuators with these numbers, from 1, in this order. Precondition: they exist.
Timeline only(const Timeline& timeline, const std::vector<std::uint32_t>& numbers);

/// Draws one row for each actuator, labelled by number and name. Time runs to the right, and a darker tone is a higher
/// duty. If frames are denser than printed dots, a dot shows the highest duty within it, so that no pulse is lost.
std::unique_ptr<Figure> timeline_figure(Timeline timeline);

}  // namespace vestige::plot
