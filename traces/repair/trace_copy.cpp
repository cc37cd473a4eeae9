#include "traces/repair/trace_copy.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <string_view>
#include <utility>

#include "traces/base/error.hpp"
#include "traces/mcap/decode.hpp"

namespace vestige {

namespace {

using mcap::Malformed;
using mcap::Opcode;

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
    : source_(source), reader_(source) {
  mcap::require_mcap(source);
  Definitions definitions = with_added(gather_definitions(source), added);
  const std::string profile = definitions.header ? definitions.header->profile : std::string();
  const mcap::Compression compression = definitions.compression.value_or(mcap::Compression::kNone);
  output_.emplace(sink, profile, compression, std::move(definitions));
}

Definitions TraceCopy::with_added(Definitions definitions, std::span<const AddedChannel> added) {
  for (const AddedChannel& one : added) topics_.insert(one.channel.topic);
  for (const auto& [id, channel] : definitions.channels)
    if (topics_.contains(channel.topic)) replaced_.insert(id);
  for (const AddedChannel& one : added) {
    mcap::Channel channel = one.channel;
    channel.id = free_id(definitions.channels);
    channel.schema_id = id_of(one.schema, definitions.schemas);
    channels_.push_back(channel.id);
    schemas_.insert(channel.schema_id);
    definitions.channels.insert_or_assign(channel.id, std::move(channel));
  }
  for (const std::uint16_t id : replaced_) definitions.channels.erase(id);
  return definitions;
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
      if (const mcap::Message message = mcap::decode_message(record.content); !replaced_.contains(message.channel_id))
        output_->write(message);
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

void TraceCopy::take_definition(mcap::Schema schema) {
  const auto known = output_->definitions().schemas.find(schema.id);
  if (schemas_.contains(schema.id) && known->second != schema) refuse_late("schema", schema.id);
  output_->add(std::move(schema));
}

void TraceCopy::take_definition(mcap::Channel channel) {
  if (std::ranges::find(channels_, channel.id) != channels_.end()) refuse_late("channel", channel.id);
  if (topics_.contains(channel.topic)) {
    replaced_.insert(channel.id);
  } else {
    output_->add(std::move(channel));
  }
}

void TraceCopy::refuse_late(std::string_view kind, std::uint16_t id) const {
  throw Error(source_.name(), fmt::format("{} {} is defined inside a chunk only", kind, id),
              "write it anew with 'vestige recompress', then take that file");
}

void TraceCopy::write(std::size_t added, std::uint32_t sequence, std::uint64_t time_ns, mcap::Bytes data) {
  output_->write(mcap::Message{.channel_id = channels_[added],
                               .sequence = sequence,
                               .log_time = time_ns,
                               .publish_time = time_ns,
                               .data = data});
}

void TraceCopy::finish() {
  copy_through(std::numeric_limits<std::uint64_t>::max());
  output_->write_definitions();
  output_->finish();
}

}  // namespace vestige
