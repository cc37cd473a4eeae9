#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

/// The MCAP container, implemented from its specification (mcap.dev/spec). This code knows the records, and not what
/// their messages mean.
namespace vestige::mcap {

inline constexpr unsigned char kMagic[] = {0x89, 'M', 'C', 'A', 'P', '0', '\r', '\n'};
inline constexpr std::size_t kMagicBytes = sizeof kMagic;
inline constexpr std::size_t kRecordHeadBytes = 9;             ///< opcode and content length
inline constexpr std::size_t kFooterContentBytes = 20;         ///< a Footer, alone of all records, must not be extended
inline constexpr std::uint64_t kMaxRecordBytes = 1ULL << 32;   ///< a longer record counts as broken framing
inline constexpr std::uint64_t kMaxChunkBytes = 256ULL << 20;  ///< a chunk that claims to expand to more is refused

enum class Opcode : std::uint8_t {
  kHeader = 0x01,
  kFooter = 0x02,
  kSchema = 0x03,
  kChannel = 0x04,
  kMessage = 0x05,
  kChunk = 0x06,
  kMessageIndex = 0x07,
  kChunkIndex = 0x08,
  kAttachment = 0x09,
  kAttachmentIndex = 0x0A,
  kStatistics = 0x0B,
  kMetadata = 0x0C,
  kMetadataIndex = 0x0D,
  kSummaryOffset = 0x0E,
  kDataEnd = 0x0F,
};

/// Whether a record may stand in a Chunk.
constexpr bool belongs_in_chunks(Opcode opcode) {
  return opcode == Opcode::kSchema || opcode == Opcode::kChannel || opcode == Opcode::kMessage;
}

using Bytes = std::span<const std::byte>;
using StringMap = std::map<std::string, std::string>;

/// Whether `bytes` are the magic bytes or a beginning of them.
inline bool is_magic(Bytes bytes) {
  return bytes.size() <= kMagicBytes && std::ranges::equal(bytes, std::as_bytes(std::span(kMagic)).first(bytes.size()));
}

// Times are nanoseconds since the file's own epoch. Offsets count from the start of the file unless stated otherwise. A
// member of type `Bytes` refers to the buffer that was decoded, or to memory that the caller keeps until the record is
// written.

struct Header {
  std::string profile;
  std::string library;
};

struct Footer {
  std::uint64_t summary_start = 0;         ///< 0: there is no summary
  std::uint64_t summary_offset_start = 0;  ///< 0: there are no summary offsets
  std::uint32_t summary_crc = 0;           ///< 0: not available
};

struct Schema {
  std::uint16_t id = 0;  ///< 0 is invalid
  std::string name;
  std::string encoding;
  std::vector<std::byte> data;
  bool operator==(const Schema&) const = default;
};

struct Channel {
  std::uint16_t id = 0;
  std::uint16_t schema_id = 0;  ///< 0: the channel has no schema
  std::string topic;
  std::string message_encoding;
  StringMap metadata;
  bool operator==(const Channel&) const = default;
};

struct Message {
  std::uint16_t channel_id = 0;
  std::uint32_t sequence = 0;
  std::uint64_t log_time = 0;
  std::uint64_t publish_time = 0;
  Bytes data;
};

struct Chunk {
  std::uint64_t message_start_time = 0;
  std::uint64_t message_end_time = 0;
  std::uint64_t uncompressed_size = 0;
  std::uint32_t uncompressed_crc = 0;  ///< 0: not available
  std::string compression;             ///< "", "lz4" or "zstd"
  Bytes records;                       ///< compressed
};

struct MessageIndexEntry {
  std::uint64_t log_time = 0;
  std::uint64_t offset = 0;  ///< from the start of the chunk's uncompressed records
};

struct MessageIndex {
  std::uint16_t channel_id = 0;
  std::vector<MessageIndexEntry> entries;  ///< in the order the messages were written
};

struct ChunkIndex {
  std::uint64_t message_start_time = 0;
  std::uint64_t message_end_time = 0;
  std::uint64_t chunk_start_offset = 0;
  std::uint64_t chunk_length = 0;  ///< of the whole record
  std::map<std::uint16_t, std::uint64_t> message_index_offsets;
  std::uint64_t message_index_length = 0;
  std::string compression;
  std::uint64_t compressed_size = 0;
  std::uint64_t uncompressed_size = 0;
};

struct Attachment {
  std::uint64_t log_time = 0;
  std::uint64_t create_time = 0;
  std::string name;
  std::string media_type;
  Bytes data;
  std::uint32_t crc = 0;  ///< 0: not available; computed by the writer
};

struct AttachmentIndex {
  std::uint64_t offset = 0;
  std::uint64_t length = 0;  ///< of the whole record
  std::uint64_t log_time = 0;
  std::uint64_t create_time = 0;
  std::uint64_t data_size = 0;
  std::string name;
  std::string media_type;
};

struct Statistics {
  std::uint64_t message_count = 0;
  std::uint16_t schema_count = 0;
  std::uint32_t channel_count = 0;
  std::uint32_t attachment_count = 0;
  std::uint32_t metadata_count = 0;
  std::uint32_t chunk_count = 0;
  std::uint64_t message_start_time = 0;
  std::uint64_t message_end_time = 0;
  std::map<std::uint16_t, std::uint64_t> channel_message_counts;
};

struct Metadata {
  std::string name;
  StringMap metadata;
};

struct MetadataIndex {
  std::uint64_t offset = 0;
  std::uint64_t length = 0;  ///< of the whole record
  std::string name;
};

struct SummaryOffset {
  Opcode group_opcode = Opcode::kSchema;
  std::uint64_t group_start = 0;
  std::uint64_t group_length = 0;
};

struct DataEnd {
  std::uint32_t data_section_crc = 0;  ///< 0: not available
};

/// "Chunk", "MessageIndex", …, or "record of unknown kind".
std::string_view name_of(Opcode opcode);

}  // namespace vestige::mcap
