#include "traces/repair/recover.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include "traces/base/error.hpp"
#include "traces/mcap/decode.hpp"
#include "traces/repair/recoverer.hpp"

namespace vestige {

namespace {

using mcap::Bytes;
using mcap::Malformed;
using mcap::Opcode;
using mcap::RecordPlace;
using mcap::Trust;
using trace_format::Stream;

constexpr std::size_t kMostRepairsTold = 100;

/// Whether records of this kind describe other records. The new file gets its own instead.
bool is_rebuilt(Opcode opcode) {
  switch (opcode) {
    case Opcode::kFooter:
    case Opcode::kMessageIndex:
    case Opcode::kChunkIndex:
    case Opcode::kAttachmentIndex:
    case Opcode::kStatistics:
    case Opcode::kMetadataIndex:
    case Opcode::kSummaryOffset:
    case Opcode::kDataEnd:
      return true;
    default:
      return false;
  }
}

std::string profile_of(const Definitions& definitions) {
  if (definitions.header) return definitions.header->profile;
  const bool has_poses = !streams_of(definitions).pose_channels().empty();
  return has_poses ? std::string(trace_format::kProfile) : std::string();
}

Definitions without_contradictions(Definitions definitions, PoseNodes& pose_nodes) {
  std::erase_if(definitions.channels, [&](const auto& entry) { return !pose_nodes.agrees(entry.second); });
  return definitions;
}

}  // namespace

Recoverer::Recoverer(const mcap::ByteSource& source, const mcap::Writer::Sink& sink, Definitions definitions,
                     ReplacementPlan plan)
    : source_(source),
      plan_(std::move(plan)),
      walker_(source, mcap::MagicBytes::kMayBeBroken),
      output_(sink, profile_of(definitions), definitions.compression.value_or(mcap::Compression::kNone),
              without_contradictions(definitions, pose_nodes_)),
      gate_(output_.streams(), [this](const mcap::Message& message) { write(message); }) {}

void Recoverer::repaired(std::string what) {
  if (result_.repaired.size() < kMostRepairsTold) result_.repaired.push_back(std::move(what));
}

Recovery Recoverer::run(const std::function<bool(double)>& progress) {
  learn_node_counts();
  RecordPlace place;
  while (walker_.next(place)) {
    take_damages();
    take(place);
    if (!progress(static_cast<double>(place.end()) / static_cast<double>(source_.size())))
      throw Error(source_.name(), "the recovery was stopped; nothing was written", "");
  }
  take_damages();
  finish();
  return std::move(result_);
}

void Recoverer::learn_node_counts() {
  for (const auto& [person, channel] : output_.streams().pose_channels())
    if (const auto names = parse_node_names(*channel)) gate_.set_node_count(person, names->size());
}

void Recoverer::take_damages() {
  for (const mcap::Damage& damage : walker_.damages()) take_damage(damage);
}

/// Tries to use the bytes at a place with broken framing, up to the next acceptable record.
void Recoverer::take_damage(const mcap::Damage& damage) {
  const bool behind_footer = walker_.footer_seen() && damage.offset >= walker_.position();
  const bool only_magic_is_broken = damage.effect == mcap::DamageEffect::kLost && damage.bytes <= mcap::kMagicBytes;
  if (behind_footer && !only_magic_is_broken) {
    result_.bytes_lost += damage.bytes;
    if (damage.effect == mcap::DamageEffect::kAnotherFile) result_.another_file_at = damage.offset;
    return;
  }
  const bool mended = damage.effect == mcap::DamageEffect::kMended;
  const bool only_magic = damage.offset + damage.bytes <= mcap::kMagicBytes;
  if (damage.bytes == 0 || only_magic || behind_footer || mended) {
    repaired(fmt::format("at byte {}: {}", damage.offset, damage.what));
    return;
  }
  std::array<std::byte, 1> first = {};
  source_.read_at(damage.offset, first);
  const auto opcode = static_cast<Opcode>(first[0]);
  if (is_rebuilt(opcode)) {
    repaired(fmt::format("at byte {}: a {} was broken", damage.offset, mcap::name_of(opcode)));
    if (!data_ended_) result_.bytes_lost += damage.bytes - bytes_of_rebuilt(damage);
    return;
  }
  if (data_ended_) return;
  if (damage.bytes < mcap::kRecordHeadBytes) {
    result_.bytes_lost += damage.bytes;
    return;
  }
  const std::uint64_t content_bytes = damage.bytes - mcap::kRecordHeadBytes;
  if (content_bytes > mcap::kMaxChunkBytes) {
    result_.bytes_lost += damage.bytes;
    return;
  }
  source_.read_at(damage.offset + mcap::kRecordHeadBytes, content_.reset(static_cast<std::size_t>(content_bytes)));
  const Bytes content = content_.bytes();
  if (opcode == Opcode::kChunk) {
    take_chunk(content);
  } else if (mcap::natural_content_bytes(opcode, content) == content_bytes) {
    // Only the record's length was broken: its own fields end where the next record begins.
    take_record(opcode, content, damage.offset);
    repaired(fmt::format("at byte {}: the length of a {} was broken", damage.offset, mcap::name_of(opcode)));
  } else {
    take_misnamed(content, damage.offset);
  }
}

/// Returns how many bytes of a damaged place belong to the record that begins there, by its length, or otherwise by its
/// fields.
std::uint64_t Recoverer::bytes_of_rebuilt(const mcap::Damage& damage) {
  const std::uint64_t end = damage.offset + damage.bytes;
  if (damage.bytes < mcap::kRecordHeadBytes) return damage.bytes;
  std::array<std::byte, mcap::kRecordHeadBytes> head = {};
  source_.read_at(damage.offset, head);
  mcap::Cursor cursor{Bytes(head)};
  const auto opcode = static_cast<Opcode>(cursor.number<std::uint8_t>());
  const auto content_bytes = cursor.number<std::uint64_t>();
  const std::uint64_t rest = damage.bytes - mcap::kRecordHeadBytes;
  if (content_bytes <= rest) return mcap::kRecordHeadBytes + content_bytes;
  if (end == source_.size()) return damage.bytes;  // the file was cut inside the record
  const std::uint64_t looked_at = std::min<std::uint64_t>(rest, mcap::kMaxChunkBytes);
  source_.read_at(damage.offset + mcap::kRecordHeadBytes, content_.reset(static_cast<std::size_t>(looked_at)));
  const auto natural = mcap::natural_content_bytes(opcode, content_.bytes());
  return natural && *natural <= rest ? mcap::kRecordHeadBytes + *natural : 0;
}

void Recoverer::take(const RecordPlace& place) {
  // The records after the data section are made anew. Messages there violate MCAP's rules, but readers accept them.
  if (data_ended_ && place.opcode != Opcode::kChunk && place.opcode != Opcode::kMessage) return;
  if (place.content_bytes > mcap::kMaxChunkBytes && place.opcode != Opcode::kAttachment) {
    result_.bytes_lost += place.end() - place.offset;
    return;
  }
  const Bytes content = walker_.content(place, content_);
  if (place.opcode == Opcode::kDataEnd) {
    take_data_end(place, content);
    return;
  }
  if (place.offset == crc_end_) {
    std::array<std::byte, mcap::kRecordHeadBytes> head = {};
    source_.read_at(place.offset, head);
    crc_ = mcap::crc32(content, mcap::crc32(head, crc_));
    crc_end_ = place.end();
  }
  if (place.opcode == Opcode::kChunk) {
    take_chunk(content);
  } else if (place.opcode == Opcode::kMessage || mcap::natural_content_bytes(place.opcode, content)) {
    take_record(place.opcode, content, place.offset);
  } else {
    take_misnamed(content, place.offset);
  }
}

void Recoverer::take_data_end(const RecordPlace& place, Bytes content) {
  data_ended_ = true;
  const std::uint32_t expected = mcap::decode_data_end(content).data_section_crc;
  const bool comparable = expected != 0 && place.offset == crc_end_;
  if (comparable && crc_ != expected && !result_.lost_something() && result_.repaired.empty())
    result_.unexplained_change = true;
}

/// Takes a record of unknown kind, or one whose fields do not fit.
void Recoverer::take_misnamed(Bytes content, std::uint64_t offset) {
  if (mcap::is_whole_chunk(content, expanded_)) {
    repaired(fmt::format("at byte {}: the opcode of a Chunk was broken", offset));
    take_chunk(content);
  } else {
    result_.bytes_lost += content.size() + mcap::kRecordHeadBytes;
  }
}

/// Takes a record outside chunks whose fields fit.
void Recoverer::take_record(Opcode opcode, Bytes content, std::uint64_t offset) {
  switch (opcode) {
    case Opcode::kSchema:
    case Opcode::kChannel:
    case Opcode::kMessage:
      take_inner(opcode, content, Trust::kVerified);
      output_.end_full_chunk();
      break;
    case Opcode::kAttachment:
      take_attachment(content);
      break;
    case Opcode::kMetadata:
      take_metadata(mcap::decode_metadata(content));
      break;
    case Opcode::kHeader:
      break;
    default:
      if (!is_rebuilt(opcode)) take_misnamed(content, offset);
  }
}

void Recoverer::take_chunk(Bytes content) {
  const mcap::ChunkRemains remains = mcap::salvage_chunk(content, expanded_);
  const std::uint64_t before = messages_found_;
  if (remains.trust == Trust::kVerified) {
    take_records(remains.records);
    ++result_.chunks_whole;
  } else {
    take_remains(remains.records);
    if (messages_found_ > before) {
      ++result_.chunks_partly;
    } else {
      ++result_.chunks_lost;
      result_.bytes_lost += content.size() + mcap::kRecordHeadBytes;
    }
  }
  output_.end_chunk();
}

void Recoverer::take_records(Bytes records) {
  mcap::Cursor cursor(records);
  try {
    while (cursor.remaining() > 0) {
      const mcap::InnerRecord record = mcap::next_record(cursor);
      try {
        take_inner(record.opcode, record.content, Trust::kVerified);
      } catch (const Malformed&) {
        // The record's fields do not fit, but the start of the next record is known.
        result_.bytes_lost += record.content.size() + mcap::kRecordHeadBytes;
      }
    }
  } catch (const Malformed&) {
    // The chunk's CRC matches, so the chunk was written like this.
    result_.bytes_lost += cursor.remaining();
  }
}

void Recoverer::take_remains(Bytes records) {
  mcap::SalvagedRecords salvaged(records);
  mcap::InnerRecord record;
  while (salvaged.next(record)) {
    try {
      take_inner(record.opcode, record.content, Trust::kUnverified);
    } catch (const Malformed&) {
      continue;  // the record's fields do not fit
    }
  }
}

void Recoverer::take_inner(Opcode opcode, Bytes content, Trust trust) {
  switch (opcode) {
    case Opcode::kSchema:
      output_.add(mcap::decode_schema(content));
      break;
    case Opcode::kChannel: {
      mcap::Channel channel = mcap::decode_channel(content);
      if (!output_.definitions().channels.contains(channel.id) && !pose_nodes_.agrees(channel)) {
        result_.bytes_lost += content.size() + mcap::kRecordHeadBytes;
        break;
      }
      if (output_.definitions().channels.contains(channel.id)) break;
      output_.add(std::move(channel));
      learn_node_counts();
      break;
    }
    case Opcode::kMessage:
      gate_.take(mcap::decode_message(content), trust);
      ++messages_found_;
      break;
    default:
      break;
  }
}

void Recoverer::write(const mcap::Message& message) {
  if (!output_.write(message)) ++unknown_messages_;
}

void Recoverer::count_messages() {
  result_.messages = output_.statistics().message_count;
  result_.messages_unverified = gate_.unverified();
  result_.messages_left_out = gate_.left_out() + unknown_messages_;
  if (const auto& claimed = output_.definitions().statistics)
    result_.messages_lost = claimed->message_count > result_.messages ? claimed->message_count - result_.messages : 0;
}

void Recoverer::finish() {
  gate_.finish();
  for (const auto& [name, replacement] : plan_.attachments) replace(name, replacement);
  result_.unused = plan_.unused;
  count_messages();
  const bool found_something =
      result_.messages + result_.attachments + result_.damaged_attachments.size() + result_.metadata > 0;
  if (!found_something && (!output_.definitions().header || !walker_.footer_seen() || result_.lost_something()))
    throw Error(source_.name(), "nothing in it can be recovered", "check that it is the right file");
  output_.write_definitions();
  write_replaced();
  if (result_.lost_something())
    output_.write(mcap::Metadata{
        .name = std::string(trace_format::kRecoveredName),
        .metadata = {{"bytes_lost", fmt::format("{}", result_.bytes_lost)},
                     {"chunks_lost", fmt::format("{}", result_.chunks_lost)},
                     {"chunks_partly_lost", fmt::format("{}", result_.chunks_partly)},
                     {"messages_lost", result_.messages_lost ? fmt::format("{}", *result_.messages_lost) : "unknown"},
                     {"messages_left_out", fmt::format("{}", result_.messages_left_out)},
                     {"messages_unverified", fmt::format("{}", result_.messages_unverified)}}});
  output_.finish();
}

Recovery recover_mcap(const mcap::ByteSource& source, const mcap::Writer::Sink& sink,
                      const std::function<bool(double)>& progress, const Substitutes& substitutes) {
  const Definitions definitions = gather_definitions(source);
  if (substitutes.empty()) return Recoverer(source, sink, definitions).run(progress);
  // Only after everything was read is it known what is missing, so the file is recovered twice.
  Recoverer rehearsal(
      source, [](Bytes) {}, definitions);
  static_cast<void>(rehearsal.run([&](double share) { return progress(share / 2); }));
  const AttachmentFacts facts = rehearsal.facts();
  return Recoverer(source, sink, definitions, plan_replacements(source.name(), facts, substitutes))
      .run([&](double share) { return progress(0.5 + share / 2); });
}

}  // namespace vestige
