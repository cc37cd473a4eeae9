#pragma once

#include <array>

#include "traces/mcap/compression.hpp"
#include "traces/mcap/decode.hpp"
#include "traces/mcap/record.hpp"

namespace vestige::mcap {

/// How far decoded bytes can be trusted. kVerified: a CRC matches, or the file has no CRC for them. kUnverified: they
/// decode, and nothing more is known.
enum class Trust { kVerified, kUnverified };

/// The part of a chunk that could still be expanded.
struct ChunkRemains {
  Bytes records;  ///< the uncompressed records, up to the damage; kVerified: all of them
  Trust trust = Trust::kUnverified;
};

/// Expands as much of a Chunk's content as possible; the content may be damaged or cut anywhere. `records` of the
/// result lies in `out` or in `content`. It is empty if the chunk's own fields are incomplete.
ChunkRemains salvage_chunk(Bytes content, RawBuffer& out);

/// Whether `content` is a complete chunk whose CRC matches, regardless of the record's opcode.
bool is_whole_chunk(Bytes content, RawBuffer& out);

/// Steps through a chunk's uncompressed records if some of them may be damaged, or the last ones are missing. Accepts a
/// record if its kind may stand in a chunk, its length fits, and the bytes after it look like another record. Otherwise
/// searches forward for the next such place. Takes linear time.
class SalvagedRecords {
 public:
  explicit SalvagedRecords(Bytes records) : records_(records) {}

  bool next(InnerRecord& record);

 private:
  std::size_t next_opcode(std::size_t position);
  bool is_head(std::size_t offset) const;
  Opcode opcode_at(std::size_t offset) const { return static_cast<Opcode>(records_[offset]); }
  std::uint64_t length_at(std::size_t offset) const;
  bool is_believable(std::size_t offset) const;

  Bytes records_;
  std::size_t position_ = 0;
  std::array<std::size_t, 3> next_ = {};  ///< by inner opcode: next known position, if not behind `position_`
};

}  // namespace vestige::mcap
