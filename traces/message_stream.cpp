#include "traces/message_stream.hpp"

#include <fmt/format.h>

#include <utility>

#include "traces/mcap/chunk_expander.hpp"
#include "traces/mcap/summary.hpp"

namespace vestige {

using mcap::Malformed;
using mcap::Opcode;
using trace_format::Stream;

// Outside chunks no CRC vouches for a definition, and in a damaged file its copies may differ: what is recognised as
// ours stays.

void StreamTable::add(mcap::Schema schema) {
  const std::uint16_t id = schema.id;
  const auto known = schemas_.find(id);
  if (known != schemas_.end() && trace_format::is_ours(known->second)) return;
  const bool is_ours = trace_format::is_ours(schema);
  schemas_.insert_or_assign(id, std::move(schema));
  // A file may define 65535 of both: each channel is looked at once, when a schema of ours comes after it.
  if (!is_ours) return;
  for (auto use = channels_of_schema_.lower_bound({id, 0}); use != channels_of_schema_.end() && use->first == id; ++use)
    update(channels_.at(use->second));
}

void StreamTable::add(mcap::Channel channel) {
  const std::uint16_t id = channel.id;
  if (streams_[id] != Stream::kForeign) return;
  if (const auto known = channels_.find(id); known != channels_.end())
    channels_of_schema_.erase({known->second.schema_id, id});
  channels_of_schema_.emplace(channel.schema_id, id);
  update(channels_.insert_or_assign(id, std::move(channel)).first->second);
}

void StreamTable::update(const mcap::Channel& channel) {
  const auto schema = schemas_.find(channel.schema_id);
  streams_[channel.id] = trace_format::recognise(channel, schema == schemas_.end() ? nullptr : &schema->second);
}

const mcap::Channel* StreamTable::find(Stream stream) const {
  for (const auto& [id, channel] : channels_) {
    if (streams_[id] == stream) return &channel;
  }
  return nullptr;
}

MessageStream::MessageStream(const mcap::ByteSource& source, const std::vector<mcap::RecordPlace>& places,
                             StreamTable& table, Report report)
    : source_(source), places_(places), table_(table), report_(std::move(report)) {}

void MessageStream::rewind() {
  next_place_ = 0;
  chunk_ = mcap::Cursor({});
}

bool MessageStream::next(TraceMessage& message) {
  for (;;) {
    if (next_in_chunk(message)) return true;
    if (next_place_ == places_.size()) return false;
    const mcap::RecordPlace& place = places_[next_place_++];
    try {
      if (place.opcode == Opcode::kChunk) {
        open(place);
      } else if (take(place.offset,
                      mcap::read_record_at(source_, place.offset, Opcode::kMessage, place.end(), content_), message)) {
        return true;
      }
    } catch (const Malformed& malformed) {
      report_({place.offset, place.end() - place.offset,
               fmt::format("a {}: {}", mcap::name_of(place.opcode), malformed.what())});
    }
  }
}

void MessageStream::open(const mcap::RecordPlace& place) {
  const mcap::Bytes content = mcap::read_record_at(source_, place.offset, Opcode::kChunk, place.end(), content_);
  chunk_ = mcap::Cursor(mcap::expand_chunk(mcap::decode_chunk(content), expanded_));
  chunk_offset_ = place.offset;
  misfit_told_ = false;
}

bool MessageStream::next_in_chunk(TraceMessage& message) {
  while (chunk_.remaining() > 0) {
    try {
      const mcap::InnerRecord record = mcap::next_record(chunk_);
      if (!mcap::belongs_in_chunks(record.opcode)) continue;
      if (!mcap::fits_its_fields(record)) {
        // Once for a chunk, which may hold millions.
        if (!std::exchange(misfit_told_, true))
          report_({chunk_offset_, 0, "records in a Chunk: their fields do not fit into them"});
        continue;
      }
      if (record.opcode == Opcode::kSchema) table_.add(mcap::decode_schema(record.content));
      if (record.opcode == Opcode::kChannel) table_.add(mcap::decode_channel(record.content));
      if (record.opcode == Opcode::kMessage && take(chunk_offset_, record.content, message)) return true;
    } catch (const Malformed& malformed) {
      report_({chunk_offset_, chunk_.remaining(), fmt::format("the rest of a Chunk's records: {}", malformed.what())});
      chunk_ = mcap::Cursor({});
    }
  }
  return false;
}

bool MessageStream::take(std::uint64_t offset, mcap::Bytes content, TraceMessage& message) {
  message.message = mcap::decode_message(content);
  message.stream = table_.stream_of(message.message.channel_id);
  message.offset = offset;
  return message.stream != Stream::kForeign;
}

}  // namespace vestige
