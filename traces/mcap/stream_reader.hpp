#pragma once

#include "traces/mcap/byte_source.hpp"
#include "traces/mcap/compression.hpp"
#include "traces/mcap/decode.hpp"
#include "traces/mcap/record.hpp"
#include "traces/mcap/record_walker.hpp"

namespace vestige::mcap {

/// One record, wherever it stands.
struct StreamRecord {
  Opcode opcode = Opcode::kMessage;
  Bytes content;             ///< valid until the next call of `next`
  std::uint64_t offset = 0;  ///< in the file; inside a chunk, the chunk's
  bool in_chunk = false;
};

enum class ChunkHandling {
  kExpand,
  kExpandAndShow
};  ///< kExpandAndShow delivers the Chunk record too, before its records

/// Delivers every record of a file in order, with chunks expanded in place, and verifies every CRC. Damage never stops
/// it: it skips the damaged chunk or record, or a chunk's records whose fields do not fit, and notes where. Needs as
/// much memory as the largest record and chunk.
class StreamReader {
 public:
  /// `source` must stay. Throws `Error` when it is no MCAP file.
  explicit StreamReader(const ByteSource& source, ChunkHandling handling = ChunkHandling::kExpand);

  /// False at the end.
  bool next(StreamRecord& record);

  bool footer_seen() const { return walker_.footer_seen(); }
  /// What is wrong up to here: the first that was found, by offset.
  DamageList damages() const;

 private:
  bool next_in_chunk(StreamRecord& record);
  void note_misfits();
  bool open_chunk(const RecordPlace& place, Bytes content);
  void check(const RecordPlace& place, Bytes content);
  void check_data_section(const RecordPlace& place, Bytes content);
  void check_summary(const RecordPlace& place, Bytes content);

  const ByteSource& source_;
  ChunkHandling handling_;
  RecordWalker walker_;
  RawBuffer content_;
  RawBuffer expanded_;
  Cursor chunk_ = Cursor({});
  RecordPlace chunk_place_;
  std::uint32_t data_crc_ = 0;
  std::uint64_t data_end_ = kMagicBytes;  ///< up to where data_crc_ reaches
  bool data_end_seen_ = false;
  std::uint64_t misfit_bytes_ = 0;  ///< of this chunk's records whose fields do not fit
  DamageList damages_;
};

/// CRC of a piece of a file, read in blocks.
std::uint32_t crc32_of(const ByteSource& source, std::uint64_t begin, std::uint64_t end);

}  // namespace vestige::mcap
