#include "traces/mcap/decode.hpp"

#include "traces/mcap/crc32.hpp"

namespace vestige::mcap {

namespace {

std::string text(Cursor& cursor) {
  return std::string(cursor.string());
}

StringMap string_map(Cursor& cursor) {
  Cursor entries(cursor.bytes(cursor.number<std::uint32_t>()));
  StringMap map;
  while (entries.remaining() > 0) {
    std::string key = text(entries);
    map.insert_or_assign(std::move(key), text(entries));
  }
  return map;
}

std::map<std::uint16_t, std::uint64_t> number_map(Cursor& cursor) {
  Cursor entries(cursor.bytes(cursor.number<std::uint32_t>()));
  std::map<std::uint16_t, std::uint64_t> map;
  while (entries.remaining() > 0) {
    const auto key = entries.number<std::uint16_t>();
    map.insert_or_assign(key, entries.number<std::uint64_t>());
  }
  return map;
}

// Field order and widths: the specification's tables, "Records". Braced initialisers are evaluated left to right.

Header read_header(Cursor& in) {
  return {.profile = text(in), .library = text(in)};
}

Footer read_footer(Cursor& in) {
  return {.summary_start = in.number<std::uint64_t>(),
          .summary_offset_start = in.number<std::uint64_t>(),
          .summary_crc = in.number<std::uint32_t>()};
}

Schema read_schema(Cursor& in) {
  Schema schema{.id = in.number<std::uint16_t>(), .name = text(in), .encoding = text(in), .data = {}};
  const Bytes data = in.bytes(in.number<std::uint32_t>());
  schema.data.assign(data.begin(), data.end());
  return schema;
}

Channel read_channel(Cursor& in) {
  return {.id = in.number<std::uint16_t>(),
          .schema_id = in.number<std::uint16_t>(),
          .topic = text(in),
          .message_encoding = text(in),
          .metadata = string_map(in)};
}

Message read_message(Cursor& in) {
  Message message{.channel_id = in.number<std::uint16_t>(),
                  .sequence = in.number<std::uint32_t>(),
                  .log_time = in.number<std::uint64_t>(),
                  .publish_time = in.number<std::uint64_t>(),
                  .data = {}};
  message.data = in.bytes(in.remaining());
  return message;
}

Chunk read_chunk(Cursor& in) {
  Chunk chunk{.message_start_time = in.number<std::uint64_t>(),
              .message_end_time = in.number<std::uint64_t>(),
              .uncompressed_size = in.number<std::uint64_t>(),
              .uncompressed_crc = in.number<std::uint32_t>(),
              .compression = text(in),
              .records = {}};
  chunk.records = in.bytes(in.number<std::uint64_t>());
  return chunk;
}

MessageIndex read_message_index(Cursor& in) {
  MessageIndex index{.channel_id = in.number<std::uint16_t>(), .entries = {}};
  Cursor entries(in.bytes(in.number<std::uint32_t>()));
  index.entries.reserve(entries.remaining() / 16);
  while (entries.remaining() > 0)
    index.entries.push_back({.log_time = entries.number<std::uint64_t>(), .offset = entries.number<std::uint64_t>()});
  return index;
}

ChunkIndex read_chunk_index(Cursor& in) {
  return {.message_start_time = in.number<std::uint64_t>(),
          .message_end_time = in.number<std::uint64_t>(),
          .chunk_start_offset = in.number<std::uint64_t>(),
          .chunk_length = in.number<std::uint64_t>(),
          .message_index_offsets = number_map(in),
          .message_index_length = in.number<std::uint64_t>(),
          .compression = text(in),
          .compressed_size = in.number<std::uint64_t>(),
          .uncompressed_size = in.number<std::uint64_t>()};
}

Attachment read_attachment(Cursor& in) {
  Attachment attachment{.log_time = in.number<std::uint64_t>(),
                        .create_time = in.number<std::uint64_t>(),
                        .name = text(in),
                        .media_type = text(in),
                        .data = {}};
  attachment.data = in.bytes(in.number<std::uint64_t>());
  attachment.crc = in.number<std::uint32_t>();
  return attachment;
}

AttachmentIndex read_attachment_index(Cursor& in) {
  return {.offset = in.number<std::uint64_t>(),
          .length = in.number<std::uint64_t>(),
          .log_time = in.number<std::uint64_t>(),
          .create_time = in.number<std::uint64_t>(),
          .data_size = in.number<std::uint64_t>(),
          .name = text(in),
          .media_type = text(in)};
}

Statistics read_statistics(Cursor& in) {
  return {.message_count = in.number<std::uint64_t>(),
          .schema_count = in.number<std::uint16_t>(),
          .channel_count = in.number<std::uint32_t>(),
          .attachment_count = in.number<std::uint32_t>(),
          .metadata_count = in.number<std::uint32_t>(),
          .chunk_count = in.number<std::uint32_t>(),
          .message_start_time = in.number<std::uint64_t>(),
          .message_end_time = in.number<std::uint64_t>(),
          .channel_message_counts = number_map(in)};
}

Metadata read_metadata(Cursor& in) {
  return {.name = text(in), .metadata = string_map(in)};
}

MetadataIndex read_metadata_index(Cursor& in) {
  return {.offset = in.number<std::uint64_t>(), .length = in.number<std::uint64_t>(), .name = text(in)};
}

SummaryOffset read_summary_offset(Cursor& in) {
  return {.group_opcode = static_cast<Opcode>(in.number<std::uint8_t>()),
          .group_start = in.number<std::uint64_t>(),
          .group_length = in.number<std::uint64_t>()};
}

DataEnd read_data_end(Cursor& in) {
  return {.data_section_crc = in.number<std::uint32_t>()};
}

template <typename Record>
Record decode(Record (*read)(Cursor&), Bytes content) {
  Cursor cursor(content);
  return read(cursor);
}

template <typename Record>
std::size_t filled_by(Record (*read)(Cursor&), Bytes content) {
  Cursor cursor(content);
  read(cursor);
  return content.size() - cursor.remaining();
}

}  // namespace

Header decode_header(Bytes content) {
  return decode(read_header, content);
}
Footer decode_footer(Bytes content) {
  return decode(read_footer, content);
}
Schema decode_schema(Bytes content) {
  return decode(read_schema, content);
}
Channel decode_channel(Bytes content) {
  return decode(read_channel, content);
}
Message decode_message(Bytes content) {
  return decode(read_message, content);
}
Chunk decode_chunk(Bytes content) {
  return decode(read_chunk, content);
}
MessageIndex decode_message_index(Bytes content) {
  return decode(read_message_index, content);
}
ChunkIndex decode_chunk_index(Bytes content) {
  return decode(read_chunk_index, content);
}
Attachment decode_attachment(Bytes content) {
  return decode(read_attachment, content);
}
AttachmentIndex decode_attachment_index(Bytes content) {
  return decode(read_attachment_index, content);
}
Statistics decode_statistics(Bytes content) {
  return decode(read_statistics, content);
}
Metadata decode_metadata(Bytes content) {
  return decode(read_metadata, content);
}
MetadataIndex decode_metadata_index(Bytes content) {
  return decode(read_metadata_index, content);
}
SummaryOffset decode_summary_offset(Bytes content) {
  return decode(read_summary_offset, content);
}
DataEnd decode_data_end(Bytes content) {
  return decode(read_data_end, content);
}

bool attachment_crc_holds(Bytes content, const Attachment& attachment) {
  if (attachment.crc == 0) return true;
  const auto covered = static_cast<std::size_t>(attachment.data.data() - content.data()) + attachment.data.size();
  return crc32(content.first(covered)) == attachment.crc;
}

std::string_view name_of(Opcode opcode) {
  switch (opcode) {
    case Opcode::kHeader:
      return "Header";
    case Opcode::kFooter:
      return "Footer";
    case Opcode::kSchema:
      return "Schema";
    case Opcode::kChannel:
      return "Channel";
    case Opcode::kMessage:
      return "Message";
    case Opcode::kChunk:
      return "Chunk";
    case Opcode::kMessageIndex:
      return "MessageIndex";
    case Opcode::kChunkIndex:
      return "ChunkIndex";
    case Opcode::kAttachment:
      return "Attachment";
    case Opcode::kAttachmentIndex:
      return "AttachmentIndex";
    case Opcode::kStatistics:
      return "Statistics";
    case Opcode::kMetadata:
      return "Metadata";
    case Opcode::kMetadataIndex:
      return "MetadataIndex";
    case Opcode::kSummaryOffset:
      return "SummaryOffset";
    case Opcode::kDataEnd:
      return "DataEnd";
  }
  return "record of unknown kind";
}

std::optional<std::size_t> least_content_bytes(Opcode opcode) {
  switch (opcode) {
    case Opcode::kHeader:
      return 8;
    case Opcode::kFooter:
      return kFooterContentBytes;
    case Opcode::kSchema:
      return 14;
    case Opcode::kChannel:
      return 16;
    case Opcode::kMessage:
      return 22;
    case Opcode::kChunk:
      return 40;
    case Opcode::kMessageIndex:
      return 6;
    case Opcode::kChunkIndex:
      return 64;
    case Opcode::kAttachment:
      return 36;
    case Opcode::kAttachmentIndex:
      return 48;
    case Opcode::kStatistics:
      return 46;
    case Opcode::kMetadata:
      return 8;
    case Opcode::kMetadataIndex:
      return 20;
    case Opcode::kSummaryOffset:
      return 17;
    case Opcode::kDataEnd:
      return 4;
  }
  return {};
}

std::optional<std::size_t> natural_content_bytes(Opcode opcode, Bytes content) {
  try {
    switch (opcode) {
      case Opcode::kHeader:
        return filled_by(read_header, content);
      case Opcode::kFooter:
        return filled_by(read_footer, content);
      case Opcode::kSchema:
        return filled_by(read_schema, content);
      case Opcode::kChannel:
        return filled_by(read_channel, content);
      case Opcode::kMessage:
        return {};
      case Opcode::kChunk:
        return filled_by(read_chunk, content);
      case Opcode::kMessageIndex:
        return filled_by(read_message_index, content);
      case Opcode::kChunkIndex:
        return filled_by(read_chunk_index, content);
      case Opcode::kAttachment:
        return filled_by(read_attachment, content);
      case Opcode::kAttachmentIndex:
        return filled_by(read_attachment_index, content);
      case Opcode::kStatistics:
        return filled_by(read_statistics, content);
      case Opcode::kMetadata:
        return filled_by(read_metadata, content);
      case Opcode::kMetadataIndex:
        return filled_by(read_metadata_index, content);
      case Opcode::kSummaryOffset:
        return filled_by(read_summary_offset, content);
      case Opcode::kDataEnd:
        return filled_by(read_data_end, content);
    }
  } catch (const Malformed&) {
    return {};
  }
  return {};
}

InnerRecord next_record(Cursor& cursor) {
  const auto opcode = static_cast<Opcode>(cursor.number<std::uint8_t>());
  return {.opcode = opcode, .content = cursor.bytes(cursor.number<std::uint64_t>())};
}

bool fits_its_fields(const InnerRecord& record) {
  if (record.opcode == Opcode::kMessage) return record.content.size() >= least_content_bytes(record.opcode).value_or(0);
  return natural_content_bytes(record.opcode, record.content).has_value();
}

}  // namespace vestige::mcap
