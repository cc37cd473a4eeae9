#pragma once

#include <map>
#include <string_view>
#include <utility>
#include <vector>

#include "traces/mcap/byte_source.hpp"
#include "traces/mcap/check/problem.hpp"
#include "traces/mcap/record.hpp"
#include "traces/mcap/record_walker.hpp"

namespace vestige::mcap {

/// What the data section of a file contains, in the form of the summary records that should say the same.
struct DataFacts {
  struct ChunkFacts {
    ChunkIndex index;       ///< the content its ChunkIndex should have
    bool readable = false;  ///< false: only place and length are known
  };
  std::vector<ChunkFacts> chunks;  ///< by offset
  std::vector<AttachmentIndex> attachments;
  std::vector<MetadataIndex> metadata;
  std::map<std::uint16_t, Schema> schemas;
  std::map<std::uint16_t, Channel> channels;
  Statistics counted;
  bool whole = true;  ///< nothing was skipped, so the counts are exact
};

/// Compares a summary section, record by record, with the data section before it.
class SummaryCheck {
 public:
  /// Keeps references to both arguments.
  SummaryCheck(const DataFacts& facts, ProblemList& problems) : facts_(facts), problems_(problems) {}

  /// Call this if the file has no DataEnd, so the start of the summary is unknown.
  void begin_unknown() { begin_known_ = false; }
  /// Checks a record between DataEnd and Footer. Precondition: its fields fit into the record.
  void take(const RecordPlace& place, Bytes content);
  /// Checks the footer. Call this last.
  void finish(const RecordPlace& place, Bytes content, const ByteSource& source);

 private:
  struct Group {
    Opcode opcode;
    std::uint64_t start;
    std::uint64_t end;
  };

  void contradiction(const RecordPlace& place, std::string what);
  template <typename Value>
  void compare(const RecordPlace& place, std::string_view field, const Value& claimed, const Value& actual);
  void take(const RecordPlace& place, const ChunkIndex& index);
  void take(const RecordPlace& place, const AttachmentIndex& index);
  void take(const RecordPlace& place, const MetadataIndex& index);
  void take(const RecordPlace& place, const Statistics& statistics);
  void take(const RecordPlace& place, const SummaryOffset& offset);
  void report_unlisted();
  void note_group(const RecordPlace& place);

  const DataFacts& facts_;
  ProblemList& problems_;
  bool begin_known_ = true;
  std::vector<Group> groups_;
  std::vector<std::uint64_t> listed_chunks_;
  std::vector<std::uint64_t> listed_attachments_;
  std::vector<std::uint64_t> listed_metadata_;
};

/// Returns a copy of `schema` with the SHA-256 of its data in place of the data. That suffices to compare schemas, and
/// schema data may be of any size.
Schema without_data(const Schema& schema);

}  // namespace vestige::mcap
