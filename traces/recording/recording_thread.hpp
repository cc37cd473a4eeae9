#pragma once

#include <condition_variable>
#include <cstddef>
#include <deque>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

#include "traces/recording/recorder.hpp"
#include "traces/scene/trace.hpp"

namespace vestige {

/// Writes frames on a thread of its own, so that a slow disk delays no input, and closes chunks by the clock when the
/// source stalls. What fails there is thrown by the next call here.
class RecordingThread {
 public:
  enum class WhenBehind : std::uint8_t {
    kWait,  ///< the source can wait: a file, a pipe
    kDrop,  ///< it cannot: live input
  };

  /// `recorder` must stay, and is not to be used by others until `stop`. Frames that wait take
  /// at most `most_bytes`, and those being written as much again.
  explicit RecordingThread(Recorder& recorder, std::size_t most_bytes = std::size_t{64} << 20);
  /// Writes what waits.
  ~RecordingThread();
  RecordingThread(const RecordingThread&) = delete;
  RecordingThread& operator=(const RecordingThread&) = delete;

  /// False: there is no room, and nothing was taken; only with kDrop. `notes` stand with the frame.
  bool put(TraceFrame frame, std::vector<RecordingNote> notes, WhenBehind when_behind);
  /// Notes behind the last frame.
  void put(std::vector<RecordingNote> notes);
  void snapshot();
  /// The recorder has written all it may (`RecordingLimits::max_bytes`).
  bool is_full();
  /// Writes what waits, and ends the thread. Throws `Error` if writing failed.
  void stop();

 private:
  struct Item {
    std::vector<RecordingNote> notes;
    TraceFrame frame;
    bool has_frame = true;
    std::size_t bytes = 0;
  };

  void run();
  void write_all();
  void rethrow();

  Recorder& recorder_;
  std::size_t most_bytes_;
  std::mutex mutex_;
  std::condition_variable work_;
  std::condition_variable room_;
  std::deque<Item> items_;
  std::size_t waiting_bytes_ = 0;
  bool snapshot_wanted_ = false;
  bool stopping_ = false;
  bool full_ = false;
  bool failed_ = false;
  std::exception_ptr failure_;
  std::thread thread_;  ///< last: it uses all the others
};

}  // namespace vestige
