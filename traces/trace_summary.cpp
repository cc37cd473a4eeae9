#include "traces/trace_summary.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>
#include <utility>

#include "traces/mcap/byte_source.hpp"
#include "traces/mcap/stream_reader.hpp"
#include "traces/mcap/summary.hpp"
#include "traces/message_stream.hpp"
#include "traces/nanoseconds.hpp"
#include "traces/recover.hpp"
#include "traces/sha256.hpp"
#include "traces/trace_format.hpp"
#include "traces/trace_index.hpp"
#include "traces/trace_messages.hpp"

namespace vestige {

namespace {

using mcap::Malformed;
using mcap::Opcode;
using trace_format::Stream;

/// Gathers what a summary is made of, from an index or from the records themselves.
class Gatherer {
 public:
  explicit Gatherer(const mcap::ByteSource& source) : source_(source) {}

  void take(const mcap::Header& header) {
    if (header_taken_) return;
    header_taken_ = true;
    summary_.profile = header.profile;
    summary_.library = header.library;
  }
  void take(mcap::Schema schema) {
    streams_.add(schema);
    schemas_.insert_or_assign(schema.id, std::move(schema));
  }
  void take(mcap::Channel channel) {
    streams_.add(channel);
    channels_.insert_or_assign(channel.id, std::move(channel));
  }
  void take(mcap::Metadata metadata) {
    if (metadata.name == trace_format::kRecoveredName) summary_.recovered = describe_recovered(metadata.metadata);
    if (metadata.name == trace_format::kSessionName) summary_.session = std::move(metadata.metadata);
  }
  void take(const mcap::Attachment& attachment) {
    summary_.attachments.push_back({.name = attachment.name,
                                    .media_type = attachment.media_type,
                                    .bytes = attachment.data.size(),
                                    .sha256 = sha256_hex(attachment.data)});
  }
  void take(const mcap::Message& message) {
    take_time(message.log_time, message.log_time);
    ++messages_[message.channel_id];
    take_event(streams_.stream_of(message.channel_id), message.data);
  }
  void take_event(Stream stream, mcap::Bytes data);
  void take_time(std::uint64_t first, std::uint64_t last) {
    summary_.start_ns = timed_ ? std::min(summary_.start_ns, first) : first;
    summary_.end_ns = timed_ ? std::max(summary_.end_ns, last) : last;
    timed_ = true;
  }
  void take_counts(const std::map<std::uint16_t, std::uint64_t>& counts) { messages_ = counts; }
  void take_chunk(const std::string& compression, std::uint64_t compressed, std::uint64_t uncompressed) {
    ++summary_.chunks;
    compressions_.insert(compression.empty() ? "none" : compression);
    summary_.compressed_bytes += compressed;
    summary_.uncompressed_bytes += uncompressed;
  }
  void warn(const mcap::Damage& damage) { summary_.warnings.push_back(describe(damage, source_.name())); }
  StreamTable& streams() { return streams_; }

  McapSummary finish(bool has_footer);

