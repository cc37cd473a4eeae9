#pragma once

#include <cstdint>
#include <functional>
#include <set>
#include <string>

#include "traces/mcap/record_walker.hpp"
#include "traces/mcap/writer.hpp"
#include "traces/trace_file/definitions.hpp"
#include "traces/trace_file/message_stream.hpp"

namespace vestige {

/// Writes a new file from the records of another one. Definitions go outside chunks, each once and before its first
/// use. Chunks end where the caller says, and after 16 MiB at the latest.
class McapOutput {
 public:
  /// `profile` goes into the new file's header. Schemas and channels of `definitions` are known from the beginning.
  /// They are written at their first use or by `write_definitions`.
  McapOutput(mcap::Writer::Sink sink, const std::string& profile, mcap::Compression compression,
             Definitions definitions);

  /// Writes all definitions known so far.
  void write_definitions();
  /// Adds a definition found while reading. An existing definition with the same id stays. Throws `Error` if all
  /// schemas together take more than 256 MiB.
  void add(mcap::Schema schema);
  void add(mcap::Channel channel);

  /// Writes a message. Returns false and writes nothing if its channel is unknown: see `undefined_channel`.
  bool write(const mcap::Message& message);
  void write(const mcap::Attachment& attachment) { writer_.write(attachment); }
  void write(const mcap::Metadata& metadata) { writer_.write(metadata); }

  /// Marks the end of a chunk of the original. The new chunk is closed before the next message.
  void end_chunk() { chunk_ended_ = true; }
  /// Ends the open chunk if it has 1 MiB or more, for messages that come from no chunk or from several.
  void end_full_chunk();
  void finish() { writer_.finish(); }

  const StreamTable& streams() const { return streams_; }
  const Definitions& definitions() const { return definitions_; }
  const mcap::Statistics& statistics() const { return writer_.statistics(); }
  std::uint64_t bytes_written() const { return writer_.bytes_written(); }

 private:
  void learn(const mcap::Schema& schema);
  bool define(std::uint16_t channel_id);
  void write_schema(std::uint16_t id);

  mcap::Writer writer_;
  Definitions definitions_;
  StreamTable streams_;
  std::size_t schema_bytes_ = 0;
  std::set<std::uint16_t> schemas_written_;
  std::set<std::uint16_t> channels_written_;
  std::set<std::uint16_t> schemas_lacking_;  ///< ids of missing schemas whose channels were written without them
  bool chunk_ended_ = false;
};

/// The damage that messages of a channel which nothing defines are.
mcap::Damage undefined_channel(std::uint64_t offset, std::uint16_t channel_id);

}  // namespace vestige
