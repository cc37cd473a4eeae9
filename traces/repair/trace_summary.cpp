#include "traces/repair/trace_summary.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>
#include <utility>

#include "traces/base/nanoseconds.hpp"
#include "traces/base/sha256.hpp"
#include "traces/mcap/byte_source.hpp"
#include "traces/mcap/stream_reader.hpp"
#include "traces/trace_file/message_stream.hpp"
#include "traces/trace_file/recovered.hpp"
#include "traces/trace_file/session_check.hpp"
#include "traces/trace_file/trace_format.hpp"
#include "traces/trace_file/trace_index.hpp"
#include "traces/trace_file/trace_messages.hpp"

namespace vestige {

namespace {

using mcap::Malformed;
using mcap::Opcode;
using trace_format::Stream;

/// Gathers the data of a summary.
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
    schema_names_.insert_or_assign(schema.id, schema.name);
    streams_.add(std::move(schema));
  }
  void take(mcap::Channel channel) {
    streams_.add(channel);
    channels_.insert_or_assign(channel.id, std::move(channel));
  }
  void take(mcap::Metadata metadata, std::uint64_t offset) {
    if (metadata.name == trace_format::kRecoveredName) summary_.recovered = describe_recovered(metadata.metadata);
    if (metadata.name == trace_format::kReplacedName) claims_.replaced = metadata.metadata;
    if (metadata.name != trace_format::kSessionName) return;
    summary_.session = std::move(metadata.metadata);
    session_offset_ = offset;
  }
  void take(const mcap::Attachment& attachment) {
    summary_.attachments.push_back({.name = attachment.name,
                                    .media_type = attachment.media_type,
                                    .bytes = attachment.data.size(),
                                    .sha256 = sha256_hex(attachment.data),
                                    .is_recorded = {}});
  }
  void take(const mcap::Message& message);
  void take_chunk(const std::string& compression, std::uint64_t compressed, std::uint64_t uncompressed) {
    ++summary_.chunks;
    compressions_.insert(compression.empty() ? "none" : compression);
    summary_.compressed_bytes += compressed;
    summary_.uncompressed_bytes += uncompressed;
  }
  void warn(mcap::Damage damage) { damages_.add(std::move(damage)); }
  void warn(const mcap::DamageList& damages) { damages_.add(damages); }

  McapSummary finish(bool has_footer);

 private:
  void check_attachments();

  const mcap::ByteSource& source_;
  McapSummary summary_;
  StreamTable streams_;
  MessageDecoder decoder_;
  std::map<std::uint16_t, std::string> schema_names_;
  std::map<std::uint16_t, mcap::Channel> channels_;
  std::map<std::uint16_t, std::uint64_t> messages_;
  std::set<std::string> compressions_;
  AttachmentClaims claims_;  ///< without the session
  std::uint64_t session_offset_ = 0;
  mcap::DamageList damages_;
  bool header_taken_ = false;
  bool timed_ = false;
};

void Gatherer::take(const mcap::Message& message) {
  summary_.start_ns = timed_ ? std::min(summary_.start_ns, message.log_time) : message.log_time;
  summary_.end_ns = timed_ ? std::max(summary_.end_ns, message.log_time) : message.log_time;
  timed_ = true;
  ++messages_[message.channel_id];
  if (streams_.stream_of(message.channel_id) != Stream::kEvents) return;
  const TraceEvent event = decoder_.event(message.data);
  if (event.kind != trace_format::kDroppedKind) return;
  summary_.dropped += event.count;
  // Vestige's recorders use three topics; a foreign file may name a new topic in each message.
  std::string topic = dropped_topic(event);
  auto& dropped = summary_.dropped_by_topic;
  if (dropped.size() >= mcap::DamageList::kMostKept && !dropped.contains(topic)) topic = "(other topics)";
  dropped[topic] += event.count;
}

void Gatherer::check_attachments() {
  claims_.pose = pose_metadata(streams_);
  claims_.version_of_schemas = streams_.version_of_schemas();
  if (summary_.session) claims_.session = *summary_.session;
  std::map<std::string, std::string> sha256;
  for (McapSummary::Attachment& attachment : summary_.attachments) {
    sha256[attachment.name] = attachment.sha256;
    attachment.is_recorded = is_recorded(claims_, attachment.name, attachment.sha256);
  }
  summary_.is_trace = !streams_.pose_channels().empty();
  summary_.people = people_of(claims_, streams_, sha256);
  for (const SessionProblem& problem : check_session(source_.name(), claims_, sha256))
    warn({session_offset_, 0, fmt::format("{}; {}", problem.what, problem.consequence)});
}

McapSummary Gatherer::finish(bool has_footer) {
  summary_.file_bytes = source_.size();
  if (summary_.end_ns > summary_.start_ns)
    summary_.duration_s = static_cast<double>(summary_.end_ns - summary_.start_ns) / kNanosecondsPerSecond;
  for (const auto& [id, channel] : channels_) {
    McapSummary::Channel shown;
    shown.topic = channel.topic;
    shown.encoding = channel.message_encoding;
    if (const auto schema = schema_names_.find(channel.schema_id); schema != schema_names_.end())
      shown.schema = schema->second;
    if (const auto count = messages_.find(id); count != messages_.end()) shown.messages = count->second;
    if (shown.messages > 1 && summary_.duration_s > 0)
      shown.rate_hz = static_cast<double>(shown.messages - 1) / summary_.duration_s;
    summary_.channels.push_back(std::move(shown));
  }
  for (const auto& [id, count] : messages_) summary_.messages += count;
  check_attachments();
  summary_.compression.assign(compressions_.begin(), compressions_.end());
  summary_.complete = has_footer && damages_.empty();
  damages_.sort_by_offset();
  for (const mcap::Damage& damage : damages_.kept()) summary_.warnings.push_back(describe(damage, source_.name()));
  if (const std::uint64_t more = damages_.count() - damages_.kept().size(); more > 0)
    summary_.warnings.push_back(fmt::format("{}: and {} more", source_.name(), more));
  return std::move(summary_);
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
      gatherer.take(mcap::decode_metadata(record.content), record.offset);
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

}  // namespace

McapSummary summarise_mcap(const std::filesystem::path& path) {
  const mcap::FileSource source(path);
  Gatherer gatherer(source);
  mcap::StreamReader reader(source, mcap::ChunkHandling::kExpandAndShow);
  mcap::StreamRecord record;
  while (reader.next(record)) {
    try {
      take_record(record, gatherer);
    } catch (const Malformed& malformed) {
      // StreamReader notes records that do not decode. It cannot know what Vestige's own messages should contain.
      if (record.opcode == Opcode::kMessage)
        gatherer.warn({record.offset, 0, fmt::format("a Message: {}", malformed.what())});
    }
  }
  gatherer.warn(reader.damages());
  return gatherer.finish(reader.footer_seen());
}

}  // namespace vestige
