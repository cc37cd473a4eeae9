#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace vestige::plot {

/// How many frames of a live session took up to some time, from their arrival to one stage.
struct LatencyLine {
  std::string stage;  ///< "last byte written"
  double p50_ms = 0;
  double p99_ms = 0;
  double count = 0;
  std::vector<double> up_to_ms;  ///< rising, above 0
  std::vector<double> shares;    ///< of all frames, 0 to 1, for each of `up_to_ms`
};

struct LatencyResult {
  std::vector<LatencyLine> lines;  ///< stages without a frame are left out; there is at least one line
  double pose_delay_ms = 0;        ///< median of what poses were shown late
  double floor_ms = 0;             ///< least time between two frames to the vest
  double line_time_ms = 0;         ///< of a frame on the line; 0: there is no line
  std::string port;
  std::string machine;
  std::string commit;
};

/// Reads what 'vestige live --json FILE' wrote. Throws `Error` with file and field.
LatencyResult read_latency(const std::filesystem::path& path);

}  // namespace vestige::plot
