#pragma once

#include <cstdint>
#include <functional>
#include <optional>

#include "traces/mcap/byte_source.hpp"
#include "traces/mcap/record_walker.hpp"
#include "traces/mcap/time_range.hpp"
#include "traces/mcap/writer.hpp"

namespace vestige {

struct RewriteOptions {
  std::optional<mcap::Compression> compression = {};  ///< nothing: as its first chunk is
  mcap::TimeRange range = {};
};

struct Rewritten {
  std::uint64_t messages = 0;  ///< written
  std::uint64_t bytes = 0;     ///< written
  std::uint64_t left_out = 0;  ///< messages outside the range
  std::uint64_t start_ns = 0;  ///< of the first message kept
  std::uint64_t end_ns = 0;    ///< of the last
  mcap::DamageList damages;    ///< what of the source could not be read, and is not in the new file
};

/// Writes a file anew through `sink`: the same channels, attachments, metadata and chunks, other compression or only
/// some of the messages. Messages keep their sequence and times to the bit. Memory: the largest record and chunk.
/// `progress` is told the share done and returns false to stop. Throws `Error`: no MCAP file, no message within the
/// range, reading failed, stopped; and what `sink` throws.
Rewritten rewrite_mcap(const mcap::ByteSource& source, const mcap::Writer::Sink& sink, const RewriteOptions& options,
                       const std::function<bool(double)>& progress);

}  // namespace vestige
