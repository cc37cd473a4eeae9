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

/// What the data section of a file turned out to hold, in the words of the records that should say the same.
struct DataFacts {
  struct ChunkFacts {
    ChunkIndex index;       ///< what its ChunkIndex should say
    bool readable = false;  ///< false: only place and length are known
  };
  std::vector<ChunkFacts> chunks;  ///< by offset
  std::vector<AttachmentIndex> attachments;
  std::vector<MetadataIndex> metadata;
  std::map<std::uint16_t, Schema> schemas;
  std::map<std::uint16_t, Channel> channels;
  Statistics counted;
  bool whole = true;  ///< nothing was skipped, so that the counts are right
};

/// Compares a summary section, record by record, with the data before it.
class SummaryCheck {
 public:
  /// Both must stay.
  SummaryCheck(const DataFacts& facts, ProblemList& problems) : facts_(facts), problems_(problems) {}

  /// There is no DataEnd, so that nothing tells where the summary begins.
  void begin_unknown() { begin_known_ = false; }
  /// A record between DataEnd and Footer whose fields fit.
  void take(const RecordPlace& place, Bytes content);
  /// The footer, after everything else.
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

/// A schema with the SHA-256 of its data in place of the data, which a file may have any amount of: enough to compare.
Schema without_data(const Schema& schema);

}  // namespace vestige::mcap
