#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <queue>
#include <vector>

#include "traces/mcap/byte_source.hpp"
#include "traces/mcap/decode.hpp"
#include "traces/mcap/record_walker.hpp"
#include "traces/mcap/summary.hpp"
#include "traces/mcap/time_range.hpp"

namespace vestige::mcap {

/// Delivers a file's messages in the order of log_time; messages of equal time come in file order. Finds them through
/// the chunk indexes of the summary and reads no chunk outside `range`. Keeps in memory the chunks whose times overlap.
/// Messages outside chunks are in no index (by the specification), so they are not found: see `leads_to_everything`.
class IndexedReader {
 public:
  /// Called with the schemas and channels of each chunk before its messages.
  using TakeDefinition = std::function<void(const InnerRecord&)>;

  /// Keeps a reference to `source`. Throws `Error` if there is no trustworthy summary; use StreamReader then.
  explicit IndexedReader(const ByteSource& source, const TimeRange& range = {}, TakeDefinition take_definition = {});

  const Summary& summary() const { return summary_; }
  /// Reads the next message; its data are valid until the next call. Returns false at the end. Throws `Error` if the
  /// chunks that overlap in time exceed 1 GiB.
  bool next(Message& message);
  /// Offset, in the file, of the chunk that holds the message delivered last.
  std::uint64_t chunk_offset() const { return summary_.chunk_indexes[current_].chunk_start_offset; }
  /// Chunks that could not be read or that contradict their index.
  const DamageList& damages() const { return damages_; }

 private:
  struct Entry {
    std::uint64_t log_time;
    std::uint64_t offset;  ///< of the message's record, from the start of its chunk's uncompressed records
    std::uint32_t chunk;
    bool operator>(const Entry& other) const;
  };
  struct OpenChunk {
    RawBuffer expanded;
    Bytes records;
    std::uint64_t messages_left = 0;
    bool has_misfits = false;        ///< some records' fields do not fit into the record
    bool contradicts_index = false;  ///< a message lies outside the index's time range
  };

  void open_due_chunks();
  void open(std::uint32_t chunk);
  void take_records(std::uint32_t chunk, OpenChunk& opened);
  void take(const InnerRecord& record, std::uint64_t offset, std::uint32_t chunk, OpenChunk& opened);
  void close_finished_chunk();
  void note(std::uint32_t chunk, std::string_view what);

  const ByteSource& source_;
  TimeRange range_;
  TakeDefinition take_definition_;
  Summary summary_;
  std::vector<std::uint32_t> by_start_;  ///< chunks that overlap the range, sorted by the time of their first message
  std::size_t next_chunk_ = 0;           ///< index in by_start_ of the first chunk not yet opened
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> entries_;  ///< of open chunks; earliest on top
  std::map<std::uint32_t, OpenChunk> open_chunks_;
  std::uint64_t open_bytes_ = 0;
  std::uint32_t current_ = 0;  ///< chunk of the message delivered last
  RawBuffer content_;
  DamageList damages_;
};

}  // namespace vestige::mcap
