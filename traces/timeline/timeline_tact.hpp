#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "traces/timeline/timeline.hpp"

namespace vestige {

/// Writes bHaptics' .tact file for a vest. Every 20 ms from the first frame on, it holds the largest duty of each
/// actuator in those 20 ms, as 0 … 100. Actuators 1 … 20 are VestFront's 0 … 19, and actuators 21 … 40 are VestBack's 0
/// … 19.
class TimelineTact final : public TimelineFile {
 public:
  /// Precondition: at least one actuator. Throws `UsageError` if there are more than 40.
  TimelineTact(const std::filesystem::path& path, Overwrite overwrite, std::size_t actuator_count);
  /// Throws `Error` if the frame is more than a day after the first, since such a gap would only fill the disk.
  void write(const ActuatorFrame& frame) override;
  void commit() override;

 private:
  void write_bin(const std::vector<std::uint8_t>& duty);

  OutputFile file_;
  std::size_t actuator_count_;
  std::optional<double> start_s_;
  std::int64_t bin_ = 0;               // index of the 20 ms bin being collected
  std::vector<std::uint8_t> largest_;  // largest duties in that bin so far
  std::vector<std::uint8_t> last_;     // duties of the last frame, which hold until the next
};

}  // namespace vestige
