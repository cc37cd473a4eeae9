#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string_view>
#include <vector>

#include "traces/recording/frame_ring.hpp"
#include "traces/scene/avatar.hpp"
#include "traces/trace_file/trace_writer.hpp"

namespace vestige {

/// When a recording ends, continues in another file, or forgets frames. A value that is not set limits nothing.
struct RecordingLimits {
  std::optional<double> ring_s = {};            ///< only these last seconds are kept, in memory, and written at the end
  std::optional<std::uint64_t> max_bytes = {};  ///< largest size of a file; with `ring_s`, of the memory; see `write`
  std::optional<double> split_s = {};  ///< a new part begins at every multiple of this time since the first frame
  std::optional<std::uint64_t> split_bytes = {};  ///< a new part begins before one exceeds this size
  bool splits() const { return split_s || split_bytes; }
};

/// Writes a long recording in one of three ways. It goes into one trace, or into parts NAME-0001.mcap, NAME-0002.mcap,
/// …, or into memory, of which only the end becomes a trace. Each part is a whole trace with avatar and map. Frames
/// keep their numbers and times, so `merge` joins the parts to what a single file would have been.
///
/// Every function throws `Error` as `TraceWriter` does.
class Recorder {
 public:
  struct Target {
    std::filesystem::path path;
    Session session;
    std::vector<TracePerson> people;  ///< the caller keeps avatars and bytes alive
    TraceWriterOptions writing;
    RecordingLimits limits;
    /// Takes the path of a snapshot that was written, and how many seconds it holds. Is called in another thread.
    std::function<void(const std::filesystem::path&, double)> snapshot_written = {};
  };

  /// Also throws `Error` if parts of an earlier recording exist (with `Overwrite::kRefuse`), or other files have the
  /// names of parts.
  explicit Recorder(Target target);
  /// If `finish` was not called, keeps what was recorded, as `TraceWriter` does. A ring is written as a trace.
  ~Recorder();
  Recorder(const Recorder&) = delete;
  Recorder& operator=(const Recorder&) = delete;

  /// Writes a frame. If the file would exceed `max_bytes`, returns false without writing, and the recording is
  /// complete. But a ring forgets older frames instead, and `split_s` or `split_bytes` begins the next part instead.
  bool write(const TraceFrame& frame);
  /// Adds a note, which is stored with the next frame.
  void note(RecordingNote note);
  /// Call this every few milliseconds while there is no frame, so that frames wait in memory for at most 100 ms.
  void write_old_chunk();
  /// Writes the ring's present content as NAME-0001.mcap, NAME-0002.mcap, …, in a separate thread. Does nothing without
  /// a ring.
  void snapshot();
  void finish();

  /// Whether `write` has returned false.
  bool is_full() const;
  /// Whether a ring holds less than its seconds because of its size limit.
  bool is_ring_cut_by_size() const;
  std::uint64_t frame_count() const;    ///< in the files; with a ring, known after `finish`
  std::uint64_t bytes_written() const;  ///< in the files; with a ring, known after `finish`
  /// The files written so far, in order.
  const std::vector<std::filesystem::path>& files() const;
  /// Parts of an earlier recording, deleted as soon as this recording's first frame was in its file.
  const std::vector<std::filesystem::path>& removed() const;

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

/// Returns the path of a part: man-0001.mcap for man.mcap and 1.
std::filesystem::path part_path(const std::filesystem::path& path, std::uint64_t number);

/// Whether the name of `candidate` is that of a part of `path`.
bool is_part_path(const std::filesystem::path& path, const std::filesystem::path& candidate);

/// Returns existing parts of an earlier recording of this name, which would be mistaken for parts of the next one.
std::vector<std::filesystem::path> existing_parts(const std::filesystem::path& path);

}  // namespace vestige
