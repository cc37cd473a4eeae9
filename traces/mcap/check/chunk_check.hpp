#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <vector>

#include "traces/mcap/check/problem.hpp"
#include "traces/mcap/record.hpp"
#include "traces/mcap/record_walker.hpp"

namespace vestige::mcap {

/// Compares the message indexes that follow a chunk with the messages in it.
class MessageIndexCheck {
 public:
  explicit MessageIndexCheck(ProblemList& problems) : problems_(problems) {}

  /// Begins a new chunk and forgets the previous one.
  void begin_chunk() { begin(Subject::kReadChunk); }
  /// Call this if the chunk cannot be read or bytes were skipped. The MessageIndex records that follow are then not
  /// judged.
  void begin_unknown() { begin(Subject::kUnknown); }
  /// Adds a message of the chunk.
  void take_message(const Message& message, std::uint64_t offset_in_chunk);
  /// Checks a MessageIndex. Precondition: its fields fit into the record.
  void take_index(const RecordPlace& place, const MessageIndex& index);
  /// Ends the chunk's group of MessageIndex records: another kind of record or the end of the file follows. Reports
  /// channels that have no index.
  void end();

 private:
  enum class Subject { kNone, kUnknown, kReadChunk };
  struct Entries {
    std::vector<MessageIndexEntry> in_chunk;
    bool indexed = false;
  };

  void begin(Subject subject);
  void report(const RecordPlace& place, std::string what);

  ProblemList& problems_;
  Subject subject_ = Subject::kNone;
  std::map<std::uint16_t, Entries> channels_;
  std::optional<RecordPlace> last_index_;
};

}  // namespace vestige::mcap
