#include "traces/mcap/summary.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include "traces/mcap/decode.hpp"
#include "traces/mcap/record_walker.hpp"
#include "traces/mcap/stream_reader.hpp"

namespace vestige::mcap {

namespace {

constexpr std::size_t kTailBytes = kRecordHeadBytes + kFooterContentBytes + kMagicBytes;
constexpr std::size_t kFooterCrcBytes = 4;
constexpr std::uint64_t kMostUnverifiedBytes = std::uint64_t{64} << 20;

/// Returns offset and length of the record that an index entry refers to.
std::pair<std::uint64_t, std::uint64_t> place_of(const ChunkIndex& index) {
  return {index.chunk_start_offset, index.chunk_length};
}
template <typename Index>
std::pair<std::uint64_t, std::uint64_t> place_of(const Index& index) {
  return {index.offset, index.length};
}

Footer read_tail(const ByteSource& source) {
  if (source.size() < kMagicBytes + kTailBytes) throw Malformed("its last bytes are not a footer");
  std::array<std::byte, kTailBytes> tail = {};
  source.read_at(source.size() - kTailBytes, tail);
  const Bytes bytes = tail;
  if (!is_magic(bytes.last(kMagicBytes))) throw Malformed("its last bytes are not a footer");
  Cursor cursor(bytes);
  if (cursor.number<std::uint8_t>() != static_cast<std::uint8_t>(Opcode::kFooter) ||
      cursor.number<std::uint64_t>() != kFooterContentBytes)
    throw Malformed("its last bytes are not a footer");
  return decode_footer(cursor.bytes(kFooterContentBytes));
}

void take(Summary& summary, const InnerRecord& record) {
  switch (record.opcode) {
    case Opcode::kSchema:
      summary.schemas.push_back(decode_schema(record.content));
      break;
    case Opcode::kChannel:
      summary.channels.push_back(decode_channel(record.content));
      break;
    case Opcode::kStatistics:
      summary.statistics = decode_statistics(record.content);
      break;
    case Opcode::kChunkIndex:
      summary.chunk_indexes.push_back(decode_chunk_index(record.content));
      break;
    case Opcode::kAttachmentIndex:
      summary.attachment_indexes.push_back(decode_attachment_index(record.content));
      break;
    case Opcode::kMetadataIndex:
      summary.metadata_indexes.push_back(decode_metadata_index(record.content));
      break;
    case Opcode::kChunk:
    case Opcode::kMessage:
      throw Malformed(fmt::format("its footer says that the summary begins before a {}", name_of(record.opcode)));
    default:
      break;
  }
}

void require_within(std::uint64_t offset, std::uint64_t length, const Summary& summary) {
  if (offset < kMagicBytes || offset > summary.data_section_end || length > summary.data_section_end - offset)
    throw Malformed(fmt::format("its index points to offset {}, outside the data", offset));
}

Summary read(const ByteSource& source) {
  Summary summary;
  summary.footer = read_tail(source);
  const std::uint64_t footer_offset = source.size() - kTailBytes;
  const std::uint64_t begin = summary.footer.summary_start != 0 ? summary.footer.summary_start : footer_offset;
  const std::uint64_t crc_end = footer_offset + kRecordHeadBytes + kFooterContentBytes - kFooterCrcBytes;
  if (begin < kMagicBytes || begin > footer_offset) throw Malformed("its footer points outside the file");
  summary.data_section_end = begin;

  // A footer may lie, so nothing large is read into memory before a CRC verifies it.
  if (summary.footer.summary_crc != 0 && crc32_of(source, begin, crc_end) != summary.footer.summary_crc)
    throw Malformed("its summary's CRC is wrong");
  if (summary.footer.summary_crc == 0 && crc_end - begin > kMostUnverifiedBytes)
    throw Malformed("its summary is too large to be read without a CRC");
  RawBuffer buffer;
  source.read_at(begin, buffer.reset(static_cast<std::size_t>(crc_end - begin)));
  Cursor records(buffer.bytes().first(static_cast<std::size_t>(footer_offset - begin)));
  while (records.remaining() > 0) take(summary, next_record(records));

  for (const ChunkIndex& chunk : summary.chunk_indexes) {
    require_within(chunk.chunk_start_offset, chunk.chunk_length, summary);
    require_within(chunk.chunk_start_offset + chunk.chunk_length, chunk.message_index_length, summary);
  }
  for (const AttachmentIndex& attachment : summary.attachment_indexes)
    require_within(attachment.offset, attachment.length, summary);
  for (const MetadataIndex& metadata : summary.metadata_indexes)
    require_within(metadata.offset, metadata.length, summary);
  const auto by_place = [](const auto& a, const auto& b) { return place_of(a) < place_of(b); };
  std::stable_sort(summary.chunk_indexes.begin(), summary.chunk_indexes.end(), by_place);
  std::stable_sort(summary.attachment_indexes.begin(), summary.attachment_indexes.end(), by_place);
  std::stable_sort(summary.metadata_indexes.begin(), summary.metadata_indexes.end(), by_place);
  return summary;
}

}  // namespace

SummaryResult read_summary(const ByteSource& source) {
  require_mcap(source);
  try {
    SummaryResult result{.summary = read(source), .problem = {}};
    try {
      RawBuffer buffer;
      result.summary->header =
          decode_header(read_record_at(source, kMagicBytes, Opcode::kHeader, result.summary->data_section_end, buffer));
    } catch (const Malformed&) {
      // Reading needs nothing from the header. A caller that wants the header sees that it is missing.
      result.summary->header.reset();
    }
    return result;
  } catch (const Malformed& malformed) {
    return {.summary = {}, .problem = malformed.what()};
  }
}

bool leads_to_everything(const ByteSource& source, const Summary& summary) {
  auto chunk = summary.chunk_indexes.begin();
  auto attachment = summary.attachment_indexes.begin();
  auto metadata = summary.metadata_indexes.begin();
  // Whether the record is the next entry of its index.
  const auto take = [](auto& index, auto end, std::uint64_t offset, std::uint64_t length) {
    const bool is_next = index != end && place_of(*index) == std::pair(offset, length);
    if (is_next) ++index;
    return is_next;
  };
  ReadWindow window(source);
  for (std::uint64_t offset = kMagicBytes; offset < summary.data_section_end;) {
    const std::uint64_t rest = summary.data_section_end - offset;
    if (rest < kRecordHeadBytes) return false;
    Cursor head(window.at(offset, kRecordHeadBytes));
    const auto opcode = static_cast<Opcode>(head.number<std::uint8_t>());
    const auto content_bytes = head.number<std::uint64_t>();
    if (content_bytes > std::min(rest - kRecordHeadBytes, kMaxRecordBytes)) return false;
    const std::uint64_t length = kRecordHeadBytes + content_bytes;
    if (opcode == Opcode::kMessage) return false;
    if (opcode == Opcode::kChunk && !take(chunk, summary.chunk_indexes.end(), offset, length)) return false;
    if (opcode == Opcode::kAttachment && !take(attachment, summary.attachment_indexes.end(), offset, length))
      return false;
    if (opcode == Opcode::kMetadata && !take(metadata, summary.metadata_indexes.end(), offset, length)) return false;
    offset += length;
  }
  return chunk == summary.chunk_indexes.end() && attachment == summary.attachment_indexes.end() &&
         metadata == summary.metadata_indexes.end();
}

Bytes read_record_at(const ByteSource& source, std::uint64_t offset, Opcode expected, std::uint64_t limit,
                     RawBuffer& buffer) {
  std::array<std::byte, kRecordHeadBytes> head = {};
  limit = std::min(limit, source.size());
  if (offset > limit || limit - offset < kRecordHeadBytes) throw Malformed("it is not inside the file");
  source.read_at(offset, head);
  Cursor cursor{Bytes(head)};
  const auto opcode = static_cast<Opcode>(cursor.number<std::uint8_t>());
  const auto length = cursor.number<std::uint64_t>();
  if (opcode != expected) throw Malformed(fmt::format("there is a {} in its place", name_of(opcode)));
  if (length > std::min(limit - offset - kRecordHeadBytes, kMaxRecordBytes)) throw Malformed("its length is broken");
  source.read_at(offset + kRecordHeadBytes, buffer.reset(static_cast<std::size_t>(length)));
  return buffer.bytes();
}

}  // namespace vestige::mcap
