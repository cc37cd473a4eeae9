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

/// Frames that are detected together, and their results. Memory is reused. In a trace of several people, each of its
/// frames is one for the first person, then one for the second, and so on.
struct FrameBatch {
  std::vector<DetectorFrame> frames;  ///< only the first `count` are valid
  std::vector<ContactRow> rows;
  std::vector<DetectorWork> work;
  std::size_t count = 0;

  void clear() { count = 0; }
  void add(const DetectorFrame& frame);
};

/// The detectors of a trace's people, in their order: one for each person.
using PeopleDetectors = std::vector<std::unique_ptr<Detector>>;

/// A team of equal detectors: in each thread, one for each person. Each thread makes and uses its own. A free thread
/// takes the next run of a batch (`Detector::run_length`). The rows are in the order of the frames, so the number of
/// threads does not change a bit of the result.
class DetectorTeam {
 public:
  using Make = std::function<PeopleDetectors()>;  ///< called by several threads at a time

  /// Makes all detectors: the first for the calling thread. Throws what `make` threw. `threads` is at least 1 and
  /// includes the calling thread.
  DetectorTeam(std::size_t threads, Make make);
  ~DetectorTeam();
  DetectorTeam(const DetectorTeam&) = delete;
  DetectorTeam& operator=(const DetectorTeam&) = delete;

  /// The first thread's detector of a person, who counts from 0.
  Detector& first(std::size_t person = 0) { return *first_[person]; }
  const Detector& first(std::size_t person = 0) const { return *first_[person]; }
  std::size_t threads() const { return helpers_.size() + 1; }

  /// Detects in the calling thread, frame by frame.
  void detect_alone(FrameBatch& batch);
  /// Starts the other threads on `batch`, and the first free one on `beside`, if that is not empty. The batch must stay
  /// untouched until `finish` has returned.
  void start(FrameBatch& batch, std::function<void()> beside = {});
  /// Lets the calling thread help, and waits for the last frame. Throws what a detector or `beside` threw.
  void finish();

 private:
  void help();
  /// Lets the helpers return. Precondition: no batch is under way.
  void dismiss();
  void work_through(const PeopleDetectors& detectors);
  void detect_run(const PeopleDetectors& detectors, std::size_t run);
  void find_runs();
  void note_failure();

  Make make_;
  PeopleDetectors first_;
  /// Null except between `start` and `finish`. To begin with null tells the helpers to return.
  FrameBatch* batch_ = nullptr;
  std::function<void()> beside_;
  std::vector<std::size_t> run_begins_;  ///< of `batch_`, by the numbers of frames in it
  std::atomic<std::size_t> next_ = 0;    ///< 0: `beside_`; then 1 + number of a run
  std::mutex failure_mutex_;
  std::exception_ptr failure_;
  std::barrier<> begin_;
  std::barrier<> end_;
  std::vector<std::thread> helpers_;
};

}  // namespace vestige
