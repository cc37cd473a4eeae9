#include "traces/mcap/check/container_check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <utility>

#include "traces/base/error.hpp"
#include "traces/mcap/check/chunk_check.hpp"
#include "traces/mcap/check/summary_check.hpp"
#include "traces/mcap/chunk_expander.hpp"
#include "traces/mcap/crc32.hpp"
#include "traces/mcap/decode.hpp"
#include "traces/mcap/record_walker.hpp"

namespace vestige::mcap {

namespace {

constexpr std::uint8_t kFirstPrivateOpcode = 0x80;  // MCAP specification, "Opcodes"

bool belongs_behind_data(Opcode opcode) {
  return opcode == Opcode::kChunkIndex || opcode == Opcode::kAttachmentIndex || opcode == Opcode::kStatistics ||
         opcode == Opcode::kMetadataIndex || opcode == Opcode::kSummaryOffset || opcode == Opcode::kFooter;
}

class Check {
 public:
  Check(const ByteSource& source, ProblemList& problems, const std::function<void(const CheckedRecord&)>& visit)
      : source_(source),
        problems_(problems),
        visit_(visit),
        walker_(source, MagicBytes::kMayBeBroken),
        summary_(data_, problems),
        message_indexes_(problems) {}

  ContainerFacts run(const std::function<bool(double)>& progress);

 private:
  enum class Section { kData, kSummary };

  void note_framing();
  bool is_behind_footer(const Damage& damage) const;
  std::string consequence_of(const Damage& damage) const;
  void take(const RecordPlace& place, Bytes content);
  void take_data(const RecordPlace& place, Bytes content);
  void take_chunk(const RecordPlace& place, Bytes content);
  void take_records_of_chunk(const RecordPlace& place, Bytes records, ChunkIndex& facts);
  void take_attachment(const RecordPlace& place, Bytes content);
  void take_data_end(const RecordPlace& place, Bytes content);
  void take_definition(const CheckedRecord& record, const Schema& schema);
  void take_definition(const CheckedRecord& record, const Channel& channel);
  /// Takes a schema, channel or message, inside or outside a chunk. Throws `Malformed`.
  void take_content(const CheckedRecord& record);
  void take_message(const CheckedRecord& record);
  void add_to_crc(const RecordPlace& place, Bytes content);
  void report(const CheckedRecord& where, std::string what, std::string consequence);
  void report(const RecordPlace& place, std::string what, std::string consequence);

