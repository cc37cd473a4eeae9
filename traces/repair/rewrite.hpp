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
  std::optional<mcap::Compression> compression = {};  ///< nothing: that of the source's first chunk
  mcap::TimeRange range = {};
};

struct Rewritten {
  std::uint64_t messages = 0;  ///< written
  std::uint64_t bytes = 0;     ///< written
  std::uint64_t left_out = 0;  ///< messages outside the range
  std::uint64_t start_ns = 0;  ///< time of the first message kept
  std::uint64_t end_ns = 0;    ///< time of the last message kept
  mcap::DamageList damages;    ///< parts of the source that could not be read and are not in the new file
};

/// Writes a new version of a file through `sink`. Channels, attachments, metadata and chunks stay the same. The
/// compression may change, and only messages in the range are kept. Messages keep their sequence and times to the bit.
/// Memory: the largest record and chunk. Calls `progress` with the fraction done; it returns false to stop. Throws
/// `Error` if the source is not an MCAP file, has no message within the range, cannot be read, or the work was stopped.
/// Exceptions of `sink` pass through.
Rewritten rewrite_mcap(const mcap::ByteSource& source, const mcap::Writer::Sink& sink, const RewriteOptions& options,
                       const std::function<bool(double)>& progress);

}  // namespace vestige
