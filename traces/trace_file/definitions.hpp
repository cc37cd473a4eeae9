#pragma once

#include <map>
#include <optional>

#include "traces/mcap/byte_source.hpp"
#include "traces/mcap/compression.hpp"
#include "traces/mcap/record.hpp"

namespace vestige {

/// What a file says about its messages, wherever in the file it says so.
struct Definitions {
  std::optional<mcap::Header> header;
  std::map<std::uint16_t, mcap::Schema> schemas;
  std::map<std::uint16_t, mcap::Channel> channels;
  std::optional<mcap::Statistics> statistics;         ///< of a summary whose CRC holds
  std::optional<mcap::Compression> compression = {};  ///< of the first chunk; nothing: there is no chunk
};

/// Gathers definitions outside chunks from the whole file, damaged or not. A summary whose CRC holds is believed before
/// the data section, in which no CRC vouches for a single definition. Throws `Error`: empty, reading failed.
Definitions gather_definitions(const mcap::ByteSource& source);

}  // namespace vestige