 private:
  const mcap::ByteSource& source_;
  McapSummary summary_;
  StreamTable streams_;
  MessageDecoder decoder_;
  std::map<std::uint16_t, mcap::Schema> schemas_;
  std::map<std::uint16_t, mcap::Channel> channels_;
  std::map<std::uint16_t, std::uint64_t> messages_;
  std::set<std::string> compressions_;
  bool header_taken_ = false;
  bool timed_ = false;
};

void Gatherer::take_event(Stream stream, mcap::Bytes data) {
  if (stream != Stream::kEvents) return;
  const TraceEvent event = decoder_.event(data);
  if (event.kind != trace_format::kDroppedKind) return;
  summary_.dropped += event.count;
  summary_.dropped_by_topic[std::string(event.text)] += event.count;
}

McapSummary Gatherer::finish(bool has_footer) {
  summary_.file_bytes = source_.size();
  if (summary_.end_ns > summary_.start_ns)
    summary_.duration_s = static_cast<double>(summary_.end_ns - summary_.start_ns) / kNanosecondsPerSecond;
  for (const auto& [id, channel] : channels_) {
    McapSummary::Channel shown;
    shown.topic = channel.topic;
    shown.encoding = channel.message_encoding;
    if (const auto schema = schemas_.find(channel.schema_id); schema != schemas_.end()) {
      shown.schema = schema->second.name;
      shown.schema_encoding = schema->second.encoding;
    }
    if (const auto count = messages_.find(id); count != messages_.end()) shown.messages = count->second;
    if (shown.messages > 1 && summary_.duration_s > 0)
      shown.rate_hz = static_cast<double>(shown.messages - 1) / summary_.duration_s;
    summary_.channels.push_back(std::move(shown));
  }
  for (const auto& [id, count] : messages_) summary_.messages += count;
  summary_.compression.assign(compressions_.begin(), compressions_.end());
  summary_.complete = has_footer && summary_.warnings.empty();
  return std::move(summary_);
}

/// Whether the index answers everything that is asked.
bool is_enough(const mcap::Summary& summary) {
  if (!summary.header || !summary.statistics) return false;
  const mcap::Statistics& statistics = *summary.statistics;
  std::uint64_t counted = 0;
  for (const auto& [id, count] : statistics.channel_message_counts) counted += count;
  return counted == statistics.message_count && statistics.channel_count == summary.channels.size() &&
         statistics.schema_count == summary.schemas.size() && statistics.chunk_count == summary.chunk_indexes.size() &&
         (statistics.chunk_count > 0 || statistics.message_count == 0) &&
         statistics.attachment_count == summary.attachment_indexes.size() &&
         statistics.metadata_count == summary.metadata_indexes.size();
}

/// Events are few: only the chunks that have some are read.
void count_events(const mcap::ByteSource& source, const mcap::Summary& summary, Gatherer& gatherer) {
  const mcap::Channel* events = gatherer.streams().find(Stream::kEvents);
  if (events == nullptr) return;
  std::vector<mcap::RecordPlace> places;
  for (const mcap::ChunkIndex& chunk : summary.chunk_indexes) {
    const bool may_have_some = chunk.message_index_offsets.empty() || chunk.message_index_offsets.contains(events->id);
    if (!may_have_some || chunk.chunk_length < mcap::kRecordHeadBytes) continue;
    places.push_back({Opcode::kChunk, chunk.chunk_start_offset, chunk.chunk_length - mcap::kRecordHeadBytes});
  }
  MessageStream messages(source, places, gatherer.streams(),
                         [&](const mcap::Damage& damage) { gatherer.warn(damage); });
  TraceMessage message;
  while (messages.next(message)) {
    try {
      gatherer.take_event(message.stream, message.message.data);
    } catch (const Malformed& malformed) {
      gatherer.warn({message.offset, 0, fmt::format("an event: {}", malformed.what())});
    }
  }
}

McapSummary from_index(const mcap::ByteSource& source, const mcap::Summary& summary) {
  Gatherer gatherer(source);
  gatherer.take(*summary.header);
  for (const mcap::Schema& schema : summary.schemas) gatherer.take(schema);
  for (const mcap::Channel& channel : summary.channels) gatherer.take(channel);
  gatherer.take_counts(summary.statistics->channel_message_counts);
  if (summary.statistics->message_count > 0)
    gatherer.take_time(summary.statistics->message_start_time, summary.statistics->message_end_time);
  for (const mcap::ChunkIndex& chunk : summary.chunk_indexes)
    gatherer.take_chunk(chunk.compression, chunk.compressed_size, chunk.uncompressed_size);
  mcap::RawBuffer buffer;
  const auto guarded = [&](std::uint64_t offset, std::uint64_t length, Opcode opcode, auto take) {
    try {
      take(mcap::read_record_at(source, offset, opcode, summary.data_section_end, buffer));
    } catch (const Malformed& malformed) {
      gatherer.warn({offset, length, fmt::format("a {}: {}", mcap::name_of(opcode), malformed.what())});
    }
  };
  for (const mcap::MetadataIndex& entry : summary.metadata_indexes)
    guarded(entry.offset, entry.length, Opcode::kMetadata,
            [&](mcap::Bytes content) { gatherer.take(mcap::decode_metadata(content)); });
  for (const mcap::AttachmentIndex& entry : summary.attachment_indexes) {
    guarded(entry.offset, entry.length, Opcode::kAttachment, [&](mcap::Bytes content) {
      const mcap::Attachment attachment = mcap::decode_attachment(content);
      if (!mcap::attachment_crc_holds(content, attachment)) throw Malformed("its CRC is wrong");
      gatherer.take(attachment);
    });
  }
  count_events(source, summary, gatherer);
  return gatherer.finish(true);
}

void take_record(const mcap::StreamRecord& record, Gatherer& gatherer) {
  switch (record.opcode) {
    case Opcode::kHeader:
      gatherer.take(mcap::decode_header(record.content));
      break;
    case Opcode::kSchema:
      gatherer.take(mcap::decode_schema(record.content));
      break;
    case Opcode::kChannel:
      gatherer.take(mcap::decode_channel(record.content));
      break;
    case Opcode::kMessage:
      gatherer.take(mcap::decode_message(record.content));
      break;
    case Opcode::kMetadata:
      gatherer.take(mcap::decode_metadata(record.content));
      break;
    case Opcode::kAttachment:
      gatherer.take(mcap::decode_attachment(record.content));
      break;
    case Opcode::kChunk: {
      const mcap::Chunk chunk = mcap::decode_chunk(record.content);
      gatherer.take_chunk(chunk.compression, chunk.records.size(), chunk.uncompressed_size);
      break;
    }
    default:
      break;
  }
}

McapSummary from_everything(const mcap::ByteSource& source) {
  Gatherer gatherer(source);
  mcap::StreamReader reader(source, mcap::ChunkHandling::kExpandAndShow);
  mcap::StreamRecord record;
  while (reader.next(record)) {
    try {
      take_record(record, gatherer);
    } catch (const Malformed& malformed) {
      // StreamReader notes records that do not decode; what it cannot know is what a message of ours should be.
      if (record.opcode == Opcode::kMessage)
        gatherer.warn({record.offset, 0, fmt::format("a Message: {}", malformed.what())});
    }
  }
  for (const mcap::Damage& damage : reader.damages()) gatherer.warn(damage);
  return gatherer.finish(reader.footer_seen());
}

}  // namespace

McapSummary summarise_mcap(const std::filesystem::path& path, SummaryDepth depth) {
  const mcap::FileSource source(path);
  const mcap::SummaryResult result = mcap::read_summary(source);
  if (depth == SummaryDepth::kIndex && result.summary && is_enough(*result.summary))
    return from_index(source, *result.summary);
  return from_everything(source);
}

}  // namespace vestige
