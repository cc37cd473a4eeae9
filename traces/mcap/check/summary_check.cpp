#include "traces/mcap/check/summary_check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <span>

#include "traces/base/sha256.hpp"
#include "traces/mcap/decode.hpp"
#include "traces/mcap/stream_reader.hpp"

namespace vestige::mcap {

namespace {

constexpr std::string_view kIndexConsequence =
    "readers that use the index miss or misread the records that it points to; `vestige recover` writes a new one";

template <typename Entry, typename OffsetOf>
const Entry* find_at(const std::vector<Entry>& entries, std::uint64_t offset, OffsetOf offset_of) {
  const auto found = std::lower_bound(entries.begin(), entries.end(), offset,
                                      [&](const Entry& entry, std::uint64_t at) { return offset_of(entry) < at; });
  return found == entries.end() || offset_of(*found) != offset ? nullptr : &*found;
}

std::uint64_t offset_of(const DataFacts::ChunkFacts& chunk) {
  return chunk.index.chunk_start_offset;
}

/// Returns the elements of `facts` whose offset is not in `listed`.
template <typename Facts, typename OffsetOf>
std::vector<const Facts*> unlisted(const std::vector<Facts>& facts, std::vector<std::uint64_t>& listed,
                                   OffsetOf offset_of) {
  std::vector<const Facts*> missing;
  if (listed.empty()) return missing;  // a file may lack this index altogether
  std::sort(listed.begin(), listed.end());
  for (const Facts& fact : facts)
    if (!std::binary_search(listed.begin(), listed.end(), offset_of(fact))) missing.push_back(&fact);
  return missing;
}

std::string shown(std::uint64_t value) {
  return fmt::format("{}", value);
}
std::string shown(const std::string& value) {
  constexpr std::size_t kMostBytes = 200;
  return fmt::format("'{}'", std::string_view(value).substr(0, kMostBytes));
}
std::string shown(const std::map<std::uint16_t, std::uint64_t>& map) {
  constexpr std::size_t kMost = 8;
  std::string text;
  std::size_t count = 0;
  for (const auto& [key, value] : map) {
    if (++count > kMost) return "{" + text + ", …}";
    text += fmt::format("{}{}: {}", text.empty() ? "" : ", ", key, value);
  }
  return "{" + text + "}";
}

}  // namespace

Schema without_data(const Schema& schema) {
  const std::string sha256 = sha256_hex(schema.data);
  const Bytes digest = std::as_bytes(std::span(sha256));
  return {.id = schema.id, .name = schema.name, .encoding = schema.encoding, .data = {digest.begin(), digest.end()}};
}

void SummaryCheck::contradiction(const RecordPlace& place, std::string what) {
  problems_.add({.offset = place.offset,
                 .bytes = place.end() - place.offset,
                 .what = fmt::format("{}: {}", name_of(place.opcode), what),
                 .consequence = std::string(kIndexConsequence)});
}

template <typename Value>
void SummaryCheck::compare(const RecordPlace& place, std::string_view field, const Value& claimed,
                           const Value& actual) {
  if (claimed != actual)
    contradiction(place, fmt::format("says that {} is {}, but it is {}", field, shown(claimed), shown(actual)));
}

void SummaryCheck::note_group(const RecordPlace& place) {
  if (groups_.empty() || groups_.back().opcode != place.opcode)
    groups_.push_back({.opcode = place.opcode, .start = place.offset, .end = place.end()});
  groups_.back().end = place.end();
}

void SummaryCheck::take(const RecordPlace& place, Bytes content) {
  note_group(place);
  switch (place.opcode) {
    case Opcode::kSchema: {
      const Schema schema = decode_schema(content);
      const auto known = facts_.schemas.find(schema.id);
      if (known == facts_.schemas.end() ? facts_.whole : known->second != without_data(schema))
        contradiction(place, fmt::format("schema {} does not match the data section", schema.id));
      break;
    }
    case Opcode::kChannel: {
      const Channel channel = decode_channel(content);
      const auto known = facts_.channels.find(channel.id);
      if (known == facts_.channels.end() ? facts_.whole : known->second != channel)
        contradiction(place, fmt::format("channel {} does not match the data section", channel.id));
      break;
    }
    case Opcode::kChunkIndex:
      take(place, decode_chunk_index(content));
      break;
    case Opcode::kAttachmentIndex:
      take(place, decode_attachment_index(content));
      break;
    case Opcode::kMetadataIndex:
      take(place, decode_metadata_index(content));
      break;
    case Opcode::kStatistics:
      take(place, decode_statistics(content));
      break;
    case Opcode::kSummaryOffset:
      take(place, decode_summary_offset(content));
      break;
    case Opcode::kMessage:
    case Opcode::kChunk:
    case Opcode::kMessageIndex:
    case Opcode::kAttachment:
    case Opcode::kMetadata:
    case Opcode::kHeader:
    case Opcode::kDataEnd:
      contradiction(place, "is after the end of the data section");
      break;
    case Opcode::kFooter:
      break;
  }
}

void SummaryCheck::take(const RecordPlace& place, const ChunkIndex& index) {
  listed_chunks_.push_back(index.chunk_start_offset);
  const DataFacts::ChunkFacts* chunk = find_at(facts_.chunks, index.chunk_start_offset, offset_of);
  if (chunk == nullptr) {
    contradiction(place, fmt::format("points to byte {}, but no Chunk begins there", index.chunk_start_offset));
    return;
  }
  compare(place, "chunk_length", index.chunk_length, chunk->index.chunk_length);
  if (!chunk->readable) return;
  compare(place, "message_start_time", index.message_start_time, chunk->index.message_start_time);
  compare(place, "message_end_time", index.message_end_time, chunk->index.message_end_time);
  compare(place, "compression", index.compression, chunk->index.compression);
  compare(place, "compressed_size", index.compressed_size, chunk->index.compressed_size);
  compare(place, "uncompressed_size", index.uncompressed_size, chunk->index.uncompressed_size);
  if (!facts_.whole) return;
  compare(place, "message_index_length", index.message_index_length, chunk->index.message_index_length);
  compare(place, "message_index_offsets", index.message_index_offsets, chunk->index.message_index_offsets);
}

void SummaryCheck::take(const RecordPlace& place, const AttachmentIndex& index) {
  listed_attachments_.push_back(index.offset);
  const auto* attachment =
      find_at(facts_.attachments, index.offset, [](const AttachmentIndex& entry) { return entry.offset; });
  if (attachment == nullptr) {
    contradiction(place, fmt::format("points to byte {}, but no Attachment begins there", index.offset));
    return;
  }
  compare(place, "length", index.length, attachment->length);
  compare(place, "log_time", index.log_time, attachment->log_time);
  compare(place, "create_time", index.create_time, attachment->create_time);
  compare(place, "data_size", index.data_size, attachment->data_size);
  compare(place, "name", index.name, attachment->name);
  compare(place, "media_type", index.media_type, attachment->media_type);
}

void SummaryCheck::take(const RecordPlace& place, const MetadataIndex& index) {
  listed_metadata_.push_back(index.offset);
  const auto* metadata =
      find_at(facts_.metadata, index.offset, [](const MetadataIndex& entry) { return entry.offset; });
  if (metadata == nullptr) {
    contradiction(place, fmt::format("points to byte {}, but no Metadata begins there", index.offset));
    return;
  }
  compare(place, "length", index.length, metadata->length);
  compare(place, "name", index.name, metadata->name);
}

void SummaryCheck::take(const RecordPlace& place, const Statistics& statistics) {
  const Statistics& counted = facts_.counted;
  if (!facts_.whole) return;
  compare(place, "message_count", statistics.message_count, counted.message_count);
  compare(place, "schema_count", std::uint64_t{statistics.schema_count}, std::uint64_t{counted.schema_count});
  compare(place, "channel_count", std::uint64_t{statistics.channel_count}, std::uint64_t{counted.channel_count});
  compare(place, "attachment_count", std::uint64_t{statistics.attachment_count},
          std::uint64_t{counted.attachment_count});
  compare(place, "metadata_count", std::uint64_t{statistics.metadata_count}, std::uint64_t{counted.metadata_count});
  compare(place, "chunk_count", std::uint64_t{statistics.chunk_count}, std::uint64_t{counted.chunk_count});
  compare(place, "message_start_time", statistics.message_start_time, counted.message_start_time);
  compare(place, "message_end_time", statistics.message_end_time, counted.message_end_time);
  // A writer may list channels without messages, or omit them.
  auto claimed = statistics.channel_message_counts;
  std::erase_if(claimed, [](const auto& entry) { return entry.second == 0; });
  compare(place, "channel_message_counts", claimed, counted.channel_message_counts);
}

void SummaryCheck::take(const RecordPlace& place, const SummaryOffset& offset) {
  const Group* group = find_at(groups_, offset.group_start, [](const Group& each) { return each.start; });
  const bool is_there =
      group != nullptr && group->opcode == offset.group_opcode && group->end - group->start == offset.group_length;
  if (!is_there && begin_known_)
    contradiction(place, fmt::format("says that records of kind {} fill {} bytes from byte {}, but they do not",
                                     name_of(offset.group_opcode), offset.group_length, offset.group_start));
}

void SummaryCheck::report_unlisted() {
  const auto report = [&](std::uint64_t offset, std::uint64_t bytes, std::string_view kind) {
    problems_.add({.offset = offset,
                   .bytes = bytes,
                   .what = fmt::format("{}: no index lists it", kind),
                   .consequence = std::string(kIndexConsequence)});
  };
  for (const auto* chunk : unlisted(facts_.chunks, listed_chunks_, offset_of))
    report(chunk->index.chunk_start_offset, chunk->index.chunk_length, "Chunk");
  for (const auto* attachment :
       unlisted(facts_.attachments, listed_attachments_, [](const auto& entry) { return entry.offset; }))
    report(attachment->offset, attachment->length, "Attachment");
  for (const auto* metadata :
       unlisted(facts_.metadata, listed_metadata_, [](const auto& entry) { return entry.offset; }))
    report(metadata->offset, metadata->length, "Metadata");
}

void SummaryCheck::finish(const RecordPlace& place, Bytes content, const ByteSource& source) {
  report_unlisted();
  const Footer footer = decode_footer(content);
  const bool only_offsets = !groups_.empty() && groups_.front().opcode == Opcode::kSummaryOffset;
  if (begin_known_)
    compare(place, "summary_start", footer.summary_start,
            groups_.empty() || only_offsets ? std::uint64_t{0} : groups_.front().start);
  const auto offsets = std::find_if(groups_.begin(), groups_.end(),
                                    [](const Group& group) { return group.opcode == Opcode::kSummaryOffset; });
  compare(place, "summary_offset_start", footer.summary_offset_start,
          offsets == groups_.end() ? std::uint64_t{0} : offsets->start);
  if (footer.summary_crc == 0) return;
  const std::uint64_t begin = footer.summary_start != 0 ? footer.summary_start : place.offset;
  const std::uint64_t end = place.end() - sizeof footer.summary_crc;
  if (begin > place.offset || crc32_of(source, begin, end) == footer.summary_crc) return;
  problems_.add({.offset = begin,
                 .bytes = place.end() - begin,
                 .what = "summary: its CRC is wrong",
                 .consequence =
                     "the file is read by scanning it, which takes longer; readers that need the index refuse "
                     "it; `vestige recover` writes a new one"});
}

}  // namespace vestige::mcap
