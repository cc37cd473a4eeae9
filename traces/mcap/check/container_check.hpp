#pragma once

#include <functional>
#include <optional>
#include <string>

#include "traces/mcap/byte_source.hpp"
#include "traces/mcap/check/problem.hpp"
#include "traces/mcap/record.hpp"

namespace vestige::mcap {

/// A record that a check came by: undamaged as far as anything vouches for it.
struct CheckedRecord {
  Opcode opcode = Opcode::kMessage;
  Bytes content;                                      ///< valid during the call
  std::uint64_t offset = 0;                           ///< in the file; inside a chunk, the chunk's
  std::uint64_t bytes = 0;                            ///< of the record, or of the chunk
  std::optional<std::uint64_t> offset_in_chunk = {};  ///< from the start of the chunk's expanded records
};

/// What a file turned out to hold.
struct ContainerFacts {
  bool begins_as_mcap = false;  ///< with the magic bytes
  bool has_footer = false;
  std::uint64_t records = 0;  ///< outside chunks
  std::uint64_t messages = 0;
  std::uint64_t chunks = 0;
  std::uint64_t damaged_chunks = 0;
  std::uint64_t attachments = 0;  ///< undamaged ones
  std::uint64_t metadata = 0;
};

/// Reads everything in a file, damaged or not, and adds to `problems` whatever breaks MCAP's rules or contradicts
/// itself: framing, every CRC, compression, definitions, message indexes, summary, footer. `visit` is given every
/// Header, Schema, Channel, Message, Attachment and Metadata of the data section. `progress` is told
/// the share done and returns false to stop.
///
/// Needs as much memory as the largest record and chunk, and some 200 bytes a chunk. Throws `Error`: the source is
/// empty, reading failed, stopped.
ContainerFacts check_container(const ByteSource& source, ProblemList& problems,
                               const std::function<void(const CheckedRecord&)>& visit,
                               const std::function<bool(double)>& progress);

}  // namespace vestige::mcap
