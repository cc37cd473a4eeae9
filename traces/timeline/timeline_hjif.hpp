#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "traces/timeline/timeline.hpp"

namespace vestige {

/// Writes MPEG haptics as JSON (ISO/IEC 23090-31:2023, profile "Simple Parametric", level 1). The file has one
/// vibrotactile perception with one channel for each actuator. Each channel has one linear curve of amplitudes duty /
/// 255.
///
/// Times are whole milliseconds since the first frame, and every curve lasts until the last frame. A step of a duty is
/// two keyframes one millisecond apart, so at each frame's millisecond the curve equals that frame's duty. Of several
/// frames within one millisecond, the largest duty counts. All keyframes stay in memory until `commit`; their number
/// grows with changes, not with frames.
class TimelineHjif final : public TimelineFile {
 public:
  /// Precondition: at least one actuator, because the format has no perception without a channel.
  TimelineHjif(const std::filesystem::path& path, Overwrite overwrite, std::vector<std::string> actuator_names);
  void write(const ActuatorFrame& frame) override;
  void commit() override;

 private:
  struct Keyframe {
    std::int64_t time_ms;
    std::uint8_t duty;
  };

  void add_keyframes();

  OutputFile file_;
  std::vector<std::string> actuator_names_;
  std::vector<std::vector<Keyframe>> curves_;  // one for each actuator
  std::optional<double> start_s_;
  std::int64_t time_ms_ = 0;        // time of the last frame
  std::vector<std::uint8_t> duty_;  // largest duties in that millisecond
};

}  // namespace vestige
