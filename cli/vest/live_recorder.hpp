#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "traces/recording/recorder.hpp"
#include "traces/recording/recording_thread.hpp"
#include "traces/scene/trace.hpp"

namespace vestige::cli {

/// Records the frames that are felt, and never stops them from being felt: if writing fails, the recording ends, and
/// that is said. It keeps what was written, as `Recorder` does.
class LiveRecorder {
 public:
  /// `tell` is called in the thread that calls the functions below. Throws `Error` as `Recorder`.
  LiveRecorder(Recorder::Target target, std::function<void(const std::string&)> tell);

  /// Records a frame. Never waits: if there is no room, the frame is left out and counted.
  void take(const TraceFrame& frame, std::vector<RecordingNote> notes);
  /// As `Recorder::snapshot`.
  void snapshot();
  /// Writes what is left, and notes that came after the last frame. Does nothing if the recording has ended before.
  void finish(std::vector<RecordingNote> notes);

  /// Whether every frame is in the recording.
  bool is_complete() const { return !failed_ && !is_full_ && left_out_ == 0; }
  nlohmann::ordered_json to_json() const;
  /// Describes the recording in a line.
  std::string describe() const;

 private:
  /// The files that hold frames.
  std::vector<std::filesystem::path> files() const;
  template <typename Work>
  void attempt(const Work& work);
  void add(RecordingNote note);
  /// Returns the notes that wait, and those of frames left out.
  std::vector<RecordingNote> waiting() const;

  std::filesystem::path path_;
  std::function<void(const std::string&)> tell_;
  std::optional<Recorder> recorder_;
  std::optional<RecordingThread> thread_;  // after the recorder, which it uses
  std::vector<RecordingNote> notes_;       ///< not recorded yet
  std::uint64_t left_out_ = 0;
  std::uint64_t left_out_noted_ = 0;
  bool failed_ = false;
  bool is_full_ = false;
};

}  // namespace vestige::cli
