#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "traces/output_file.hpp"

namespace vestige {

/// What the vest is told at one instant: the same for files and for the wire. Absolute state, never a change.
struct ActuatorFrame {
  double time_s = 0;
  std::vector<std::uint8_t> duty;  ///< 0 off … 255 full, one for each actuator
};

/// Writes `time_s,actuator_1,…,actuator_n`, one row a frame.
class TimelineCsv {
 public:
  TimelineCsv(const std::filesystem::path& path, Overwrite overwrite, std::size_t actuator_count);
  void write(const ActuatorFrame& frame);
  void commit() { file_.commit(); }

 private:
  OutputFile file_;
  std::string line_;
};

}  // namespace vestige
