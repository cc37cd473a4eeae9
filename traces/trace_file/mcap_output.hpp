#pragma once

#include <cstdint>
#include <functional>
#include <set>
#include <string>

#include "traces/mcap/writer.hpp"
#include "traces/trace_file/definitions.hpp"
#include "traces/trace_file/message_stream.hpp"

namespace vestige {

/// Writes a file anew from another one's records: definitions outside chunks, each once and before what needs it;
/// chunks as large as they were, 16 MiB at most.
class McapOutput {
 public:
  /// `profile` of the new file's header. Schemas and channels of `definitions` are known from the beginning, and
  /// written as soon as something needs them or `write_definitions` is called.
  McapOutput(mcap::Writer::Sink sink, const std::string& profile, mcap::Compression compression,
             Definitions definitions);

  /// All that are known so far.
  void write_definitions();
  /// A definition found on the way. Where there is one already, it stays. Throws `Error` when all schemas together take
  /// more than 256 MiB.
  void add(mcap::Schema schema);
  void add(mcap::Channel channel);

  /// Returns whether the message's channel is known; otherwise nothing is written.
  bool write(const mcap::Message& message);
  void write(const mcap::Attachment& attachment) { writer_.write(attachment); }
  void write(const mcap::Metadata& metadata) { writer_.write(metadata); }

  /// A chunk of the original ends here: the new one is closed before the next message.
  void end_chunk() { chunk_ended_ = true; }
  /// For messages that come from no chunk, or from several: ends a chunk of 1 MiB or more.
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
  std::set<std::uint16_t> schemas_lacking_;  ///< ids of schemas without which a channel was written
  bool chunk_ended_ = false;
};

}  // namespace vestige
