#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "traces/files/append_file.hpp"
#include "traces/files/output_file.hpp"
#include "traces/mcap/compression.hpp"
#include "traces/scene/avatar.hpp"
#include "traces/scene/trace.hpp"

namespace vestige {

using Compression = mcap::Compression;

/// Whether each chunk is synced to disk when it is written, so that it survives a power cut. kNone only passes it to
/// the system, which survives the death of the program.
enum class ChunkSync : std::uint8_t { kNone, kEach };

/// Whether the trace also holds what a viewer needs to draw it, 60 times a second: see `VizEncoder`.
enum class Viz : std::uint8_t { kNone, kScene };

struct TraceWriterOptions {
  Overwrite overwrite = Overwrite::kRefuse;
  Unfinished unfinished = Unfinished::kKept;  ///< kRemoved: for traces that can be made again
  Compression compression = Compression::kZstd;
  std::size_t chunk_bytes = std::size_t{1} << 20;  ///< uncompressed size at which a chunk is closed
  double chunk_s = 0.1;                            ///< age, by the wall clock, at which a chunk is closed
  ChunkSync sync = ChunkSync::kNone;
  Viz viz = Viz::kNone;
  ColliderShape shape = ColliderShape::kPoints;  ///< kSpheres: the trace says format version 2
  Owners owners = Owners::kNone;                 ///< kPeople: the trace says format version 3
};

/// The attachments that make a trace one self-contained file. The caller keeps the bytes alive until the writer is
/// constructed.
struct TraceAttachments {
  std::span<const std::byte> avatar_glb;
  std::span<const std::byte> actuator_map_png = {};  ///< empty: none
  std::string actuator_map_json = {};                ///< the map's sidecar, empty: none
};

/// A person to record. The caller keeps the avatar alive until the writer is constructed.
struct TracePerson {
  const Avatar& avatar;
  TraceAttachments attachments;
  std::string name = {};  ///< empty: nobody needs one, as in a trace of one person
};

/// Writes a trace, an MCAP file described in trace_format.hpp. The file appears under its own name at once. It grows by
/// one chunk with each write call, so a program killed at any instant loses at most the chunk it was filling.
///
/// With `Overwrite::kAllow`, an existing file is replaced only after the beginning of the new one is safely on disk. If
/// a write fails midway, the bytes written so far are kept as NAME.partial, which `TraceReader` reads, and the `Error`
/// gives that name. If no frame was written yet, nothing is left. With `Unfinished::kRemoved` nothing is left in any
/// case, and the file gets its name in `finish`. "-" is standard output.
///
/// Every function throws `Error` with the name of the file; after that, only the destructor may be called.
class TraceWriter {
 public:
  /// Stores `session`, and adds `format_version`, and of each person the name, the SHA-256 of each attachment, and the
  /// avatar's `facing` unless the session has one. The SHA-256s also go to the person's channel /pose, so that the
  /// summary has them. There may be 1 to `kMostPeople` people.
  TraceWriter(const std::filesystem::path& path, Session session, const std::vector<TracePerson>& people,
              const TraceWriterOptions& options);
  /// If `finish` was not called, writes pending data and leaves a trace without footer, which is still readable.
  /// Removes a trace without any frame, and any unfinished trace with `Unfinished::kRemoved`.
  ~TraceWriter();
  TraceWriter(const TraceWriter&) = delete;
  TraceWriter& operator=(const TraceWriter&) = delete;

  /// Writes a frame. Throws `Error` unless `index` increases and fits 32 bits, and `time_ns` is not negative and does
  /// not decrease. There must be one pose for each person, with one local transform for each node of the avatar. Each
  /// collider id may occur once, and its owner must be there.
  void write(const TraceFrame& frame);

  /// Notes that `count` messages of `topic` were lost since the last frame. The note is stored with the next frame, or
  /// with the last one if no other follows.
  void note_dropped(std::string_view topic, std::uint64_t count);
  /// Notes that `count` frames of a live source were left out, since a newer one had arrived. It is stored likewise.
  void note_superseded(std::uint64_t count);
  /// Adds a marker that the user wants to find again. It is stored likewise.
  void note_marker(std::string_view text);
  /// Writes the open chunk if it is older than `chunk_s`. `write` does so too; this is for callers that have no frame.
  void write_old_chunk();
  /// Writes the open chunk regardless of its age.
  void close_chunk();

  /// Writes index and footer, and syncs the file.
  void finish();

  std::uint64_t frame_count() const;
  /// Bytes in the file, for limits on its size. Excludes the open chunk.
  std::uint64_t bytes_written() const;
  /// Upper bound of the file's size if `write(frame)` and then `finish` are called now.
  std::uint64_t bytes_if_finished_with(const TraceFrame& frame) const;

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace vestige
