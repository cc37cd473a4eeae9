#include "traces/timeline/timeline.hpp"

#include <fmt/format.h>

#include "traces/timeline/timeline_csv.hpp"
#include "traces/timeline/timeline_hjif.hpp"
#include "traces/timeline/timeline_tact.hpp"

namespace vestige {

std::unique_ptr<TimelineFile> make_timeline(const std::filesystem::path& path, Overwrite overwrite,
                                            const std::vector<std::string>& actuator_names) {
  const std::string end = path.extension().string();
  std::error_code ignored;
  const auto status = std::filesystem::status(path, ignored);
  const bool is_device = std::filesystem::exists(status) && !std::filesystem::is_regular_file(status) &&
                         !std::filesystem::is_directory(status);
  if (path == "-" || end == ".csv" || is_device)
    return std::make_unique<TimelineCsv>(path, overwrite, actuator_names.size());
  if (end != ".hjif" && end != ".tact")
    throw UsageError(path.string(), "the end of the name must show the kind of timeline",
                     "name it .csv (one row per frame), .hjif (MPEG haptics) or .tact (bHaptics)");
  if (actuator_names.empty())
    throw UsageError(path.string(), fmt::format("there is no actuator, but a {} file needs one", end),
                     "give the trace an actuator map with 'vestige record --map', or write a .csv");
  if (end == ".hjif") return std::make_unique<TimelineHjif>(path, overwrite, actuator_names);
  return std::make_unique<TimelineTact>(path, overwrite, actuator_names.size());
}

}  // namespace vestige
