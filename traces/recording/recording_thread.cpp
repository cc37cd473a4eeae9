#include "traces/recording/recording_thread.hpp"

#include <chrono>
#include <utility>

namespace vestige {

namespace {

/// How often the age of the open chunk is checked while no frame arrives.
constexpr std::chrono::milliseconds kPause(10);

std::size_t bytes_of(const std::vector<RecordingNote>& notes) {
  std::size_t bytes = 0;
  for (const RecordingNote& note : notes) bytes += sizeof note + note.text.size();
  return bytes;
}

std::size_t bytes_of(const TraceFrame& frame) {
  std::size_t bytes = 0;
  for (const Pose& pose : frame.poses) bytes += sizeof pose + pose.nodes.size() * sizeof pose.nodes[0];
  return bytes + sizeof frame + frame.colliders.size() * sizeof frame.colliders[0] +
         frame.teleported.size() * sizeof frame.teleported[0];
}

}  // namespace

RecordingThread::RecordingThread(Recorder& recorder, std::size_t most_bytes)
    : recorder_(recorder), most_bytes_(most_bytes), thread_([this] { run(); }) {}

RecordingThread::~RecordingThread() {
  if (!thread_.joinable()) return;
  {
    const std::lock_guard lock(mutex_);
    stopping_ = true;
  }
  work_.notify_one();
  thread_.join();
}

void RecordingThread::rethrow() {
  if (failure_) std::rethrow_exception(std::exchange(failure_, nullptr));
}

bool RecordingThread::put(TraceFrame frame, std::vector<RecordingNote> notes, WhenBehind when_behind) {
  const std::size_t bytes = bytes_of(frame) + bytes_of(notes);
  {
    std::unique_lock lock(mutex_);
    const auto has_room = [&] { return items_.empty() || waiting_bytes_ + bytes <= most_bytes_ || failed_; };
    if (when_behind == WhenBehind::kWait) {
      room_.wait(lock, has_room);
    } else if (!has_room()) {
      return false;
    }
    rethrow();
    items_.push_back({.notes = std::move(notes), .frame = std::move(frame), .has_frame = true, .bytes = bytes});
    waiting_bytes_ += bytes;
  }
  work_.notify_one();
  return true;
}

void RecordingThread::put(std::vector<RecordingNote> notes) {
  {
    const std::lock_guard lock(mutex_);
    rethrow();
    items_.push_back({.notes = std::move(notes), .frame = {}, .has_frame = false, .bytes = 0});
  }
  work_.notify_one();
}

void RecordingThread::snapshot() {
  {
    const std::lock_guard lock(mutex_);
    rethrow();
    snapshot_wanted_ = true;
  }
  work_.notify_one();
}

bool RecordingThread::is_full() {
  const std::lock_guard lock(mutex_);
  rethrow();
  return full_;
}

void RecordingThread::stop() {
  {
    const std::lock_guard lock(mutex_);
    stopping_ = true;
  }
  work_.notify_one();
  thread_.join();
  rethrow();
}

void RecordingThread::run() {
  try {
    write_all();
  } catch (...) {
    const std::lock_guard lock(mutex_);
    failure_ = std::current_exception();
    failed_ = true;
    items_.clear();
    waiting_bytes_ = 0;
  }
  room_.notify_all();
}

void RecordingThread::write_all() {
  std::unique_lock lock(mutex_);
  for (;;) {
    work_.wait_for(lock, kPause, [&] { return !items_.empty() || stopping_ || snapshot_wanted_; });
    std::deque<Item> items = std::exchange(items_, {});
    waiting_bytes_ = 0;
    const bool snapshot_now = std::exchange(snapshot_wanted_, false);
    const bool last = stopping_;
    bool full = full_;
    lock.unlock();
    room_.notify_one();
    for (Item& item : items) {
      for (RecordingNote& note : item.notes) recorder_.note(std::move(note));
      if (item.has_frame && !full) full = !recorder_.write(item.frame);
    }
    if (snapshot_now) recorder_.snapshot();
    recorder_.write_old_chunk();
    lock.lock();
    full_ = full;
    if (last && items_.empty()) return;
  }
}

}  // namespace vestige
