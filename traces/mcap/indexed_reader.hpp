#pragma once

#include <cstdint>
#include <list>
#include <vector>

#include "traces/mcap/byte_source.hpp"
#include "traces/mcap/record_walker.hpp"
#include "traces/mcap/summary.hpp"

namespace vestige::mcap {

/// Delivers a file's messages by log_time (equal times in file order), found through its summary's chunk indexes; where
/// a chunk has no message index, it is expanded once to make one. Keeps 24 bytes a message and a few chunks in memory.
/// Messages outside chunks are in no index and are not found (the specification says so).
class IndexedReader {
 public:
  /// `source` must stay. Throws `Error` when there is no trustworthy summary: scan it with StreamReader then.
  explicit IndexedReader(const ByteSource& source);

  const Summary& summary() const { return summary_; }
  /// The next message; its data is valid until the next call. False at the end.
  bool next(Message& message);
  void rewind() { next_entry_ = 0; }
  /// Chunks that could not be read, with all their messages.
  const std::vector<Damage>& damages() const { return damages_; }

 private:
  struct Entry {
    std::uint64_t log_time;
    std::uint64_t offset;  ///< from the start of the chunk's records
    std::uint32_t chunk;
  };
  struct OpenChunk {
    std::uint32_t chunk;
    std::vector<std::byte> records;
  };

  void index_chunk(std::uint32_t chunk);
  void index_by_expanding(std::uint32_t chunk);
  Bytes records_of(std::uint32_t chunk);
  void note(std::uint32_t chunk, std::string_view what);

  const ByteSource& source_;
  Summary summary_;
  std::vector<Entry> entries_;
  std::size_t next_entry_ = 0;
  std::list<OpenChunk> open_chunks_;  ///< the one used last stands first
  std::vector<bool> damaged_;         ///< by chunk
  std::vector<Damage> damages_;
};

}  // namespace vestige::mcap
