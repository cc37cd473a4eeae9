#pragma once

#include "traces/mcap/compression.hpp"
#include "traces/mcap/record.hpp"

namespace vestige::mcap {

/// Expands a chunk's records into `out`, checking size and CRC. Throws `Malformed`.
Bytes expand_chunk(const Chunk& chunk, RawBuffer& out);

}  // namespace vestige::mcap
