#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <vector>

#include "traces/mcap/compression.hpp"
#include "traces/mcap/encode.hpp"
#include "traces/mcap/record.hpp"

namespace vestige::mcap {

enum class Chunking { kChunks, kNone };
/// Where schemas and channels go in a chunked file: into the open chunk, or before it, so that a damaged chunk does not
/// lose them.
enum class DefinitionPlace { kInChunks, kBeforeChunks };

/// What a file contains besides its data. Everything is on by default. The switches serve to write files as other
/// programs write them.
struct WriterOptions {
  Chunking chunking = Chunking::kChunks;
  Compression compression = Compression::kNone;
  DefinitionPlace definitions = DefinitionPlace::kInChunks;
  bool message_index = true;
  bool statistics = true;
  bool repeat_schemas = true;
  bool repeat_channels = true;
  bool chunk_index = true;
  bool attachment_index = true;
  bool metadata_index = true;
  bool summary_offsets = true;
};

/// Writes an MCAP file from front to back through `sink`, without seeking, so `sink` may write to a pipe. Each chunk
/// and its message indexes are one call of the sink. Exceptions of the sink pass through; after one, the writer must
/// not be used again.
class Writer {
 public:
  using Sink = std::function<void(Bytes)>;

  Writer(Sink sink, const Header& header, const WriterOptions& options);

  void write(const Schema& schema);
  /// Precondition: the channel's schema was written before.
  void write(const Channel& channel);
  /// Precondition: the message's channel was written before.
  void write(const Message& message);
  /// Writes the attachment before the open chunk, and computes the record's CRC.
  void write(const Attachment& attachment);
  /// Goes before the open chunk.
  void write(const Metadata& metadata);

  /// Writes the open chunk, unless it is empty.
  void close_chunk();
  /// Closes the chunk, then writes summary and footer.
  void finish();

  std::size_t open_chunk_bytes() const { return chunk_.size(); }
  /// Upper bound of the file's size if `finish` is called now.
  std::uint64_t bytes_if_finished() const;
  std::uint64_t bytes_written() const { return offset_; }
  const Statistics& statistics() const { return statistics_; }

 private:
  template <typename Record>
  void write_definition(const Record& record);
  void emit(Bytes bytes);
  template <typename Record>
  void emit_record(const Record& record);
  void append_summary(ByteBuffer& out);

  Sink sink_;
  WriterOptions options_;
  std::uint64_t offset_ = 0;
  std::uint32_t crc_ = 0;               ///< of everything written so far
  std::uint64_t definition_bytes_ = 0;  ///< upper bound of the summary bytes of schemas, channels and indexes
  ByteBuffer scratch_;
  ByteBuffer chunk_;  ///< uncompressed records
  ByteBuffer compressed_;
  std::uint64_t chunk_start_time_ = 0;
  std::uint64_t chunk_end_time_ = 0;
  std::map<std::uint16_t, MessageIndex> chunk_message_indexes_;

  std::map<std::uint16_t, Schema> schemas_;
  std::map<std::uint16_t, Channel> channels_;
  std::vector<ChunkIndex> chunk_indexes_;
  std::vector<AttachmentIndex> attachment_indexes_;
  std::vector<MetadataIndex> metadata_indexes_;
  Statistics statistics_;
};

}  // namespace vestige::mcap
