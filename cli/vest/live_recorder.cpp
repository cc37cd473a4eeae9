#include "cli/vest/live_recorder.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <exception>
#include <utility>

#include "traces/base/number_text.hpp"

namespace vestige::cli {

namespace {

constexpr std::size_t kMostNotes = 10'000;  ///< that wait while the disk does not keep up

}  // namespace

LiveRecorder::LiveRecorder(Recorder::Target target, std::function<void(const std::string&)> tell)
    : path_(target.path), tell_(std::move(tell)) {
  recorder_.emplace(std::move(target));
  thread_.emplace(*recorder_);
}

template <typename Work>
void LiveRecorder::attempt(const Work& work) {
  if (!thread_) return;
  try {
    work();
  } catch (const std::exception& error) {
    failed_ = true;
    thread_.reset();  // ends the recording
    tell_(fmt::format("{}\n  The recording has ended; what is felt goes on.", error.what()));
  }
}

void LiveRecorder::take(const TraceFrame& frame, std::vector<RecordingNote> notes) {
  if (is_full_) return;
  attempt([&] {
    is_full_ = thread_->is_full();
    if (is_full_) {
      tell_(fmt::format("{}: the recording has ended, by --max-size; what is felt goes on", path_.string()));
      return;
    }
    for (RecordingNote& note : notes) add(std::move(note));
    if (thread_->put(frame, waiting(), RecordingThread::WhenBehind::kDrop)) {
      notes_.clear();
      left_out_noted_ = left_out_;
      return;
    }
    if (left_out_++ == 0) tell_(fmt::format("{}: the disk does not keep up; frames are left out", path_.string()));
  });
}

std::vector<RecordingNote> LiveRecorder::waiting() const {
  std::vector<RecordingNote> all = notes_;
  if (const std::uint64_t lost = left_out_ - left_out_noted_; lost > 0)
    for (const char* topic : {"/pose", "/colliders"})
      all.push_back({.kind = RecordingNote::Kind::kDropped, .count = lost, .text = topic});
  return all;
}

/// Counts of one topic are added up, so that a disk that does not keep up costs no memory.
void LiveRecorder::add(RecordingNote note) {
  const auto before = std::ranges::find_if(notes_, [&](const RecordingNote& other) {
    return note.kind != RecordingNote::Kind::kMarker && other.kind == note.kind && other.text == note.text;
  });
  if (before != notes_.end()) {
    before->count += note.count;
  } else if (notes_.size() < kMostNotes) {
    notes_.push_back(std::move(note));
  }
}

void LiveRecorder::snapshot() {
  attempt([&] { thread_->snapshot(); });
}

void LiveRecorder::finish(std::vector<RecordingNote> notes) {
  attempt([&] {
    for (RecordingNote& note : notes) add(std::move(note));
    if (!is_full_) thread_->put(waiting());
    thread_->stop();
    is_full_ = recorder_->is_full();
    recorder_->finish();
    thread_.reset();
  });
}

nlohmann::ordered_json LiveRecorder::to_json() const {
  return {{"files", files()},
          {"frames", recorder_->frame_count()},
          {"bytes", recorder_->bytes_written()},
          {"left_out", left_out_},
          {"complete", is_complete()}};
}

std::vector<std::filesystem::path> LiveRecorder::files() const {
  return recorder_->frame_count() > 0 ? recorder_->files() : std::vector<std::filesystem::path>();
}

std::string LiveRecorder::describe() const {
  const std::vector<std::filesystem::path> written = files();
  if (written.empty()) return fmt::format("{}: nothing was recorded\n", path_.string());
  std::string names = written.front().string();
  if (written.size() > 1) names += " to " + written.back().string();
  return fmt::format("{}: {}, {:.1f} MB{}\n", names, counted(recorder_->frame_count(), "frame"),
                     static_cast<double>(recorder_->bytes_written()) / 1e6,
                     is_complete() ? "" : "; not all that was felt is recorded");
}

}  // namespace vestige::cli
