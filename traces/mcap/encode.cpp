#include "traces/mcap/encode.hpp"

#include <cstring>
#include <limits>
#include <stdexcept>

#include "traces/mcap/crc32.hpp"
#include "traces/mcap/decode.hpp"

namespace vestige::mcap {

namespace {

std::uint32_t length32(std::size_t length) {
  if (length > std::numeric_limits<std::uint32_t>::max())
    throw std::length_error("a field of an MCAP record would be larger than 4 GiB");
  return static_cast<std::uint32_t>(length);
}

void put(ByteBuffer& out, Bytes bytes) {
  out.insert(out.end(), bytes.begin(), bytes.end());
}

template <typename Number>
void put_number(ByteBuffer& out, Number value) {
  put(out, std::as_bytes(std::span(&value, 1)));
}

void put_text(ByteBuffer& out, std::string_view text) {
  put_number(out, length32(text.size()));
  put(out, std::as_bytes(std::span(text)));
}

template <typename Number>
void overwrite_number(ByteBuffer& out, std::size_t at, Number value) {
  std::memcpy(out.data() + at, &value, sizeof value);
}

/// Writes an opcode and a length; the length is filled in once the content is complete.
class RecordScope {
 public:
  RecordScope(ByteBuffer& out, Opcode opcode) : out_(out) {
    put_number(out_, static_cast<std::uint8_t>(opcode));
    length_at_ = out_.size();
    put_number(out_, std::uint64_t{0});
  }
  ~RecordScope() { overwrite_number(out_, length_at_, std::uint64_t{out_.size() - length_at_ - 8}); }
  RecordScope(const RecordScope&) = delete;
  RecordScope& operator=(const RecordScope&) = delete;

