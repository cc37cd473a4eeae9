#pragma once

#include <functional>
#include <optional>
#include <string>

#include "traces/mcap/byte_source.hpp"
#include "traces/mcap/check/problem.hpp"
#include "traces/mcap/record.hpp"

namespace vestige::mcap {

/// A record that the check visits. Nothing that can be verified says that it is damaged.
struct CheckedRecord {
  Opcode opcode = Opcode::kMessage;
  Bytes content;             ///< valid during the call
  std::uint64_t offset = 0;  ///< in the file; for a record inside a chunk, the offset of the chunk
  std::uint64_t bytes = 0;   ///< size of the record, or of the chunk around it
  std::optional<std::uint64_t> offset_in_chunk = {};  ///< from the start of the chunk's uncompressed records
};

/// What the check found in a file.
struct ContainerFacts {
  bool begins_as_mcap = false;  ///< the file begins with the magic bytes
  bool has_footer = false;
  std::uint64_t records = 0;  ///< outside chunks
  std::uint64_t messages = 0;
  std::uint64_t chunks = 0;
  std::uint64_t damaged_chunks = 0;
  std::uint64_t attachments = 0;  ///< undamaged ones
  std::uint64_t metadata = 0;
};

/// Reads a whole file, damaged or not. Adds to `problems` everything that breaks MCAP's rules or contradicts itself:
/// framing, every CRC, compression, definitions, message indexes, summary, footer. Calls `visit` with every Header,
/// Schema, Channel, Message, Attachment and Metadata of the data section. Calls `progress` with the fraction done; it
/// returns false to stop the check.
///
/// Needs as much memory as the largest record and chunk, plus some 200 bytes a chunk. Throws `Error` if the source is
/// empty, reading fails, or the check was stopped.
ContainerFacts check_container(const ByteSource& source, ProblemList& problems,
                               const std::function<void(const CheckedRecord&)>& visit,
                               const std::function<bool(double)>& progress);

}  // namespace vestige::mcap
