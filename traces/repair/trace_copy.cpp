#include "traces/repair/trace_copy.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <map>
#include <string_view>
#include <utility>

#include "traces/base/error.hpp"
#include "traces/mcap/decode.hpp"

namespace vestige {

namespace {

using mcap::Malformed;
using mcap::Opcode;

constexpr std::string_view kDefinedLate = "is defined inside a chunk only";
constexpr std::string_view kDefinedTwice = "is defined twice, differently";

/// Returns an id that the map does not have. The ids that writers choose are small, so this one is large.
template <typename Record>
std::uint16_t free_id(const std::map<std::uint16_t, Record>& records) {
  for (std::uint16_t id = std::numeric_limits<std::uint16_t>::max(); id > 0; --id)
    if (!records.contains(id)) return id;
  throw Error("channels", "every id is taken", "use a file with fewer channels");
}

/// Returns the id of the schema among `schemas`, to which it is added if it is new.
std::uint16_t id_of(mcap::Schema schema, std::map<std::uint16_t, mcap::Schema>& schemas) {
  for (const auto& [id, known] : schemas) {
    schema.id = id;
    if (schema == known) return id;
  }
  schema.id = free_id(schemas);
  return schemas.emplace(schema.id, std::move(schema)).first->first;
}

}  // namespace

TraceCopy::TraceCopy(const mcap::ByteSource& source, const mcap::Writer::Sink& sink,
                     std::span<const AddedChannel> added)
    : source_(source), reader_(source), added_(added.begin(), added.end()) {
  mcap::require_mcap(source);
  Definitions definitions = gather_definitions(source);
  choose_ids(definitions);
  for (const std::uint16_t id : replaced_) definitions.channels.erase(id);
  const std::string profile = definitions.header ? definitions.header->profile : std::string();
  const mcap::Compression compression = definitions.compression.value_or(mcap::Compression::kNone);
  output_.emplace(sink, profile, compression, std::move(definitions));
}

void TraceCopy::choose_ids(const Definitions& definitions) {
  std::map<std::uint16_t, mcap::Channel> channels = definitions.channels;
  std::map<std::uint16_t, mcap::Schema> schemas = definitions.schemas;
  for (AddedChannel& one : added_) {
    for (const auto& [id, channel] : definitions.channels)
      if (channel.topic == one.channel.topic) replaced_.insert(id);
    one.schema.id = id_of(one.schema, schemas);
    one.channel.schema_id = one.schema.id;
    one.channel.id = free_id(channels);
    channels.emplace(one.channel.id, one.channel);
    if (definitions.schemas.contains(one.schema.id)) shared_schemas_.insert(one.schema.id);
  }
}

void TraceCopy::copy_through(std::uint64_t frame) {
  output_->end_full_chunk();
  for (;;) {
    if (!head_) {
      mcap::StreamRecord record;
      if (!reader_.next(record)) return;
      head_ = record;
    }
    try {
      if (head_->opcode == Opcode::kMessage) {
        const mcap::Message message = mcap::decode_message(head_->content);
        const bool is_ours = output_->streams().stream_of(message.channel_id) != trace_format::Stream::kForeign;
        if (is_ours && message.sequence > frame) return;
      }
      take(*head_);
    } catch (const Malformed&) {
      // The reader notes records whose fields do not fit.
    }
    head_.reset();
  }
}

void TraceCopy::take(const mcap::StreamRecord& record) {
  switch (record.opcode) {
    case Opcode::kSchema:
      take_definition(mcap::decode_schema(record.content));
      break;
    case Opcode::kChannel:
      take_definition(mcap::decode_channel(record.content));
      break;
    case Opcode::kMessage:
      take_message(record);
      break;
    case Opcode::kAttachment:
      // A new CRC must not make a damaged attachment look undamaged. The reader notes it.
      if (const mcap::Attachment attachment = mcap::decode_attachment(record.content);
          mcap::attachment_crc_holds(record.content, attachment))
        output_->write(attachment);
      break;
    case Opcode::kMetadata:
      output_->write(mcap::decode_metadata(record.content));
      break;
    default:
      break;
  }
}

void TraceCopy::take_message(const mcap::StreamRecord& record) {
  const mcap::Message message = mcap::decode_message(record.content);
  if (replaced_.contains(message.channel_id)) return;
  if (!output_->write(message) && undefined_.insert(message.channel_id).second)
    damages_.add(undefined_channel(record.offset, message.channel_id));
}

void TraceCopy::take_definition(mcap::Schema schema) {
  for (const AddedChannel& one : added_)
    if (one.schema.id == schema.id && one.schema != schema)
      refuse("schema", schema.id, shared_schemas_.contains(schema.id) ? kDefinedTwice : kDefinedLate);
  output_->add(std::move(schema));
}

void TraceCopy::take_definition(mcap::Channel channel) {
  for (const AddedChannel& one : added_)
    if (one.channel.id == channel.id) refuse("channel", channel.id, kDefinedLate);
  if (std::ranges::any_of(added_, [&](const auto& one) { return one.channel.topic == channel.topic; })) {
    replaced_.insert(channel.id);
  } else {
    output_->add(std::move(channel));
  }
}

void TraceCopy::refuse(std::string_view what, std::uint16_t id, std::string_view cause) const {
  throw Error(source_.name(), fmt::format("{} {} {}", what, id, cause),
              "write it anew with 'vestige recompress', then take that file");
}

mcap::DamageList TraceCopy::damages() const {
  mcap::DamageList all = reader_.damages();
  all.add(damages_);
  all.sort_by_offset();
  return all;
}

void TraceCopy::write(std::size_t added, std::uint32_t sequence, std::uint64_t time_ns, mcap::Bytes data) {
  const auto& [channel, schema] = added_[added];
  if (!output_->definitions().channels.contains(channel.id)) {
    output_->add(schema);
    output_->add(channel);
  }
  output_->write(mcap::Message{
      .channel_id = channel.id, .sequence = sequence, .log_time = time_ns, .publish_time = time_ns, .data = data});
}

void TraceCopy::finish() {
  copy_through(std::numeric_limits<std::uint64_t>::max());
  output_->write_definitions();
  output_->finish();
}

}  // namespace vestige
