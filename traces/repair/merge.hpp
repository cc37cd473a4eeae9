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
    mcap::DamageList list;  ///< the parts of the file that could not be read
  };
  /// A file whose metadata `session` differs from that of the first file, as if it belonged to another recording.
  struct OtherSession {
    std::string file;
    std::vector<std::string> keys;  ///< keys that differ, or that only one of the two files has
  };
  std::uint64_t messages = 0;        ///< written
  std::uint64_t frames = 0;          ///< written
  std::uint64_t duplicates = 0;      ///< own messages found, identical to the bit, in several files
  std::uint64_t missing_frames = 0;  ///< numbers between the first and last frame that no file has
  std::vector<Damages> damages;      ///< only of files that have damage
  std::vector<OtherSession> other_sessions;
};

/// Merges traces that are parts of one recording, such as `trim` makes. Frames come in order of time, each once, with
/// the foreign messages (/viz) that the first file with this frame has. Each attachment and metadata record comes once.
/// The compression is that of the first file. Keeps one chunk, or the largest record, of each file in memory, however
/// many messages one moment has.
///
/// Throws `Error` with file and reason: not a Vestige trace; another avatar or actuator map; other definitions of a
/// channel; a frame that differs between two files; frames whose numbers do not follow their times; reading failed;
/// stopped by `progress`.
Merged merge_traces(const std::vector<std::unique_ptr<mcap::ByteSource>>& sources, const mcap::Writer::Sink& sink,
                    const std::function<bool(double)>& progress);

}  // namespace vestige