  const ByteSource& source_;
  ProblemList& problems_;
  const std::function<void(const CheckedRecord&)>& visit_;
  RecordWalker walker_;
  DataFacts data_;
  SummaryCheck summary_;
  MessageIndexCheck message_indexes_;
  ContainerFacts facts_;
  RawBuffer content_;
  RawBuffer expanded_;
  Section section_ = Section::kData;
  std::uint64_t data_end_ = kMagicBytes;  ///< end of the last record that certainly belongs to the data section
  std::uint32_t data_crc_ = crc32(std::as_bytes(std::span(kMagic)));
  std::uint64_t crc_end_ = kMagicBytes;  ///< the end of the bytes that data_crc_ covers
  bool crc_whole_ = true;                ///< nothing was skipped
};

void Check::report(const CheckedRecord& where, std::string what, std::string consequence) {
  problems_.add({.offset = where.offset,
                 .bytes = where.bytes,
                 .offset_in_chunk = where.offset_in_chunk,
                 .what = fmt::format("{}: {}", name_of(where.opcode), what),
                 .consequence = std::move(consequence)});
}

void Check::report(const RecordPlace& place, std::string what, std::string consequence) {
  report({.opcode = place.opcode, .content = {}, .offset = place.offset, .bytes = place.end() - place.offset},
         std::move(what), std::move(consequence));
}

bool Check::is_behind_footer(const Damage& damage) const {
  return walker_.footer_seen() && damage.offset >= walker_.position();
}

std::string Check::consequence_of(const Damage& damage) const {
  if (damage.offset < kMagicBytes)
    return "readers do not open the file; if it is a trace, `vestige recover` writes one that they open";
  if (damage.effect == DamageEffect::kAnotherFile)
    return fmt::format("readers do not see it; `tail -c +{} FILE > SECOND.mcap` copies it to a file",
                       damage.offset + 1);
  if (is_behind_footer(damage)) return "readers may refuse the file";
  if (damage.effect == DamageEffect::kMended)
    return "vestige reads it all the same, but other readers lose the data after it; `vestige recover` mends it";
  if (damage.bytes == 0)
    return "there is no index: the file is read by scanning it; readers that need an index refuse it; `vestige "
           "recover` writes one";
  if (damage.offset + damage.bytes == source_.size())
    return "everything from here on is missing, also the index; `vestige recover` keeps the data that can be decoded "
           "and writes an index";
  return "these bytes are skipped; `vestige recover` keeps the data that can be decoded";
}

void Check::note_framing() {
  for (const Damage& damage : walker_.damages()) {
    problems_.add(
        {.offset = damage.offset, .bytes = damage.bytes, .what = damage.what, .consequence = consequence_of(damage)});
    if (damage.offset < kMagicBytes) {
      facts_.begins_as_mcap = false;
      if (damage.bytes == kMagicBytes) continue;
    }
    if (!is_behind_footer(damage) && damage.bytes > 0 && damage.effect == DamageEffect::kLost) {
      data_.whole = crc_whole_ = false;
      message_indexes_.begin_unknown();
    }
  }
}

ContainerFacts Check::run(const std::function<bool(double)>& progress) {
  facts_.begins_as_mcap = true;
  RecordPlace place;
  while (walker_.next(place)) {
    note_framing();
    if (facts_.records++ == 0 && place.opcode != Opcode::kHeader)
      report(place, "the first record is not a Header", "the file does not say who wrote it, and for what purpose");
    const Bytes content = walker_.content(place, content_);
    if (place.opcode != Opcode::kMessageIndex) message_indexes_.end();
    if (least_content_bytes(place.opcode) && place.opcode != Opcode::kMessage && place.opcode != Opcode::kChunk &&
        !natural_content_bytes(place.opcode, content)) {
      report(place, "it is shorter than its fields", "it is skipped");
      data_.whole = false;
      message_indexes_.begin_unknown();
    } else {
      take(place, content);
    }
    add_to_crc(place, content);
    const double share = static_cast<double>(place.end()) / static_cast<double>(source_.size());
    if (!progress(share)) throw Error(source_.name(), "the check was stopped", "");
  }
  message_indexes_.end();
  note_framing();
  facts_.messages = data_.counted.message_count;
  facts_.chunks = data_.chunks.size();
  facts_.metadata = data_.metadata.size();
  return facts_;
}

void Check::add_to_crc(const RecordPlace& place, Bytes content) {
  if (place.offset != crc_end_) crc_whole_ = false;
  if (!crc_whole_ || section_ != Section::kData) return;
  std::array<std::byte, kRecordHeadBytes> head = {};
  source_.read_at(place.offset, head);
  data_crc_ = crc32(content, crc32(head, data_crc_));
  crc_end_ = place.end();
}

void Check::take(const RecordPlace& place, Bytes content) {
  if (section_ == Section::kData && belongs_behind_data(place.opcode)) {
    section_ = Section::kSummary;
    summary_.begin_unknown();
    problems_.add(
        {.offset = data_end_,
         .bytes = place.offset - data_end_,
         .what = fmt::format("there is no DataEnd between the data section and the {}", name_of(place.opcode)),
         .consequence = "no CRC covers the data section as a whole"});
  }
  if (place.opcode == Opcode::kDataEnd && section_ == Section::kData) {
    take_data_end(place, content);
  } else if (place.opcode == Opcode::kFooter) {
    facts_.has_footer = true;
    summary_.finish(place, content, source_);
  } else if (section_ == Section::kSummary) {
    summary_.take(place, content);
  } else {
    take_data(place, content);
  }
}

void Check::take_data(const RecordPlace& place, Bytes content) {
  // A summary has schemas and channels too, and private records stand anywhere.
  const bool anywhere = place.opcode == Opcode::kSchema || place.opcode == Opcode::kChannel ||
                        static_cast<std::uint8_t>(place.opcode) >= kFirstPrivateOpcode;
  if (!anywhere) data_end_ = place.end();
  const CheckedRecord record{
      .opcode = place.opcode, .content = content, .offset = place.offset, .bytes = place.end() - place.offset};
  switch (place.opcode) {
    case Opcode::kHeader:
      visit_(record);
      break;
    case Opcode::kSchema:
    case Opcode::kChannel:
    case Opcode::kMessage:
      take_content(record);
      break;
    case Opcode::kChunk:
      take_chunk(place, content);
      break;
    case Opcode::kMessageIndex: {
      const MessageIndex index = decode_message_index(content);
      message_indexes_.take_index(place, index);
      if (data_.chunks.empty()) break;
      data_.chunks.back().index.message_index_offsets[index.channel_id] = place.offset;
      data_.chunks.back().index.message_index_length += record.bytes;
      break;
    }
    case Opcode::kAttachment:
      take_attachment(place, content);
      break;
    case Opcode::kMetadata:
      data_.metadata.push_back({.offset = place.offset, .length = record.bytes, .name = decode_metadata(content).name});
      ++data_.counted.metadata_count;
      visit_(record);
      break;
    case Opcode::kChunkIndex:
    case Opcode::kAttachmentIndex:
    case Opcode::kStatistics:
    case Opcode::kMetadataIndex:
    case Opcode::kSummaryOffset:
    case Opcode::kDataEnd:
    case Opcode::kFooter:
      break;
    default:
      if (static_cast<std::uint8_t>(place.opcode) >= kFirstPrivateOpcode) break;
      report(place, fmt::format("MCAP does not define its opcode {:#04x}", static_cast<int>(place.opcode)),
             "it is skipped; its opcode may be damaged");
      data_.whole = false;
      message_indexes_.begin_unknown();
  }
}

void Check::take_chunk(const RecordPlace& place, Bytes content) {
  ChunkIndex index;
  index.chunk_start_offset = place.offset;
  index.chunk_length = place.end() - place.offset;
  bool readable = false;
  ++data_.counted.chunk_count;
  try {
    const Chunk chunk = decode_chunk(content);
    index.message_start_time = chunk.message_start_time;
    index.message_end_time = chunk.message_end_time;
    index.compression = chunk.compression;
    index.compressed_size = chunk.records.size();
    index.uncompressed_size = chunk.uncompressed_size;
    const Bytes records = expand_chunk(chunk, expanded_);
    message_indexes_.begin_chunk();
    take_records_of_chunk(place, records, index);
    readable = true;
  } catch (const Malformed& malformed) {
    report(place, malformed.what(), "its messages are not read; `vestige recover` keeps those that can be decoded");
    ++facts_.damaged_chunks;
    data_.whole = false;
    message_indexes_.begin_unknown();
  }
  data_.chunks.push_back({.index = std::move(index), .readable = readable});
}

void Check::take_records_of_chunk(const RecordPlace& place, Bytes records, ChunkIndex& facts) {
  std::optional<std::pair<std::uint64_t, std::uint64_t>> times;
  bool all_fit = true;
  Cursor cursor(records);
  while (cursor.remaining() > 0) {
    CheckedRecord record{.content = {},
                         .offset = place.offset,
                         .bytes = place.end() - place.offset,
                         .offset_in_chunk = records.size() - cursor.remaining()};
    try {
      const InnerRecord inner = next_record(cursor);
      record.opcode = inner.opcode;
      record.content = inner.content;
    } catch (const Malformed& malformed) {
      report(record, malformed.what(), "the rest of its chunk is not read");
      data_.whole = false;
      message_indexes_.begin_unknown();
      return;
    }
    try {
      if (record.opcode == Opcode::kMessage) {
        const Message message = decode_message(record.content);
        message_indexes_.take_message(message, *record.offset_in_chunk);
        if (!times) times.emplace(message.log_time, message.log_time);
        times->first = std::min(times->first, message.log_time);
        times->second = std::max(times->second, message.log_time);
      }
      if (belongs_in_chunks(record.opcode)) {
        take_content(record);
      } else if (least_content_bytes(record.opcode)) {
        report(record, "is inside a Chunk, but a Chunk may hold only schemas, channels and messages", "it is skipped");
      }
    } catch (const Malformed& malformed) {
      report(record, malformed.what(), "it is skipped");
      data_.whole = all_fit = false;
      message_indexes_.begin_unknown();
    }
  }
  if (!times || !all_fit) return;
  if (facts.message_start_time == times->first && facts.message_end_time == times->second) return;
  report(place,
         fmt::format("says that its messages are from {} to {} ns, but they are from {} to {} ns",
                     facts.message_start_time, facts.message_end_time, times->first, times->second),
         "readers that search by time miss messages; `vestige recover` writes the right times");
}

void Check::take_content(const CheckedRecord& record) {
  switch (record.opcode) {
    case Opcode::kSchema:
      take_definition(record, decode_schema(record.content));
      break;
    case Opcode::kChannel:
      take_definition(record, decode_channel(record.content));
      break;
    default:
      take_message(record);
  }
}

void Check::take_definition(const CheckedRecord& record, const Schema& schema) {
  if (schema.id == 0) {
    report(record, "its id is 0, which means no schema", "it is skipped");
    return;
  }
  const auto [known, is_new] = data_.schemas.try_emplace(schema.id, without_data(schema));
  if (!is_new && known->second != without_data(schema))
    report(record, fmt::format("schema {} differs from its earlier definition", schema.id),
           "it is unknown which of the two its messages have");
  data_.counted.schema_count = static_cast<std::uint16_t>(data_.schemas.size());
  visit_(record);
}

void Check::take_definition(const CheckedRecord& record, const Channel& channel) {
  if (channel.schema_id != 0 && !data_.schemas.contains(channel.schema_id))
    report(record,
           fmt::format("channel {} has schema {}, which is not defined before it", channel.id, channel.schema_id),
           "the schema of its messages is unknown");
  const auto [known, is_new] = data_.channels.try_emplace(channel.id, channel);
  if (!is_new && known->second != channel)
    report(record, fmt::format("channel {} differs from its earlier definition", channel.id),
           "it is unknown which of the two its messages belong to");
  data_.counted.channel_count = static_cast<std::uint32_t>(data_.channels.size());
  visit_(record);
}

void Check::take_message(const CheckedRecord& record) {
  const Message message = decode_message(record.content);
  Statistics& counted = data_.counted;
  if (counted.message_count == 0) counted.message_start_time = message.log_time;
  counted.message_start_time = std::min(counted.message_start_time, message.log_time);
  counted.message_end_time = std::max(counted.message_end_time, message.log_time);
  ++counted.message_count;
  ++counted.channel_message_counts[message.channel_id];
  if (!data_.channels.contains(message.channel_id))
    report(record, fmt::format("its channel {} is not defined before it", message.channel_id),
           "its meaning is unknown");
  visit_(record);
}

void Check::take_attachment(const RecordPlace& place, Bytes content) {
  const Attachment attachment = decode_attachment(content);
  data_.attachments.push_back({.offset = place.offset,
                               .length = place.end() - place.offset,
                               .log_time = attachment.log_time,
                               .create_time = attachment.create_time,
                               .data_size = attachment.data.size(),
                               .name = attachment.name,
                               .media_type = attachment.media_type});
  ++data_.counted.attachment_count;
  if (!attachment_crc_holds(content, attachment)) {
    report(place, fmt::format("'{}': its CRC is wrong", attachment.name), "it is not used");
    return;
  }
  ++facts_.attachments;
  visit_({.opcode = place.opcode, .content = content, .offset = place.offset, .bytes = place.end() - place.offset});
}

void Check::take_data_end(const RecordPlace& place, Bytes content) {
  section_ = Section::kSummary;
  const std::uint32_t expected = decode_data_end(content).data_section_crc;
  // After broken framing the CRC misses bytes, and that problem was already reported.
  if (expected == 0 || !crc_whole_ || place.offset != crc_end_ || data_crc_ == expected) return;
  problems_.add({.offset = 0,
                 .bytes = place.end(),
                 .what = fmt::format("data section: the CRC over its first {} bytes is wrong", place.offset),
                 .consequence =
                     "a byte there has changed; the parts that no other CRC covers (header, schemas, channels, "
                     "metadata, indexes) may be wrong"});
}

}  // namespace

ContainerFacts check_container(const ByteSource& source, ProblemList& problems,
                               const std::function<void(const CheckedRecord&)>& visit,
                               const std::function<bool(double)>& progress) {
  return Check(source, problems, visit).run(progress);
}

}  // namespace vestige::mcap
