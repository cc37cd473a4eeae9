#pragma once

#include <string>

#include "traces/timeline/timeline.hpp"

namespace vestige {

/// Writes `time_s,actuator_1,…,actuator_n`, one row a frame.
class TimelineCsv final : public TimelineFile {
 public:
  TimelineCsv(const std::filesystem::path& path, Overwrite overwrite, std::size_t actuator_count);
  void write(const ActuatorFrame& frame) override;
  void commit() override { file_.commit(); }

 private:
  OutputFile file_;
  std::string line_;
};

}  // namespace vestige
