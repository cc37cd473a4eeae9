#include "traces/timeline/timeline_csv.hpp"

#include <fmt/format.h>

#include <iterator>

namespace vestige {

TimelineCsv::TimelineCsv(const std::filesystem::path& path, Overwrite overwrite, std::size_t actuator_count)
    : file_(path, overwrite) {
  line_ = "time_s";
  for (std::size_t i = 1; i <= actuator_count; ++i) fmt::format_to(std::back_inserter(line_), ",actuator_{}", i);
  line_ += '\n';
  file_.write(line_);
}

void TimelineCsv::write(const ActuatorFrame& frame) {
  line_.clear();
  fmt::format_to(std::back_inserter(line_), "{}", frame.time_s);
  for (const std::uint8_t duty : frame.duty) fmt::format_to(std::back_inserter(line_), ",{}", duty);
  line_ += '\n';
  file_.write(line_);
}

}  // namespace vestige
