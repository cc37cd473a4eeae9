#pragma once

#include <atomic>
#include <barrier>
#include <cstddef>
#include <exception>
#include <functional>
#include <memory>
#include <mutex>
#include <thread>
#include <vector>

#include "detector/detector.hpp"

namespace vestige {

/// Frames that are detected together, and what came of them. Memory is used again.
struct FrameBatch {
  std::vector<Frame> frames;  ///< the first `count` of them mean something
  std::vector<ContactRow> rows;
  std::vector<DetectorWork> work;
  std::size_t count = 0;

  void clear() { count = 0; }
  void add(const Frame& frame);
};

/// One detector for each thread, all alike: each is made and used by its own thread. Frames of a batch go to whichever
/// thread is free; rows stand in the frames' order, so that their number changes no bit of the result.
class DetectorTeam {
 public:
  using Make = std::function<std::unique_ptr<Detector>()>;  ///< is called by several threads at a time

  /// Makes the first detector, for the calling thread; the others are made while the first batch is under way.
  /// `threads`: at least 1, the calling one included.
  DetectorTeam(std::size_t threads, Make make);
  ~DetectorTeam();
  DetectorTeam(const DetectorTeam&) = delete;
  DetectorTeam& operator=(const DetectorTeam&) = delete;

  Detector& first() { return *first_; }
  const Detector& first() const { return *first_; }
  std::size_t threads() const { return helpers_.size() + 1; }

  /// The other threads begin with `batch`, which must stay untouched until `finish` has returned.
  void start(FrameBatch& batch);
  /// The calling thread helps, and waits for the last frame. Throws what a detector threw.
  void finish();

 private:
  void help();
  void work_through(Detector& detector);
  void note_failure();

  Make make_;
  std::unique_ptr<Detector> first_;
  FrameBatch* batch_ = nullptr;  ///< null but between start and finish; so to begin tells the helpers to go home
  std::atomic<std::size_t> next_ = 0;
  std::mutex failure_mutex_;
  std::exception_ptr failure_;
  std::barrier<> begin_;
  std::barrier<> end_;
  std::vector<std::thread> helpers_;
};

}  // namespace vestige
