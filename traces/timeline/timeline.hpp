#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "traces/files/output_file.hpp"

namespace vestige {

/// What the vest is told at one instant: the same for files and for the wire. Absolute state, never a change.
struct ActuatorFrame {
  double time_s = 0;
  std::vector<std::uint8_t> duty;  ///< 0 off … 255 full, one for each actuator
};

/// A file of duties over time. Complete or absent: without `commit` it leaves nothing behind.
class TimelineFile {
 public:
  TimelineFile() = default;
  virtual ~TimelineFile() = default;
  TimelineFile(const TimelineFile&) = delete;
  TimelineFile& operator=(const TimelineFile&) = delete;

  /// A frame holds until the next one. Times must not decrease; each frame has a duty for every actuator.
  virtual void write(const ActuatorFrame& frame) = 0;
  virtual void commit() = 0;
};

/// Opens the kind of file that the name's end asks for: .csv (also "-", and what is no regular file: a device, a pipe),
/// .hjif or .tact. Throws `UsageError` for any other end, and for actuators that the format cannot hold; `Error` as
/// `OutputFile` does.
std::unique_ptr<TimelineFile> make_timeline(const std::filesystem::path& path, Overwrite overwrite,
                                            const std::vector<std::string>& actuator_names);

}  // namespace vestige
