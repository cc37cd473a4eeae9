#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "traces/timeline/timeline.hpp"

namespace vestige {

/// Writes MPEG haptics as JSON (ISO/IEC 23090-31:2023, profile "Simple Parametric", level 1): one vibrotactile
/// perception with a channel for each actuator, in each one linear curve of amplitudes duty / 255.
///
/// Time is whole milliseconds since the first frame, and every curve lasts until the last frame. A duty's step is two
/// keyframes a millisecond apart, so at each frame's millisecond the curve is exactly that frame's duty. Of frames
/// within one millisecond the largest duty counts. In memory until `commit`: keyframes grow with changes, not frames.
class TimelineHjif final : public TimelineFile {
 public:
  /// At least one actuator: the format has no perception without a channel.
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
  std::int64_t time_ms_ = 0;        // of the last frame
  std::vector<std::uint8_t> duty_;  // in that millisecond
};

}  // namespace vestige
