#pragma once

#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "traces/mcap/byte_source.hpp"
#include "traces/mcap/record_walker.hpp"
#include "traces/scene/trace.hpp"
#include "traces/trace_file/message_stream.hpp"
#include "traces/trace_file/session_check.hpp"

namespace vestige {

/// The parts of a trace file that are read before its frames.
struct TraceIndex {
  bool profile_is_ours = false;
  Session session;
  std::uint64_t session_offset = 0;
  std::optional<mcap::StringMap> recovered;  ///< the metadata record "recovered"
  mcap::StringMap replaced;                  ///< the metadata record "replaced"; empty if there is none
  std::map<std::string, std::vector<std::byte>> attachments;  ///< Vestige's own that are undamaged, by name
  std::size_t people = 1;                                     ///< see `people_of`
  StreamTable streams;
  std::vector<MessagePlace> places;  ///< in file order
  bool has_footer = false;
  mcap::DamageList damages;

  AttachmentClaims claims() const {
    return {.session = session,
            .pose = pose_metadata(streams),
            .replaced = replaced,
            .version_of_schemas = streams.version_of_schemas()};
  }
  /// Returns the bytes of an attachment; empty if there is no undamaged one.
  std::span<const std::byte> attachment(trace_format::AttachmentKind kind, std::size_t person = 0) const;
};

/// Reads the index from the summary if that is complete, otherwise by scanning the file. Throws `Error` if the file is
/// not an MCAP file, reading fails, or a later version of vestige wrote it.
TraceIndex index_trace(const mcap::ByteSource& source);

/// "FILE: at byte 123: a Chunk: its CRC is wrong; 456 bytes are lost".
std::string describe(const mcap::Damage& damage, std::string_view file);

}  // namespace vestige
