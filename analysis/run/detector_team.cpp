#include "analysis/run/detector_team.hpp"

#include <system_error>
#include <utility>

#include "traces/base/error.hpp"

namespace vestige {

void FrameBatch::add(const DetectorFrame& frame) {
  if (count == frames.size()) {
    frames.emplace_back();
    rows.emplace_back();
    work.emplace_back();
  }
  frames[count] = frame;
  ++count;
}

DetectorTeam::DetectorTeam(std::size_t threads, Make make)
    : make_(std::move(make)),
      first_(make_()),
      begin_(static_cast<std::ptrdiff_t>(threads)),
      end_(static_cast<std::ptrdiff_t>(threads)) {
  helpers_.reserve(threads - 1);
  try {
    for (std::size_t i = 1; i < threads; ++i) helpers_.emplace_back([this] { help(); });
  } catch (const std::system_error&) {
    // Arrives for the calling thread and for the threads that were not started. The started threads then return, since
    // there is no batch.
    static_cast<void>(begin_.arrive(static_cast<std::ptrdiff_t>(threads - helpers_.size())));
    for (std::thread& helper : helpers_) helper.join();
    throw Error("--threads", "the system cannot start more threads", "use fewer threads");
  }
  // Now every thread makes its detectors, which a batch of frames would else contain.
  FrameBatch no_frames;
  try {
    start(no_frames);
    finish();
  } catch (...) {
    dismiss();
    throw;
  }
}

DetectorTeam::~DetectorTeam() {
  if (batch_ != nullptr) {  // something failed between start and finish
    next_ = 1 + run_begins_.size();
    end_.arrive_and_wait();
  }
  dismiss();
}

void DetectorTeam::dismiss() {
  batch_ = nullptr;
  begin_.arrive_and_wait();
  for (std::thread& helper : helpers_) helper.join();
}

void DetectorTeam::detect_alone(FrameBatch& batch) {
  for (std::size_t i = 0; i < batch.count; ++i)
    batch.work[i] = first_[i % first_.size()]->detect(batch.frames[i], batch.rows[i]);
}

void DetectorTeam::start(FrameBatch& batch, std::function<void()> beside) {
  batch_ = &batch;
  beside_ = std::move(beside);
  find_runs();
  next_ = 0;
  begin_.arrive_and_wait();
}

void DetectorTeam::finish() {
  work_through(first_);
  end_.arrive_and_wait();
  batch_ = nullptr;
  if (failure_) std::rethrow_exception(std::exchange(failure_, nullptr));
}

void DetectorTeam::help() {
  PeopleDetectors detectors;
  for (begin_.arrive_and_wait(); batch_ != nullptr; begin_.arrive_and_wait()) {
    try {
      if (detectors.empty()) detectors = make_();
      work_through(detectors);
    } catch (...) {
      note_failure();
    }
    end_.arrive_and_wait();
  }
}

void DetectorTeam::work_through(const PeopleDetectors& detectors) try {
  for (std::size_t task = next_++; task <= run_begins_.size(); task = next_++) {
    if (task > 0) {
      detect_run(detectors, task - 1);
    } else if (beside_) {
      beside_();
    }
  }
} catch (...) {
  note_failure();
}

void DetectorTeam::detect_run(const PeopleDetectors& detectors, std::size_t run) {
  const std::size_t end = run + 1 < run_begins_.size() ? run_begins_[run + 1] : batch_->count;
  for (std::size_t i = run_begins_[run]; i < end; ++i)
    batch_->work[i] = detectors[i % detectors.size()]->detect(batch_->frames[i], batch_->rows[i]);
}

void DetectorTeam::find_runs() {
  run_begins_.clear();
  const auto run_of = [&](std::size_t i) { return batch_->frames[i].index / first().run_length(); };
  for (std::size_t i = 0; i < batch_->count; ++i)
    if (i == 0 || run_of(i) != run_of(i - 1)) run_begins_.push_back(i);
}

void DetectorTeam::note_failure() {
  const std::lock_guard lock(failure_mutex_);
  next_ = 1 + run_begins_.size();  // no thread needs to continue
  if (!failure_) failure_ = std::current_exception();
}

}  // namespace vestige
