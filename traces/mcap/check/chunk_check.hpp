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

  /// A chunk begins; what is known of the last one is forgotten.
  void begin_chunk() { begin(Subject::kReadChunk); }
  /// The chunk cannot be read, or something was skipped: the next indexes cannot be judged.
  void begin_unknown() { begin(Subject::kUnknown); }
  /// A message of the chunk.
  void take_message(const Message& message, std::uint64_t offset_in_chunk);
  /// A MessageIndex, whose fields fit.
  void take_index(const RecordPlace& place, const MessageIndex& index);
  /// Another record, or the end: whatever indexes there are have been seen.
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
