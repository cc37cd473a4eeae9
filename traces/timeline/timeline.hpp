#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "traces/files/output_file.hpp"

namespace vestige {

/// The actuators' duty cycles at one instant, the same for files and for the wire. Absolute state, never a change.
struct ActuatorFrame {
  double time_s = 0;
  std::vector<std::uint8_t> duty;  ///< 0 off … 255 full, one for each actuator
};

/// A file of duty cycles over time. The file is complete or absent: without `commit` it leaves nothing behind.
class TimelineFile {
 public:
  TimelineFile() = default;
  virtual ~TimelineFile() = default;
  TimelineFile(const TimelineFile&) = delete;
  TimelineFile& operator=(const TimelineFile&) = delete;

  /// Adds a frame, which holds until the next one. Times must not decrease. Each frame has a duty for every actuator.
  virtual void write(const ActuatorFrame& frame) = 0;
  virtual void commit() = 0;
};

/// Opens the kind of file that the extension asks for: .csv, .hjif or .tact. "-", devices and pipes are CSV. Throws
/// `UsageError` if the extension is another one, or the format cannot hold the actuators. Throws `Error` as
/// `OutputFile` does.
std::unique_ptr<TimelineFile> make_timeline(const std::filesystem::path& path, Overwrite overwrite,
                                            const std::vector<std::string>& actuator_names);

}  // namespace vestige
