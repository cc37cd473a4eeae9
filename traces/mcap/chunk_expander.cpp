#include "traces/mcap/chunk_expander.hpp"

#include "traces/mcap/crc32.hpp"
#include "traces/mcap/decode.hpp"

namespace vestige::mcap {

Bytes expand_chunk(const Chunk& chunk, RawBuffer& out) {
  Bytes records = chunk.records;
  if (!chunk.compression.empty() || chunk.uncompressed_size != records.size()) {
    decompress(chunk.compression, chunk.records, chunk.uncompressed_size, out);
    records = out.bytes();
  }
  if (chunk.uncompressed_crc != 0 && crc32(records) != chunk.uncompressed_crc) throw Malformed("its CRC is wrong");
  return records;
}

}  // namespace vestige::mcap
