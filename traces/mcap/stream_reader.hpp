#pragma once

#include "traces/mcap/byte_source.hpp"
#include "traces/mcap/compression.hpp"
#include "traces/mcap/decode.hpp"
#include "traces/mcap/record.hpp"
#include "traces/mcap/record_walker.hpp"

namespace vestige::mcap {

/// One record, inside or outside a chunk.
struct StreamRecord {
  Opcode opcode = Opcode::kMessage;
  Bytes content;             ///< valid until the next call of `next`
  std::uint64_t offset = 0;  ///< in the file; for a record inside a chunk, the offset of the chunk
  bool in_chunk = false;
};

enum class ChunkHandling {
  kExpand,
  kExpandAndShow
};  ///< kExpandAndShow also delivers the Chunk record, before its inner records

/// Delivers every record of a file in order, expands chunks in place, and verifies every CRC. Never stops at damage:
/// skips the damaged chunk or record, or those records of a chunk whose fields do not fit, and notes the place. Needs
/// as much memory as the largest record and chunk.
class StreamReader {
 public:
  /// Keeps a reference to `source`. Throws `Error` if it is not an MCAP file.
  explicit StreamReader(const ByteSource& source, ChunkHandling handling = ChunkHandling::kExpand);

  /// Reads the next record. Returns false at the end.
  bool next(StreamRecord& record);

  bool footer_seen() const { return walker_.footer_seen(); }
  /// Damage found so far: the first faults found, sorted by offset.
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
  std::uint64_t data_end_ = kMagicBytes;  ///< the end of the bytes that data_crc_ covers
  bool data_end_seen_ = false;
  std::uint64_t misfit_bytes_ = 0;  ///< total size of this chunk's records whose fields do not fit
  DamageList damages_;
};

/// CRC of a range of a file, read in blocks.
std::uint32_t crc32_of(const ByteSource& source, std::uint64_t begin, std::uint64_t end);

}  // namespace vestige::mcap
