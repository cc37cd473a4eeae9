#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include "traces/mcap/byte_source.hpp"
#include "traces/mcap/chunk_expander.hpp"
#include "traces/mcap/compression.hpp"
#include "traces/mcap/decode.hpp"
#include "traces/mcap/record_walker.hpp"
#include "traces/trace_file/trace_format.hpp"

namespace vestige {

/// Which of a file's channels are Vestige's own. A file rewritten by another program may define channels inside chunks
/// only, so this table grows while reading.
class StreamTable {
 public:
  void add(mcap::Schema schema);
  void add(mcap::Channel channel);
  trace_format::Stream stream_of(std::uint16_t channel_id) const {
    const trace_format::StreamId stream = id_of(channel_id);
    return is_foreign(stream.person) ? trace_format::Stream::kForeign : stream.stream;
  }
  /// Whose pose a channel carries.
  std::size_t person_of(std::uint16_t channel_id) const { return id_of(channel_id).person; }
  /// Returns the stream's channel, or null until it is known. Of /pose, that of a person.
  const mcap::Channel* find(trace_format::Stream stream, std::size_t person = 0) const;
  /// Returns the channels /pose that are known, by person.
  std::map<std::size_t, const mcap::Channel*> pose_channels() const;
  /// Whether the schema of /colliders is of a format version whose traces hold one person.
  bool knows_one_person() const { return knows_one_person_; }
  /// Returns the format version that has all schemas of Vestige's own channels; nothing if none has.
  std::optional<int> version_of_schemas() const;

 private:
  void update(const mcap::Channel& channel);
  trace_format::StreamId id_of(std::uint16_t channel_id) const {
    return channel_id < streams_.size() ? streams_[channel_id] : trace_format::StreamId{};
  }
  /// A trace of an earlier format version may have a channel /pose/2 of another program.
  bool is_foreign(std::size_t person) const { return person > 0 && knows_one_person_; }

  bool knows_one_person_ = false;  ///< by the schema of /colliders
  std::map<std::uint16_t, mcap::Schema> schemas_;
  std::map<std::uint16_t, mcap::Channel> channels_;
  std::set<std::pair<std::uint16_t, std::uint16_t>> channels_of_schema_;  ///< schema's id, channel's id
  std::map<trace_format::StreamId, std::uint16_t> channel_of_;  ///< the lowest id, if several channels are recognised
  std::vector<trace_format::StreamId> streams_;                 ///< by channel id, up to the largest id that was added
};

/// A message of one of Vestige's own streams.
struct TraceMessage {
  trace_format::Stream stream = trace_format::Stream::kForeign;
  std::size_t person = 0;    ///< whose pose
  std::uint64_t offset = 0;  ///< in the file: of the message, or of the chunk that holds it
  mcap::Message message;
};

/// A place in a file that holds messages: a chunk, or a run of messages outside chunks. A file may have millions of
/// messages outside chunks.
struct MessagePlace {
  bool in_chunk = false;
  std::uint64_t begin = 0;  ///< start of the record of the chunk or of the first message
  std::uint64_t end = 0;
};

/// Delivers the messages of Vestige's own streams in file order, from the places that hold them.
class MessageStream {
 public:
  using Report = std::function<void(const mcap::Damage&)>;

  /// Keeps references to `source`, `places` and `table`. Damage is skipped and passed to `report`. Other threads than
  /// the calling one, if `threads` is more than 1, expand chunks ahead.
  MessageStream(const mcap::ByteSource& source, const std::vector<MessagePlace>& places, StreamTable& table,
                std::size_t threads, Report report);

  /// Reads the next message; its data are valid until the next call. Returns false at the end.
  bool next(TraceMessage& message);
  void rewind();

 private:
  bool next_in_chunk(TraceMessage& message);
  bool next_in_run(TraceMessage& message);
  void open_chunk(const MessagePlace& place);
  void add_chunks();
  bool take(std::uint64_t offset, mcap::Bytes content, TraceMessage& message);

  const mcap::ByteSource& source_;
  const std::vector<MessagePlace>& places_;
  StreamTable& table_;
  Report report_;
  mcap::ChunkQueue chunks_;
  std::size_t next_place_ = 0;
  std::size_t next_to_add_ = 0;  ///< to `chunks_`, of the places
  std::uint64_t chunk_offset_ = 0;
  bool misfit_told_ = false;  ///< whether this chunk's misfits were reported
  mcap::Cursor chunk_ = mcap::Cursor({});
  MessagePlace run_;  ///< the rest of the current run
  mcap::RawBuffer content_;
};

}  // namespace vestige
