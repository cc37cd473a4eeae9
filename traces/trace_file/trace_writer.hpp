#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "traces/files/append_file.hpp"
#include "traces/files/output_file.hpp"
#include "traces/mcap/compression.hpp"
#include "traces/scene/avatar.hpp"
#include "traces/scene/trace.hpp"

namespace vestige {

using Compression = mcap::Compression;

/// Whether each chunk is brought to disk when it is written, so that it survives a power cut, or just handed to the
/// system, which survives the death of the program.
enum class ChunkSync : std::uint8_t { kNone, kEach };

/// Whether the trace says what a viewer needs to draw it, 60 times a second: see viz_messages.hpp.
enum class Viz : std::uint8_t { kNone, kScene };

struct TraceWriterOptions {
  Overwrite overwrite = Overwrite::kRefuse;
  Unfinished unfinished = Unfinished::kKept;  ///< removed: for what can be made again
  Compression compression = Compression::kZstd;
  std::size_t chunk_bytes = std::size_t{1} << 20;  ///< uncompressed size at which a chunk is closed
  double chunk_s = 0.1;                            ///< age, by the wall clock, at which a chunk is closed
  ChunkSync sync = ChunkSync::kNone;
  Viz viz = Viz::kNone;
};

/// What makes a trace one self-contained file. The bytes must stay until the writer has been made.
struct TraceAttachments {
  std::span<const std::byte> avatar_glb;
  std::span<const std::byte> actuator_map_png = {};  ///< empty: none
  std::string actuator_map_json = {};                ///< the map's sidecar, empty: none
};

/// Writes a trace, an MCAP file (notes in trace_format.hpp). The file appears under its own name at once and grows
/// chunk by chunk, each written with one call, so that a program killed at any instant loses at most the chunk it was
/// filling.
///
/// With `Overwrite::kAllow` an existing file is replaced only when the new one's beginning is safely on disk. When a
/// write fails midway, what was written is kept as NAME.partial, which `TraceReader` reads, and the `Error` says so;
/// when no frame had been written yet, nothing is left. With `Unfinished::kRemoved` nothing is left in any case, and
/// the file has its name once `finish` has returned. "-" is standard output.
///
/// Every function throws `Error` naming the file; after that, only the destructor may be called.
class TraceWriter {
 public:
  /// `session` is stored with `format_version` and the SHA-256 of each attachment added.
  TraceWriter(const std::filesystem::path& path, Session session, const Avatar& avatar,
              const TraceAttachments& attachments, const TraceWriterOptions& options);
  /// Without `finish`: writes what is pending and leaves a trace without footer, which is still readable. A trace
  /// without any frame is removed, and any one with `Unfinished::kRemoved`.
  ~TraceWriter();
  TraceWriter(const TraceWriter&) = delete;
  TraceWriter& operator=(const TraceWriter&) = delete;

  /// Precondition, checked: `index` grows (and fits 32 bits), `time_ns` is not negative and does not decrease, one
  /// local transform for each node of the avatar, every collider id at most once.
  void write(const TraceFrame& frame);

  /// Notes that `count` messages of `topic` were lost since the last frame. Stands with the next frame, or with the
  /// last one where none follows.
  void note_dropped(std::string_view topic, std::uint64_t count);
  /// Notes something that the user wants to find again, at the next frame as above.
  void note_marker(std::string_view text);
  /// Writes the open chunk if it is older than `chunk_s`. `write` does so too: this is for whoever has no frame.
  void write_old_chunk();
  /// Writes the open chunk however young it is.
  void close_chunk();

  /// Writes index and footer and syncs the file.
  void finish();

  std::uint64_t frame_count() const;
  /// Bytes that are in the file (for limits on its size); what waits in the open chunk does not count.
  std::uint64_t bytes_written() const;
  /// How large the file is at most if `write(frame)` and then `finish` are called now.
  std::uint64_t bytes_if_finished_with(const TraceFrame& frame) const;

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace vestige
