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

/// Delivers a file's messages by log_time (equal times in file order), found through its summary's chunk indexes, and
/// looks at no chunk outside `range`. Keeps the chunks whose times overlap in memory. Messages outside chunks are in no
/// index and are not found (the specification says so): see `leads_to_everything`.
class IndexedReader {
 public:
  /// Is told of the schemas and channels in each chunk, before its messages.
  using TakeDefinition = std::function<void(const InnerRecord&)>;

  /// `source` must stay. Throws `Error` when there is no trustworthy summary: scan it with StreamReader then.
  explicit IndexedReader(const ByteSource& source, const TimeRange& range = {}, TakeDefinition take_definition = {});

  const Summary& summary() const { return summary_; }
  /// The next message; its data is valid until the next call. False at the end. Throws `Error` when more than 1 GiB of
  /// chunks overlap.
  bool next(Message& message);
  /// Of the chunk of the message delivered last, in the file.
  std::uint64_t chunk_offset() const { return summary_.chunk_indexes[current_].chunk_start_offset; }
  /// What could not be read, or contradicts its index.
  const DamageList& damages() const { return damages_; }

 private:
  struct Entry {
    std::uint64_t log_time;
    std::uint64_t offset;  ///< of the message's record, from the start of its chunk's records
    std::uint32_t chunk;
    bool operator>(const Entry& other) const;
  };
  struct OpenChunk {
    RawBuffer expanded;
    Bytes records;
    std::uint64_t messages_left = 0;
    bool has_misfits = false;        ///< records whose fields do not fit
    bool contradicts_index = false;  ///< by a message at another time
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
  std::vector<std::uint32_t> by_start_;  ///< chunks that have messages within the range, by their first message's time
  std::size_t next_chunk_ = 0;           ///< in by_start_: the first that was not opened yet
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> entries_;  ///< of open chunks; the earliest on top
  std::map<std::uint32_t, OpenChunk> open_chunks_;
  std::uint64_t open_bytes_ = 0;
  std::uint32_t current_ = 0;  ///< the chunk of the message delivered last
  RawBuffer content_;
  DamageList damages_;
};

}  // namespace vestige::mcap
