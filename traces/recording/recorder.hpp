#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string_view>
#include <vector>

#include "traces/recording/frame_ring.hpp"
#include "traces/scene/avatar.hpp"
#include "traces/trace_file/trace_writer.hpp"

namespace vestige {

/// When a recording ends, goes on in another file, or forgets. Nothing that is not set limits anything.
struct RecordingLimits {
  std::optional<double> ring_s = {};            ///< only the last seconds are kept, in memory, and written at the end
  std::optional<std::uint64_t> max_bytes = {};  ///< no file is larger; with `ring_s`, its memory; see `write`
  std::optional<double> split_s = {};           ///< a new part at every multiple of these seconds since the first frame
  std::optional<std::uint64_t> split_bytes = {};  ///< a new part before one would be larger
  bool splits() const { return split_s || split_bytes; }
};

/// Writes a recording that lasts: into one trace, into parts NAME-0001.mcap, NAME-0002.mcap, … each of which is a whole
/// trace with avatar and map, or into memory, of which only the end becomes a trace. Frames keep their numbers and
/// times, so that `merge` puts parts together to what one file would have been.
///
/// Every function throws `Error` as `TraceWriter` does.
class Recorder {
 public:
  struct Target {
    std::filesystem::path path;
    Session session;
    const Avatar& avatar;          ///< must stay
    TraceAttachments attachments;  ///< their bytes must stay
    TraceWriterOptions writing;
    RecordingLimits limits;
  };

  /// Throws `Error` also where parts of an earlier recording are in the way (`Overwrite::kRefuse`), or other files that
  /// have the names of such.
  explicit Recorder(Target target);
  /// Without `finish`: keeps what there is, as `TraceWriter` does; a ring becomes a trace.
  ~Recorder();
  Recorder(const Recorder&) = delete;
  Recorder& operator=(const Recorder&) = delete;

  /// False when the frame would make the file larger than `max_bytes`, and nothing splits it: it is not written, and
  /// the recording is at its end. With a ring, older frames are forgotten instead; with `split_s`, the next part
  /// begins.
  bool write(const TraceFrame& frame);
  /// Stands with the next frame.
  void note(RecordingNote note);
  /// To be called every few milliseconds when there is no frame: what waits in memory does so for 100 ms at most.
  void write_old_chunk();
  /// Writes what is in the ring now as NAME-0001.mcap, NAME-0002.mcap, …, on a thread of its own. Nothing without one.
  void snapshot();
  void finish();

  /// Whether `write` has refused a frame.
  bool is_full() const;
  /// Whether a ring holds less than its seconds, since it may not become larger.
  bool is_ring_cut_by_size() const;
  std::uint64_t frame_count() const;    ///< in the files; with a ring, known after `finish`
  std::uint64_t bytes_written() const;  ///< in the files; with a ring, known after `finish`
  /// The files that there are, in order.
  const std::vector<std::filesystem::path>& files() const;
  /// Parts of an earlier recording that went as soon as this one's first frame was in its file.
  const std::vector<std::filesystem::path>& removed() const;

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

/// man.mcap: man-0001.mcap for 1.
std::filesystem::path part_path(const std::filesystem::path& path, std::uint64_t number);

/// Whether `candidate` is called as a part of `path` is.
bool is_part_path(const std::filesystem::path& path, const std::filesystem::path& candidate);

/// Parts of an earlier recording under this name, which would be taken for parts of the next one.
std::vector<std::filesystem::path> existing_parts(const std::filesystem::path& path);

}  // namespace vestige
