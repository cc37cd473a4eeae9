#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "traces/timeline/timeline.hpp"

namespace vestige {

/// Writes bHaptics' .tact for a vest: every 20 ms from the first frame on, the largest duty of each actuator in those
/// 20 ms, as 0 … 100. Actuators 1 … 20 are VestFront's 0 … 19 and 21 … 40 are VestBack's.
class TimelineTact final : public TimelineFile {
 public:
  /// 1 to 40 actuators; throws `UsageError` for more.
  TimelineTact(const std::filesystem::path& path, Overwrite overwrite, std::size_t actuator_count);
  /// Throws `Error` for a frame more than a day after the first: a gap that only fills the disk.
  void write(const ActuatorFrame& frame) override;
  void commit() override;

 private:
  void write_bin(const std::vector<std::uint8_t>& duty);

  OutputFile file_;
  std::size_t actuator_count_;
  std::optional<double> start_s_;
  std::int64_t bin_ = 0;               // being collected
  std::vector<std::uint8_t> largest_;  // in it so far
  std::vector<std::uint8_t> last_;     // frame's duties, which hold until the next
};

}  // namespace vestige
