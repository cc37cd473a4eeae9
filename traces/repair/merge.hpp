#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "traces/mcap/byte_source.hpp"
#include "traces/mcap/record_walker.hpp"
#include "traces/mcap/writer.hpp"

namespace vestige {

struct Merged {
  struct Damages {
    std::string file;
    mcap::DamageList list;  ///< what of it could not be read
  };
  /// A file whose metadata `session` is not that of the first, as if it were of another recording.
  struct OtherSession {
    std::string file;
    std::vector<std::string> keys;  ///< that differ, or that one of them lacks
  };
  std::uint64_t messages = 0;        ///< written
  std::uint64_t frames = 0;          ///< written
  std::uint64_t duplicates = 0;      ///< of our messages, those that stood in several files, the same to the bit
  std::uint64_t missing_frames = 0;  ///< numbers between the first and the last frame that no file has
  std::vector<Damages> damages;      ///< of the files that have any
  std::vector<OtherSession> other_sessions;
};

/// Puts traces together that are parts of one recording, such as `trim` makes: their frames in order of time, each
/// once, with the messages of others (/viz) that the first file has of it; every attachment and metadata once;
/// compressed as the first is. Keeps one chunk, or the largest record, of each file in memory, however many messages a
/// moment has.
///
/// Throws `Error`, naming file and reason: no trace of ours; another avatar or actuator map; other definitions of a
/// channel; a frame that two files have and that differs; frames whose numbers do not follow their times; reading
/// failed; stopped by `progress`.
Merged merge_traces(const std::vector<std::unique_ptr<mcap::ByteSource>>& sources, const mcap::Writer::Sink& sink,
                    const std::function<bool(double)>& progress);

}  // namespace vestige
