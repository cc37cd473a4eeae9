#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "traces/files/output_file.hpp"
#include "transport/sender.hpp"

namespace vestige::cli {

/// Writes what became of each changed state: `time_s,state,written_us,actuator_1,…`.
class StreamLog {
 public:
  StreamLog(const std::string& path, Overwrite overwrite, std::size_t actuator_count);
  void write(const std::vector<SentState>& states);
  void commit() { file_.commit(); }

 private:
  OutputFile file_;
};

}  // namespace vestige::cli
