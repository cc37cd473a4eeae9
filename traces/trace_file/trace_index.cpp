#include "traces/trace_file/trace_index.hpp"

#include <fmt/format.h>

#include <utility>

#include "traces/base/sha256.hpp"
#include "traces/mcap/decode.hpp"
#include "traces/mcap/summary.hpp"
#include "traces/trace_file/trace_format.hpp"

namespace vestige {

namespace {

using mcap::Malformed;
using mcap::Opcode;

void take_header(const mcap::Header& header, TraceIndex& index) {
  index.profile_is_ours = header.profile == trace_format::kProfile;
}

void take_metadata(mcap::Metadata metadata, std::uint64_t offset, TraceIndex& index) {
  if (metadata.name == trace_format::kSessionName) {
    index.session = std::move(metadata.metadata);
    index.session_offset = offset;
  } else if (metadata.name == trace_format::kRecoveredName) {
    index.recovered = std::move(metadata.metadata);
  } else if (metadata.name == trace_format::kReplacedName) {
    index.replaced = std::move(metadata.metadata);
  }
}

void take_attachment(mcap::Bytes content, TraceIndex& index) {
  const mcap::Attachment attachment = mcap::decode_attachment(content);
  if (!trace_format::attachment_id(attachment.name)) return;
  if (!mcap::attachment_crc_holds(content, attachment))
    throw Malformed(fmt::format("{}: its CRC is wrong", attachment.name));
  index.attachments[attachment.name].assign(attachment.data.begin(), attachment.data.end());
}

/// Whether the summary lists everything, so that scanning the file would find nothing more.
bool covers_everything(const mcap::ByteSource& source, const mcap::Summary& summary) {
  if (!summary.header || !summary.statistics) return false;
  return summary.statistics->schema_count == summary.schemas.size() &&
         summary.statistics->channel_count == summary.channels.size() && mcap::leads_to_everything(source, summary);
}

TraceIndex from_summary(const mcap::ByteSource& source, const mcap::Summary& summary) {
  TraceIndex index;
  index.has_footer = true;
  take_header(*summary.header, index);
  for (const mcap::Schema& schema : summary.schemas) index.streams.add(schema);
  for (const mcap::Channel& channel : summary.channels) index.streams.add(channel);
  const std::uint64_t limit = summary.data_section_end;
  mcap::RawBuffer buffer;
  const auto guarded = [&](std::uint64_t offset, std::uint64_t length, Opcode opcode, auto take) {
    try {
      take(mcap::read_record_at(source, offset, opcode, limit, buffer));
    } catch (const Malformed& malformed) {
      index.damages.add({offset, length, fmt::format("a {}: {}", mcap::name_of(opcode), malformed.what())});
    }
  };
  for (const mcap::MetadataIndex& entry : summary.metadata_indexes)
    guarded(entry.offset, entry.length, Opcode::kMetadata,
            [&](mcap::Bytes content) { take_metadata(mcap::decode_metadata(content), entry.offset, index); });
  for (const mcap::AttachmentIndex& entry : summary.attachment_indexes)
    guarded(entry.offset, entry.length, Opcode::kAttachment,
            [&](mcap::Bytes content) { take_attachment(content, index); });
  for (const mcap::ChunkIndex& chunk : summary.chunk_indexes) {
    index.places.push_back(
        {.in_chunk = true, .begin = chunk.chunk_start_offset, .end = chunk.chunk_start_offset + chunk.chunk_length});
  }
  return index;
}

void take_record(const mcap::RecordPlace& place, const mcap::RecordWalker& walker, mcap::RawBuffer& buffer,
                 TraceIndex& index) {
  switch (place.opcode) {
    case Opcode::kChunk:
      index.places.push_back({.in_chunk = true, .begin = place.offset, .end = place.end()});
      break;
    case Opcode::kMessage:
      if (!index.places.empty() && !index.places.back().in_chunk && index.places.back().end == place.offset) {
        index.places.back().end = place.end();
      } else {
        index.places.push_back({.begin = place.offset, .end = place.end()});
      }
      break;
    case Opcode::kHeader:
      take_header(mcap::decode_header(walker.content(place, buffer)), index);
      break;
    case Opcode::kSchema:
      index.streams.add(mcap::decode_schema(walker.content(place, buffer)));
      break;
    case Opcode::kChannel:
      index.streams.add(mcap::decode_channel(walker.content(place, buffer)));
      break;
    case Opcode::kMetadata:
      take_metadata(mcap::decode_metadata(walker.content(place, buffer)), place.offset, index);
      break;
    case Opcode::kAttachment:
      take_attachment(walker.content(place, buffer), index);
      break;
    default:
      break;
  }
}

TraceIndex by_scanning(const mcap::ByteSource& source) {
  TraceIndex index;
  mcap::RecordWalker walker(source);
  mcap::RecordPlace place;
  mcap::RawBuffer buffer;
  const auto note_framing = [&] {
    for (const mcap::Damage& damage : walker.damages()) index.damages.add(damage);
  };
  while (walker.next(place)) {
    note_framing();
    try {
      take_record(place, walker, buffer, index);
    } catch (const Malformed& malformed) {
      index.damages.add({place.offset, place.end() - place.offset,
                         fmt::format("a {}: {}", mcap::name_of(place.opcode), malformed.what())});
    }
  }
  index.has_footer = walker.footer_seen();
  note_framing();
  return index;
}

void check(const mcap::ByteSource& source, TraceIndex& index) {
  std::map<std::string, std::string> sha256;
  for (const auto& [name, data] : index.attachments)
    if (!data.empty()) sha256.emplace(name, sha256_hex(data));
  index.people = people_of(index.claims(), index.streams, sha256);
  for (const SessionProblem& problem : check_session(source.name(), index.claims(), sha256))
    index.damages.add({index.session_offset, 0, fmt::format("{}; {}", problem.what, problem.consequence)});
}

TraceIndex read_index(const mcap::ByteSource& source) {
  const mcap::SummaryResult result = mcap::read_summary(source);
  if (result.summary && covers_everything(source, *result.summary)) return from_summary(source, *result.summary);
  TraceIndex index = by_scanning(source);
  if (index.has_footer && !result.summary && index.damages.empty())  // otherwise the damages explain it
    index.damages.add({source.size(), 0, fmt::format("the file's end: {}", result.problem)});
  return index;
}

}  // namespace

std::span<const std::byte> TraceIndex::attachment(trace_format::AttachmentKind kind, std::size_t person) const {
  const auto found = attachments.find(trace_format::attachment_name(kind, person));
  return found == attachments.end() ? std::span<const std::byte>() : found->second;
}

TraceIndex index_trace(const mcap::ByteSource& source) {
  TraceIndex index = read_index(source);
  refuse_later_version(source.name(), index.session);
  check(source, index);
  return index;
}

std::string describe(const mcap::Damage& damage, std::string_view file) {
  std::string text = fmt::format("{}: at byte {}: {}", file, damage.offset, damage.what);
  if (damage.bytes > 0 && damage.effect == mcap::DamageEffect::kLost)
    text += fmt::format("; {} bytes are lost", damage.bytes);
  return text;
}

}  // namespace vestige
