#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "traces/mcap/byte_source.hpp"
#include "traces/mcap/writer.hpp"

namespace vestige {

/// What came of recovering a file.
struct Recovery {
  std::uint64_t chunks_whole = 0;
  std::uint64_t chunks_partly = 0;  ///< some of whose messages still decoded
  std::uint64_t chunks_lost = 0;
  std::uint64_t messages = 0;                    ///< written
  std::uint64_t messages_unverified = 0;         ///< of those: from damaged chunks, so that no CRC vouches for them
  std::uint64_t messages_left_out = 0;           ///< that contradict the rest, or whose channel is unknown
  std::optional<std::uint64_t> messages_lost;    ///< nothing: the file does not say how many there were
  std::uint64_t attachments = 0;                 ///< written
  std::vector<std::string> damaged_attachments;  ///< written too, as NAME.damaged
  std::uint64_t metadata = 0;
  std::uint64_t bytes_lost = 0;  ///< of the file, that nothing could be made of, or that stand behind its end
  std::optional<std::uint64_t> another_file_at;  ///< the byte where a second MCAP file begins, which is left out
  bool unexplained_change = false;    ///< a byte that no other CRC covers has changed: the data section's CRC is wrong
  std::vector<std::string> repaired;  ///< what was broken and is whole again, one sentence each; the first 100

  bool lost_something() const {
    return chunks_partly + chunks_lost + messages_unverified + messages_left_out + bytes_lost +
                   damaged_attachments.size() >
               0 ||
           unexplained_change || messages_lost.value_or(0) > 0;
  }
};

/// Reads whatever can be read of `source`, damaged or not, and writes a complete MCAP file through `sink`, with every
/// channel, attachment and metadata as it was: every intact chunk, whatever records of the others still decode, and of
/// a trace of ours the frames that fit its avatar and each other, so that it can be replayed. Where something was lost,
/// a metadata record `recovered` in the new file says how much. Memory: the largest record and chunk, some 200 bytes a
/// chunk, and 16 MiB for frames that no CRC vouches for.
///
/// `progress` is told the share done and returns false to stop. Throws `Error`: the source is empty, nothing in it can
/// be recovered, reading failed, stopped; and what `sink` throws.
Recovery recover_mcap(const mcap::ByteSource& source, const mcap::Writer::Sink& sink,
                      const std::function<bool(double)>& progress);

}  // namespace vestige
