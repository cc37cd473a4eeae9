#include "traces/recording/recorder.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <future>
#include <limits>
#include <utility>

#include "traces/base/error.hpp"
#include "traces/base/nanoseconds.hpp"
#include "traces/mcap/byte_source.hpp"
#include "traces/mcap/decode.hpp"
#include "traces/mcap/record_walker.hpp"
#include "traces/mcap/summary.hpp"
#include "traces/trace_file/trace_format.hpp"

namespace vestige {

namespace {

constexpr double kLatest_ns = 9.2e18;  ///< just below the largest 63-bit number

void note_in(TraceWriter& writer, const RecordingNote& note) {
  switch (note.kind) {
    case RecordingNote::Kind::kDropped:
      writer.note_dropped(note.text, note.count);
      break;
    case RecordingNote::Kind::kSuperseded:
      writer.note_superseded(note.count);
      break;
    case RecordingNote::Kind::kMarker:
      writer.note_marker(note.text);
      break;
  }
}

Error too_small(const std::filesystem::path& path, std::uint64_t limit, std::uint64_t needed) {
  return Error(
      path.string(),
      fmt::format("{} bytes a file (--max-size, --split) are too few: with avatar and map, one frame takes up to {}",
                  limit, needed),
      "allow more bytes");
}

/// Whether the file is a trace, judged by its Header.
bool is_trace(const std::filesystem::path& path) {
  if (!std::filesystem::is_regular_file(path)) return false;
  try {
    const mcap::FileSource source(path);
    mcap::require_mcap(source);
    mcap::RawBuffer buffer;
    const mcap::Bytes header =
        mcap::read_record_at(source, mcap::kMagicBytes, mcap::Opcode::kHeader, source.size(), buffer);
    return mcap::decode_header(header).profile == trace_format::kProfile;
  } catch (const std::exception&) {
    return false;
  }
}

}  // namespace

std::filesystem::path part_path(const std::filesystem::path& path, std::uint64_t number) {
  std::filesystem::path part = path;
  part.replace_filename(fmt::format("{}-{:04}{}", path.stem().string(), number, path.extension().string()));
  return part;
}

bool is_part_path(const std::filesystem::path& path, const std::filesystem::path& candidate) {
  const std::string stem = path.stem().string() + "-";
  const std::string part = candidate.stem().string();
  if (!part.starts_with(stem) || candidate.extension() != path.extension()) return false;
  const std::string_view number = std::string_view(part).substr(stem.size());
  return number.size() >= 4 &&
         std::all_of(number.begin(), number.end(), [](char letter) { return letter >= '0' && letter <= '9'; });
}

std::vector<std::filesystem::path> existing_parts(const std::filesystem::path& path) {
  const std::filesystem::path folder = path.has_parent_path() ? path.parent_path() : std::filesystem::path(".");
  std::vector<std::filesystem::path> parts;
  std::error_code none;
  for (const auto& entry : std::filesystem::directory_iterator(folder, none))
    if (is_part_path(path, entry.path())) parts.push_back(path.parent_path() / entry.path().filename());
  std::sort(parts.begin(), parts.end());
  return parts;
}

class Recorder::Implementation {
 public:
  explicit Implementation(Target target);
  ~Implementation();
  Implementation(const Implementation&) = delete;
  Implementation& operator=(const Implementation&) = delete;

  bool write(const TraceFrame& frame);
  void note(RecordingNote note);
  void write_old_chunk();
  void snapshot();
  void finish();
  bool is_full() const { return full_; }
  bool is_ring_cut_by_size() const { return ring_ && ring_->is_cut_by_size(); }
  std::uint64_t frame_count() const { return finished_frames_ + (writer_ ? writer_->frame_count() : 0); }
  std::uint64_t bytes_written() const { return finished_bytes_ + (writer_ ? writer_->bytes_written() : 0); }
  const std::vector<std::filesystem::path>& files() const { return files_; }
  const std::vector<std::filesystem::path>& removed() const { return removed_; }

 private:
  std::unique_ptr<TraceWriter> open(const std::filesystem::path& path) const;
  void open_next();
  void finish_writer();
  bool has_room_for(const TraceFrame& frame);
  bool is_beyond_part(const TraceFrame& frame) const;
  std::optional<std::uint64_t> most_bytes() const;
  void write_ring();
  void await_snapshot();
  void replace_stale_parts();

