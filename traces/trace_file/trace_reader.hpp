#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "traces/scene/trace.hpp"

namespace vestige {

/// Reads a trace: by its index where it has one, by scanning it where the footer is missing or the summary broken.
/// Damaged chunks are skipped, which shows as a gap in `TraceFrame::index`, as a warning with its byte offset, and in
/// `complete()`.
///
/// Every function throws `Error` naming the file and offset: no MCAP file, no trace of ours, no avatar or a damaged
/// one, a frame that contradicts the rest (frames out of order, time running back, another number of nodes than the
/// avatar has, a collider twice), more than a million colliders.
class TraceReader {
 public:
  /// "-" is standard input, kept in a temporary file without a name.
  explicit TraceReader(const std::filesystem::path& path);
  ~TraceReader();
  TraceReader(const TraceReader&) = delete;
  TraceReader& operator=(const TraceReader&) = delete;

  const Session& session() const;
  std::span<const std::byte> avatar_glb() const;
  std::span<const std::byte> actuator_map_png() const;   ///< empty: the trace has none
  std::span<const std::byte> actuator_map_json() const;  ///< empty: the trace has none
  /// The avatar's nodes, in order; each frame's pose has as many.
  const std::vector<std::string>& node_names() const;

  /// The ids of all colliders in the trace, ascending. The first call, of this or of the next two, reads the whole
  /// trace once without decoding poses; `next` goes on where it was.
  const std::vector<std::uint32_t>& collider_ids();
  /// How many frames `next` delivers in all.
  std::uint64_t frame_count();
  /// How many messages the recorder noted as lost.
  std::uint64_t dropped();

  /// The next frame in order; false at the end. Memory of `frame` is used again. `frame.time_ns` is the message's
  /// log_time.
  bool next(TraceFrame& frame);
  void rewind();

  /// The trace has a footer, and nothing that was read so far was damaged: final once `next` has returned false or
  /// `frame_count` has been called.
  bool complete() const;
  /// What is wrong with the file, one sentence each, with byte offset. Grows while reading; nothing is said twice.
  const std::vector<std::string>& warnings() const;
  /// What `recover` noted in the file if it wrote it from a damaged one: see `describe_recovered`. Else empty.
  const std::string& recovered() const;

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

/// Throws `Error` where the trace holds no frame at all, and says why.
void require_frames(TraceReader& trace, const std::string& name);

/// What is wrong with a trace that is not `complete()`: its warnings, or else that; `name` stands in it. Empty for one
/// that is.
std::vector<std::string> damage_of(const TraceReader& trace, std::string_view name);

}  // namespace vestige
