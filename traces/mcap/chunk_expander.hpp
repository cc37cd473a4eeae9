#pragma once

#include <cstddef>
#include <cstdint>
#include <future>
#include <optional>
#include <vector>

#include "traces/mcap/byte_source.hpp"
#include "traces/mcap/compression.hpp"
#include "traces/mcap/record.hpp"

namespace vestige::mcap {

/// Expands a chunk's records and checks their size and CRC. The result lies in `out`, or in `chunk.records` if they are
/// not compressed. Throws `Malformed`.
Bytes expand_chunk(const Chunk& chunk, RawBuffer& out);

/// Reads and expands chunks of a file, which come out in the order in which they were added. With several threads, some
/// chunks are expanded ahead: at most eight, and none larger than 8 MiB, so that memory stays bounded.
class ChunkQueue {
 public:
  /// Keeps a reference to `source`. `threads` includes the calling one.
  ChunkQueue(const ByteSource& source, std::size_t threads);
  ChunkQueue(const ChunkQueue&) = delete;
  ChunkQueue& operator=(const ChunkQueue&) = delete;

  bool has_room() const { return added_ - taken_ < places_.size(); }
  /// Adds the chunk whose record lies at [begin, end) of the file. Precondition: `has_room`.
  void add(std::uint64_t begin, std::uint64_t end);
  /// Returns the records of the next chunk, valid until the next call of `add`, `take` or `clear`. Throws `Malformed`
  /// if the chunk is damaged, `Error` if reading fails. Precondition: not all chunks that were added have been taken.
  Bytes take();
  /// Forgets all chunks.
  void clear();

 private:
  struct Buffers {
    RawBuffer content;
    RawBuffer expanded;
  };
  struct Place {
    std::uint64_t begin = 0;
    std::uint64_t end = 0;
    Buffers buffers;
    std::future<std::optional<Bytes>> records;  ///< last: its thread ends before the buffers do
  };

  /// Returns nothing if the chunk is larger than `most_bytes`.
  std::optional<Bytes> load(const Place& place, std::uint64_t most_bytes, Buffers& buffers) const;

  const ByteSource& source_;
  Buffers own_;  ///< for chunks that are not expanded ahead
  std::uint64_t added_ = 0;
  std::uint64_t taken_ = 0;
  std::vector<Place> places_;  ///< used in turn
};

}  // namespace vestige::mcap
