#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "traces/mcap/byte_source.hpp"
#include "traces/mcap/writer.hpp"
#include "traces/repair/replacement.hpp"

namespace vestige {

/// The result of recovering a file.
struct Recovery {
  std::uint64_t chunks_whole = 0;
  std::uint64_t chunks_partly = 0;  ///< chunks of which some messages still decoded
  std::uint64_t chunks_lost = 0;
  std::uint64_t messages = 0;                    ///< written
  std::uint64_t messages_unverified = 0;         ///< of those: from damaged chunks, so no CRC verifies them
  std::uint64_t messages_left_out = 0;           ///< messages that contradict the rest, or whose channel is unknown
  std::optional<std::uint64_t> messages_lost;    ///< nothing: the file does not say how many messages there were
  std::uint64_t attachments = 0;                 ///< written
  std::vector<std::string> damaged_attachments;  ///< written too, as NAME.damaged
  /// An attachment that came from a substitute.
  struct Replaced {
    std::string name;
    std::string from;
    bool is_recorded = false;  ///< otherwise the new file says that it is another one
    bool is_left_out = false;  ///< the substitute has no such file
  };
  std::vector<Replaced> replaced;
  std::vector<std::string> unused;  ///< substitutes that nothing needed, as the user named them
  std::uint64_t metadata = 0;
  std::uint64_t bytes_lost = 0;                  ///< bytes of the file that could not be used, or that follow its end
  std::optional<std::uint64_t> another_file_at;  ///< offset of a second MCAP file, which is left out
  bool unexplained_change = false;    ///< a byte that no other CRC covers has changed: the data section's CRC is wrong
  std::vector<std::string> repaired;  ///< broken parts that were repaired, one sentence each; the first 100

  bool has_other_attachments() const {
    return std::ranges::any_of(replaced, [](const Replaced& each) { return !each.is_recorded; });
  }
  bool lost_something() const {
    return chunks_partly + chunks_lost + messages_unverified + messages_left_out + bytes_lost +
                   damaged_attachments.size() >
               0 ||
           unexplained_change || has_other_attachments() || messages_lost.value_or(0) > 0;
  }
};

/// Reads as much of `source` as possible, damaged or not, and writes a complete MCAP file through `sink`. The new file
/// has every channel, attachment and metadata record as it was. It has every intact chunk, and the records of damaged
/// chunks that still decode. For a Vestige trace it has the frames that fit the avatar and each other, so the trace can
/// be replayed. Attachments that are damaged, missing or not the recorded ones are replaced from `substitutes`; a
/// metadata record `replaced` names those that are not the recorded ones. If something was lost, a metadata record
/// `recovered` in the new file says how much. Memory: the largest record and chunk, some 200 bytes a chunk, and 16 MiB
/// for unverified frames.
///
/// Calls `progress` with the fraction done; it returns false to stop. Throws `Error` if the source is empty, nothing in
/// it can be recovered, reading failed, it was stopped, or a substitute is refused (`plan_replacements`). Exceptions of
/// `sink` pass through.
Recovery recover_mcap(const mcap::ByteSource& source, const mcap::Writer::Sink& sink,
                      const std::function<bool(double)>& progress, const Substitutes& substitutes = {});

}  // namespace vestige
