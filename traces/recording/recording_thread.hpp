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

/// Writes frames on a thread of its own, so that a slow disk does not delay input. Also closes chunks by the clock if
/// the source stalls. An exception on that thread is thrown by the next call of a function here.
class RecordingThread {
 public:
  enum class WhenBehind : std::uint8_t {
    kWait,  ///< for a source that can wait: a file, a pipe
    kDrop,  ///< for a source that cannot wait: live input
  };

  /// Keeps a reference to `recorder`, which others must not use until `stop`. Waiting frames take at most `most_bytes`,
  /// and frames being written take at most as much again.
  explicit RecordingThread(Recorder& recorder, std::size_t most_bytes = std::size_t{64} << 20);
  /// Writes the waiting frames.
  ~RecordingThread();
  RecordingThread(const RecordingThread&) = delete;
  RecordingThread& operator=(const RecordingThread&) = delete;

  /// Queues a frame with its `notes`. With kDrop, returns false without taking anything if there is no room. With
  /// kWait, waits for room.
  bool put(TraceFrame frame, std::vector<RecordingNote> notes, WhenBehind when_behind);
  /// Queues notes that follow the last frame.
  void put(std::vector<RecordingNote> notes);
  void snapshot();
  /// Whether the recorder accepts no more frames (`RecordingLimits::max_bytes`).
  bool is_full();
  /// Writes the waiting frames and ends the thread. Throws `Error` if writing failed.
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
  std::thread thread_;  ///< declared last, because it uses all other members
};

}  // namespace vestige
