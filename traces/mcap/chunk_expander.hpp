#pragma once

#include "traces/mcap/compression.hpp"
#include "traces/mcap/record.hpp"

namespace vestige::mcap {

/// Expands a chunk's records and checks their size and CRC. The result lies in `out`, or in `chunk.records` if they are
/// not compressed. Throws `Malformed`.
Bytes expand_chunk(const Chunk& chunk, RawBuffer& out);

}  // namespace vestige::mcap
