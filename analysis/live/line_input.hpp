#pragma once

#include <cstddef>
#include <cstdint>
#include <set>
#include <string>
#include <vector>

#include "analysis/live/live_input.hpp"
#include "traces/live/live_ndjson.hpp"
#include "traces/scene/avatar.hpp"
#include "traces/scene/trace.hpp"

namespace vestige {

/// Input by lines of JSON on a descriptor. Each line is a whole frame of one person, with its pose, which is shown as
/// it is: whatever a line says, the way from the line before is a motion, unless colliders are `teleported`. The time
/// of a frame is that of its line's arrival, whatever `time_s` it says.
class LineInput final : public LiveInput {
 public:
  LineInput(const Avatar& avatar, int descriptor);

  std::vector<int> descriptors() const override { return {descriptor_}; }
  void receive() override;
  std::uint64_t frames() const override { return frames_; }
  bool has_begun() const override { return frames_ > 0; }
  bool has_ended() const override { return has_ended_; }
  Clock::time_point arrived() const override { return arrived_; }
  void show(Clock::time_point time, LiveFrame& out) override;
  std::uint64_t superseded() const override { return superseded_; }
  std::vector<RecordingNote> take_markers() override { return {}; }
  std::vector<std::string> take_problems() override;
  LiveLosses losses() const override;

 private:
  void take(TraceFrame frame);

  LiveNdjson lines_;
  int descriptor_;
  Clock::time_point start_ = Clock::now();
  Clock::time_point arrived_;
  std::string buffer_;
  TraceFrame newest_;
  std::set<std::uint32_t> teleported_;  ///< not shown yet
  std::uint64_t frames_ = 0;
  std::uint64_t frames_shown_ = 0;
  std::uint64_t superseded_ = 0;
  bool has_ended_ = false;
  std::size_t problems_told_ = 0;
};

}  // namespace vestige