  Target target_;
  std::unique_ptr<TraceWriter> writer_;
  std::optional<FrameRing> ring_;
  std::future<void> snapshot_;
  std::vector<std::filesystem::path> files_;
  std::vector<std::filesystem::path> stale_;  ///< parts of an earlier recording
  std::vector<std::filesystem::path> removed_;
  std::uint64_t finished_frames_ = 0;
  std::uint64_t finished_bytes_ = 0;
  std::uint64_t parts_ = 0;  ///< parts begun, or snapshots
  std::optional<std::int64_t> first_ns_;
  std::int64_t split_ns_ = 0;  ///< end time of the current part
  bool has_frame_ = false;     ///< whether the ring has a frame
  bool full_ = false;
  bool finished_ = false;
};

Recorder::Implementation::Implementation(Target target) : target_(std::move(target)) {
  const RecordingLimits& limits = target_.limits;
  if (limits.splits()) {
    stale_ = existing_parts(target_.path);
    if (!stale_.empty() && target_.writing.overwrite == Overwrite::kRefuse)
      throw Error(stale_.front().string(), "already exists",
                  "choose another name, or give --force to replace all parts");
    for (const auto& part : stale_)
      if (!is_trace(part))
        throw Error(part.string(), "has the name of a part of an earlier recording, but is not a trace of vestige",
                    "move it away, or choose another name");
  }
  if (limits.ring_s) {
    refuse_overwrite(target_.path, target_.writing.overwrite);
    FrameRing::Limits most = {.seconds = *limits.ring_s};
    if (limits.max_bytes) most.bytes = *limits.max_bytes;
    ring_.emplace(most);
  } else {
    open_next();
  }
}

Recorder::Implementation::~Implementation() {
  if (finished_ || !ring_ || !has_frame_) return;
  try {
    write_ring();
  } catch (const std::exception&) {
    // Earlier errors were reported; a destructor cannot report this one.
    return;
  }
}

std::unique_ptr<TraceWriter> Recorder::Implementation::open(const std::filesystem::path& path) const {
  return std::make_unique<TraceWriter>(path, target_.session, target_.people, target_.writing);
}

void Recorder::Implementation::open_next() {
  const std::filesystem::path path = target_.limits.splits() ? part_path(target_.path, ++parts_) : target_.path;
  writer_ = open(path);
  files_.push_back(path);
}

void Recorder::Implementation::finish_writer() {
  writer_->finish();
  finished_frames_ += writer_->frame_count();
  finished_bytes_ += writer_->bytes_written();
  writer_.reset();
}

std::optional<std::uint64_t> Recorder::Implementation::most_bytes() const {
  return target_.limits.split_bytes ? target_.limits.split_bytes : target_.limits.max_bytes;
}

bool Recorder::Implementation::has_room_for(const TraceFrame& frame) {
  const auto most = most_bytes();
  if (!most || writer_->bytes_if_finished_with(frame) <= *most) return true;
  // The bound assumes that the open chunk does not compress. Closing the chunk makes its size known.
  writer_->close_chunk();
  const std::uint64_t needed = writer_->bytes_if_finished_with(frame);
  if (needed <= *most) return true;
  if (writer_->frame_count() == 0) throw too_small(files_.back(), *most, needed);
  return false;
}

bool Recorder::Implementation::is_beyond_part(const TraceFrame& frame) const {
  return target_.limits.split_s && writer_->frame_count() > 0 && frame.time_ns >= split_ns_;
}

bool Recorder::Implementation::write(const TraceFrame& frame) {
  if (ring_) {
    ring_->push(frame);
    has_frame_ = true;
    return true;
  }
  const bool is_first = !first_ns_;
  if (is_first) {
    first_ns_ = frame.time_ns;
    split_ns_ = frame.time_ns;
  }
  const bool beyond = is_beyond_part(frame);
  if (beyond || !has_room_for(frame)) {
    full_ = !target_.limits.splits();
    if (full_) return false;
    finish_writer();
    open_next();
    static_cast<void>(has_room_for(frame));  // throws if a single frame does not fit
  }
  if (target_.limits.split_s && frame.time_ns >= split_ns_) {
    const double length_ns = *target_.limits.split_s * kNanosecondsPerSecond;
    const double parts = std::floor(static_cast<double>(frame.time_ns - *first_ns_) / length_ns) + 1;
    const double end_ns = static_cast<double>(*first_ns_) + parts * length_ns;
    split_ns_ =
        end_ns < kLatest_ns ? *first_ns_ + std::llround(parts * length_ns) : std::numeric_limits<std::int64_t>::max();
  }
  writer_->write(frame);
  if (is_first && target_.limits.splits()) replace_stale_parts();
  return true;
}

void Recorder::Implementation::note(RecordingNote note) {
  if (ring_) {
    ring_->push(note);
  } else {
    note_in(*writer_, note);
  }
}

void Recorder::Implementation::write_old_chunk() {
  if (writer_) writer_->write_old_chunk();
}

void Recorder::Implementation::await_snapshot() {
  if (snapshot_.valid()) snapshot_.get();
}

void Recorder::Implementation::snapshot() {
  if (!ring_) return;
  await_snapshot();
  std::filesystem::path path = part_path(target_.path, ++parts_);
  if (target_.writing.overwrite == Overwrite::kRefuse)
    while (std::filesystem::exists(path)) path = part_path(target_.path, ++parts_);
  files_.push_back(path);
  snapshot_ = std::async(std::launch::async, [this, path, contents = ring_->contents()] {
    const auto writer = open(path);
    std::optional<std::int64_t> first_ns;
    std::int64_t last_ns = 0;
    contents.for_each([&](const RecordingNote& note) { note_in(*writer, note); },
                      [&](const TraceFrame& frame) {
                        writer->write(frame);
                        last_ns = frame.time_ns;
                        if (!first_ns) first_ns = last_ns;
                        return true;
                      });
    writer->finish();
    if (target_.snapshot_written)
      target_.snapshot_written(path, static_cast<double>(last_ns - first_ns.value_or(0)) / kNanosecondsPerSecond);
  });
}

void Recorder::Implementation::write_ring() {
  // A failed snapshot must not lose the frames that are still in the ring.
  std::exception_ptr snapshot_failure;
  try {
    await_snapshot();
  } catch (...) {
    snapshot_failure = std::current_exception();
  }
  writer_ = open(target_.path);
  files_.push_back(target_.path);
  ring_->contents().for_each([&](const RecordingNote& note) { note_in(*writer_, note); },
                             [&](const TraceFrame& frame) {
                               writer_->write(frame);
                               return true;
                             });
  finish_writer();
  if (snapshot_failure) std::rethrow_exception(snapshot_failure);
}

/// Deletes the stale parts as soon as the new recording has data on disk. If the program were killed later, the stale
/// parts would be merged with the new ones.
void Recorder::Implementation::replace_stale_parts() {
  if (stale_.empty()) return;
  writer_->close_chunk();
  for (const auto& part : stale_) {
    if (part == files_.front()) continue;
    std::filesystem::remove(part);
    removed_.push_back(part);
  }
}

void Recorder::Implementation::finish() {
  finished_ = true;
  if (ring_) {
    write_ring();
  } else {
    finish_writer();
  }
}

Recorder::Recorder(Target target) : implementation_(std::make_unique<Implementation>(std::move(target))) {}
Recorder::~Recorder() = default;

bool Recorder::write(const TraceFrame& frame) {
  return implementation_->write(frame);
}
void Recorder::note(RecordingNote note) {
  implementation_->note(std::move(note));
}
void Recorder::write_old_chunk() {
  implementation_->write_old_chunk();
}
void Recorder::snapshot() {
  implementation_->snapshot();
}
void Recorder::finish() {
  implementation_->finish();
}
bool Recorder::is_full() const {
  return implementation_->is_full();
}
bool Recorder::is_ring_cut_by_size() const {
  return implementation_->is_ring_cut_by_size();
}
std::uint64_t Recorder::frame_count() const {
  return implementation_->frame_count();
}
std::uint64_t Recorder::bytes_written() const {
  return implementation_->bytes_written();
}
const std::vector<std::filesystem::path>& Recorder::files() const {
  return implementation_->files();
}
const std::vector<std::filesystem::path>& Recorder::removed() const {
  return implementation_->removed();
}

}  // namespace vestige
