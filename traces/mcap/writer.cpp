#include "traces/mcap/writer.hpp"

#include <algorithm>
#include <utility>

#include "traces/mcap/crc32.hpp"

namespace vestige::mcap {

namespace {

/// Upper bound of the fixed part of an index record or of statistics.
constexpr std::uint64_t kMostIndexBytes = 128;
/// Size of a channel's entry in those records: id and offset, or id and count.
constexpr std::uint64_t kIndexEntryBytes = 10;
/// Upper bound of DataEnd, the offsets of six groups, footer and magic bytes, which take 157 bytes.
constexpr std::uint64_t kMostEndBytes = 160;

}  // namespace

Writer::Writer(Sink sink, const Header& header, const WriterOptions& options)
    : sink_(std::move(sink)), options_(options) {
  append_magic(scratch_);
  append_record(scratch_, header);
  emit(scratch_);
}

void Writer::emit(Bytes bytes) {
  sink_(bytes);
  crc_ = crc32(bytes, crc_);
  offset_ += bytes.size();
}

template <typename Record>
void Writer::emit_record(const Record& record) {
  scratch_.clear();
  append_record(scratch_, record);
  emit(scratch_);
}

template <typename Record>
void Writer::write_definition(const Record& record) {
  ByteBuffer encoded;
  append_record(encoded, record);
  definition_bytes_ += encoded.size();
  if (options_.chunking == Chunking::kChunks && options_.definitions == DefinitionPlace::kInChunks) {
    append_record(chunk_, record);
  } else {
    emit_record(record);
  }
}

void Writer::write(const Schema& schema) {
  write_definition(schema);
  schemas_.insert_or_assign(schema.id, schema);
}

void Writer::write(const Channel& channel) {
  write_definition(channel);
  channels_.insert_or_assign(channel.id, channel);
}

void Writer::write(const Message& message) {
  if (options_.chunking == Chunking::kChunks) {
    if (chunk_message_indexes_.empty()) chunk_start_time_ = chunk_end_time_ = message.log_time;
    chunk_start_time_ = std::min(chunk_start_time_, message.log_time);
    chunk_end_time_ = std::max(chunk_end_time_, message.log_time);
    MessageIndex& index = chunk_message_indexes_[message.channel_id];
    index.channel_id = message.channel_id;
    index.entries.push_back({.log_time = message.log_time, .offset = chunk_.size()});
    append_record(chunk_, message);
  } else {
    emit_record(message);
  }
  if (statistics_.message_count == 0) statistics_.message_start_time = message.log_time;
  statistics_.message_start_time = std::min(statistics_.message_start_time, message.log_time);
  statistics_.message_end_time = std::max(statistics_.message_end_time, message.log_time);
  ++statistics_.message_count;
  ++statistics_.channel_message_counts[message.channel_id];
}

void Writer::write(const Attachment& attachment) {
  AttachmentIndex index{.offset = offset_,
                        .length = 0,
                        .log_time = attachment.log_time,
                        .create_time = attachment.create_time,
                        .data_size = attachment.data.size(),
                        .name = attachment.name,
                        .media_type = attachment.media_type};
  ByteBuffer head;
  append_attachment_head(head, attachment);
  emit(head);
  emit(attachment.data);
  scratch_.clear();
  append_attachment_crc(scratch_, head, attachment.data);
  emit(scratch_);
  index.length = offset_ - index.offset;
  definition_bytes_ += kMostIndexBytes + index.name.size() + index.media_type.size();
  attachment_indexes_.push_back(std::move(index));
  ++statistics_.attachment_count;
}

void Writer::write(const Metadata& metadata) {
  const std::uint64_t offset = offset_;
  emit_record(metadata);
  definition_bytes_ += kMostIndexBytes + metadata.name.size();
  metadata_indexes_.push_back({.offset = offset, .length = offset_ - offset, .name = metadata.name});
  ++statistics_.metadata_count;
}

std::uint64_t Writer::bytes_if_finished() const {
  const std::uint64_t index_bytes = kMostIndexBytes + kIndexEntryBytes * channels_.size();
  std::uint64_t bytes = offset_ + definition_bytes_ + kMostEndBytes + index_bytes * (chunk_indexes_.size() + 1);
  if (chunk_.empty()) return bytes;
  // Incompressible data grow: in zstd by a little more than 1/256, in LZ4 by 4 bytes a block plus the frame header.
  bytes += chunk_.size() + chunk_.size() / 128 + 1024 + index_bytes;
  for (const auto& [channel, index] : chunk_message_indexes_) bytes += 32 + 16 * index.entries.size();
  return bytes;
}

void Writer::close_chunk() {
  if (chunk_.empty()) return;
  compressed_.clear();
  compress(options_.compression, chunk_, compressed_);
  ChunkIndex index{.message_start_time = chunk_start_time_,
                   .message_end_time = chunk_end_time_,
                   .chunk_start_offset = offset_,
                   .chunk_length = 0,
                   .message_index_offsets = {},
                   .message_index_length = 0,
                   .compression = std::string(name_of(options_.compression)),
                   .compressed_size = compressed_.size(),
                   .uncompressed_size = chunk_.size()};
  scratch_.clear();
  append_record(scratch_, Chunk{.message_start_time = chunk_start_time_,
                                .message_end_time = chunk_end_time_,
                                .uncompressed_size = chunk_.size(),
                                .uncompressed_crc = crc32(chunk_),
                                .compression = index.compression,
                                .records = compressed_});
  index.chunk_length = scratch_.size();
  if (options_.message_index) {
    for (const auto& [channel, message_index] : chunk_message_indexes_) {
      index.message_index_offsets[channel] = offset_ + scratch_.size();
      append_record(scratch_, message_index);
    }
  }
  index.message_index_length = scratch_.size() - index.chunk_length;
  emit(scratch_);

  chunk_indexes_.push_back(std::move(index));
  ++statistics_.chunk_count;
  chunk_.clear();
  chunk_message_indexes_.clear();
  chunk_start_time_ = chunk_end_time_ = 0;
}

void Writer::append_summary(ByteBuffer& out) {
  std::vector<SummaryOffset> groups;
  const auto group = [&](Opcode opcode, auto append_all) {
    const std::size_t start = out.size();
    append_all();
    if (out.size() > start)
      groups.push_back({.group_opcode = opcode, .group_start = offset_ + start, .group_length = out.size() - start});
  };
  const auto append_values = [&](const auto& map) {
    for (const auto& [id, record] : map) append_record(out, record);
  };
  const auto append_each = [&](const auto& records) {
    for (const auto& record : records) append_record(out, record);
  };

  if (options_.repeat_schemas) group(Opcode::kSchema, [&] { append_values(schemas_); });
  if (options_.repeat_channels) group(Opcode::kChannel, [&] { append_values(channels_); });
  if (options_.statistics) group(Opcode::kStatistics, [&] { append_record(out, statistics_); });
  if (options_.chunk_index) group(Opcode::kChunkIndex, [&] { append_each(chunk_indexes_); });
  if (options_.attachment_index) group(Opcode::kAttachmentIndex, [&] { append_each(attachment_indexes_); });
  if (options_.metadata_index) group(Opcode::kMetadataIndex, [&] { append_each(metadata_indexes_); });

  Footer footer{.summary_start = out.empty() ? 0 : offset_, .summary_offset_start = 0, .summary_crc = 0};
  if (options_.summary_offsets && !groups.empty()) {
    footer.summary_offset_start = offset_ + out.size();
    append_each(groups);
  }
  append_record(out, footer);
  // The CRC covers everything up to itself, so it can only be filled in now.
  footer.summary_crc = crc32(Bytes(out).first(out.size() - sizeof footer.summary_crc));
  out.erase(out.end() - std::ptrdiff_t{kRecordHeadBytes + kFooterContentBytes}, out.end());
  append_record(out, footer);
}

void Writer::finish() {
  close_chunk();
  statistics_.schema_count = static_cast<std::uint16_t>(schemas_.size());
  statistics_.channel_count = static_cast<std::uint32_t>(channels_.size());
  emit_record(DataEnd{.data_section_crc = crc_});
  scratch_.clear();
  append_summary(scratch_);
  append_magic(scratch_);
  emit(scratch_);
}

}  // namespace vestige::mcap