 private:
  ByteBuffer& out_;
  std::size_t length_at_ = 0;
};

/// Calls `put_content` and writes the length of its output, in bytes, in front of that output.
template <typename PutContent>
void put_sized(ByteBuffer& out, PutContent put_content) {
  const std::size_t length_at = out.size();
  put_number(out, std::uint32_t{0});
  put_content();
  overwrite_number(out, length_at, length32(out.size() - length_at - 4));
}

void put_map(ByteBuffer& out, const StringMap& map) {
  put_sized(out, [&] {
    for (const auto& [key, value] : map) {
      put_text(out, key);
      put_text(out, value);
    }
  });
}

void put_map(ByteBuffer& out, const std::map<std::uint16_t, std::uint64_t>& map) {
  put_sized(out, [&] {
    for (const auto& [key, value] : map) {
      put_number(out, key);
      put_number(out, value);
    }
  });
}

}  // namespace

void append_record(ByteBuffer& out, const Header& record) {
  const RecordScope scope(out, Opcode::kHeader);
  put_text(out, record.profile);
  put_text(out, record.library);
}

void append_record(ByteBuffer& out, const Footer& record) {
  const RecordScope scope(out, Opcode::kFooter);
  put_number(out, record.summary_start);
  put_number(out, record.summary_offset_start);
  put_number(out, record.summary_crc);
}

void append_record(ByteBuffer& out, const Schema& record) {
  const RecordScope scope(out, Opcode::kSchema);
  put_number(out, record.id);
  put_text(out, record.name);
  put_text(out, record.encoding);
  put_number(out, length32(record.data.size()));
  put(out, record.data);
}

void append_record(ByteBuffer& out, const Channel& record) {
  const RecordScope scope(out, Opcode::kChannel);
  put_number(out, record.id);
  put_number(out, record.schema_id);
  put_text(out, record.topic);
  put_text(out, record.message_encoding);
  put_map(out, record.metadata);
}

void append_record(ByteBuffer& out, const Message& record) {
  const RecordScope scope(out, Opcode::kMessage);
  put_number(out, record.channel_id);
  put_number(out, record.sequence);
  put_number(out, record.log_time);
  put_number(out, record.publish_time);
  put(out, record.data);
}

void append_record(ByteBuffer& out, const Chunk& record) {
  const RecordScope scope(out, Opcode::kChunk);
  put_number(out, record.message_start_time);
  put_number(out, record.message_end_time);
  put_number(out, record.uncompressed_size);
  put_number(out, record.uncompressed_crc);
  put_text(out, record.compression);
  put_number(out, std::uint64_t{record.records.size()});
  put(out, record.records);
}

void append_record(ByteBuffer& out, const MessageIndex& record) {
  const RecordScope scope(out, Opcode::kMessageIndex);
  put_number(out, record.channel_id);
  put_sized(out, [&] {
    for (const MessageIndexEntry& entry : record.entries) {
      put_number(out, entry.log_time);
      put_number(out, entry.offset);
    }
  });
}

void append_record(ByteBuffer& out, const ChunkIndex& record) {
  const RecordScope scope(out, Opcode::kChunkIndex);
  put_number(out, record.message_start_time);
  put_number(out, record.message_end_time);
  put_number(out, record.chunk_start_offset);
  put_number(out, record.chunk_length);
  put_map(out, record.message_index_offsets);
  put_number(out, record.message_index_length);
  put_text(out, record.compression);
  put_number(out, record.compressed_size);
  put_number(out, record.uncompressed_size);
}

void append_record(ByteBuffer& out, const AttachmentIndex& record) {
  const RecordScope scope(out, Opcode::kAttachmentIndex);
  put_number(out, record.offset);
  put_number(out, record.length);
  put_number(out, record.log_time);
  put_number(out, record.create_time);
  put_number(out, record.data_size);
  put_text(out, record.name);
  put_text(out, record.media_type);
}

void append_record(ByteBuffer& out, const Statistics& record) {
  const RecordScope scope(out, Opcode::kStatistics);
  put_number(out, record.message_count);
  put_number(out, record.schema_count);
  put_number(out, record.channel_count);
  put_number(out, record.attachment_count);
  put_number(out, record.metadata_count);
  put_number(out, record.chunk_count);
  put_number(out, record.message_start_time);
  put_number(out, record.message_end_time);
  put_map(out, record.channel_message_counts);
}

void append_record(ByteBuffer& out, const Metadata& record) {
  const RecordScope scope(out, Opcode::kMetadata);
  put_text(out, record.name);
  put_map(out, record.metadata);
}

void append_record(ByteBuffer& out, const MetadataIndex& record) {
  const RecordScope scope(out, Opcode::kMetadataIndex);
  put_number(out, record.offset);
  put_number(out, record.length);
  put_text(out, record.name);
}

void append_record(ByteBuffer& out, const SummaryOffset& record) {
  const RecordScope scope(out, Opcode::kSummaryOffset);
  put_number(out, static_cast<std::uint8_t>(record.group_opcode));
  put_number(out, record.group_start);
  put_number(out, record.group_length);
}

void append_record(ByteBuffer& out, const DataEnd& record) {
  const RecordScope scope(out, Opcode::kDataEnd);
  put_number(out, record.data_section_crc);
}

void append_attachment_head(ByteBuffer& out, const Attachment& attachment) {
  constexpr std::size_t kFixedBytes = 8 + 8 + 4 + 4 + 8 + 4;
  put_number(out, static_cast<std::uint8_t>(Opcode::kAttachment));
  put_number(
      out, std::uint64_t{kFixedBytes + attachment.name.size() + attachment.media_type.size() + attachment.data.size()});
  put_number(out, attachment.log_time);
  put_number(out, attachment.create_time);
  put_text(out, attachment.name);
  put_text(out, attachment.media_type);
  put_number(out, std::uint64_t{attachment.data.size()});
}

void append_attachment_crc(ByteBuffer& out, Bytes head, Bytes data) {
  put_number(out, crc32(data, crc32(head.subspan(kRecordHeadBytes))));
}

void append_magic(ByteBuffer& out) {
  put(out, std::as_bytes(std::span(kMagic)));
}

}  // namespace vestige::mcap
