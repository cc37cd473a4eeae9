#pragma once

#include <array>

#include "traces/mcap/compression.hpp"
#include "traces/mcap/decode.hpp"
#include "traces/mcap/record.hpp"

namespace vestige::mcap {

/// Whether a CRC vouches for bytes, or the file has none for them; or whether they only decode.
enum class Trust { kVerified, kUnverified };

/// What is left of a chunk.
struct ChunkRemains {
  Bytes records;  ///< expanded, as far as they go; kVerified: all of them
  Trust trust = Trust::kUnverified;
};

/// Expands what can be expanded of a Chunk's content, which may be damaged or cut anywhere. `records` is in `out` or in
/// `content`. Empty where not even its first fields are there.
ChunkRemains salvage_chunk(Bytes content, RawBuffer& out);

/// Whether `content` is a whole chunk with a CRC that holds, whatever its opcode says.
bool is_whole_chunk(Bytes content, RawBuffer& out);

/// Steps through a chunk's expanded records where some may be damaged, or the end is missing. A record is believed when
/// its kind may stand in a chunk, it fits, and what follows looks like another; otherwise the next such place is looked
/// for. Takes linear time.
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
  std::array<std::size_t, 3> next_ = {};  ///< by opcode, where it stands next, if that is not behind
};

}  // namespace vestige::mcap
