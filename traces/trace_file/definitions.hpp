#pragma once

#include <map>
#include <optional>

#include "traces/mcap/byte_source.hpp"
#include "traces/mcap/compression.hpp"
#include "traces/mcap/record.hpp"
#include "traces/trace_file/message_stream.hpp"

namespace vestige {

/// A file's definitions of its messages, from anywhere in the file.
struct Definitions {
  std::optional<mcap::Header> header;
  std::map<std::uint16_t, mcap::Schema> schemas;
  std::map<std::uint16_t, mcap::Channel> channels;
  std::optional<mcap::Statistics> statistics;         ///< from a summary whose CRC matches
  std::optional<mcap::Compression> compression = {};  ///< of the first chunk; nothing: the file has no chunk
};

/// Returns which of the channels are Vestige's own.
StreamTable streams_of(const Definitions& definitions);

/// Gathers definitions outside chunks from the whole file, damaged or not. A summary whose CRC matches takes precedence
/// over the data section, where no CRC covers a single definition. Throws `Error` if the source is empty or reading
/// fails.
Definitions gather_definitions(const mcap::ByteSource& source);

}  // namespace vestige
