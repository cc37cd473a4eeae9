#include "traces/trace_file/message_stream.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "traces/mcap/summary.hpp"

namespace vestige {

using mcap::Malformed;
using mcap::Opcode;
using trace_format::Stream;

namespace {

constexpr std::string_view kCollidersSchema =
    trace_format::kStreams[static_cast<std::size_t>(Stream::kColliders)].schema;

}  // namespace

// Outside chunks no single CRC covers a definition, and in a damaged file its copies may differ. A definition
// recognised as Vestige's own is therefore never replaced.

void StreamTable::add(mcap::Schema schema) {
  const std::uint16_t id = schema.id;
  const auto known = schemas_.find(id);
  if (known != schemas_.end() && trace_format::is_ours(known->second)) return;
  const bool is_ours = trace_format::is_ours(schema);
  for (const int version : {trace_format::kPointsVersion, trace_format::kSpheresVersion})
    if (is_ours && schema.name == kCollidersSchema &&
        schema.data == trace_format::schema_of(Stream::kColliders, version).data)
      knows_one_person_ = true;
  constexpr std::size_t kMostBytes = 65536;  // far more than Vestige's own have; a foreign one may have any size
  if (!is_ours || schema.data.size() > kMostBytes) schema.data = {};
  schemas_.insert_or_assign(id, std::move(schema));
  // A file may define 65535 schemas and as many channels. So a channel is only looked at again if a Vestige schema with
  // its schema id comes after it.
  if (!is_ours) return;
  for (auto use = channels_of_schema_.lower_bound({id, 0}); use != channels_of_schema_.end() && use->first == id; ++use)
    update(channels_.at(use->second));
}

void StreamTable::add(mcap::Channel channel) {
  const std::uint16_t id = channel.id;
  if (id_of(id).stream != Stream::kForeign) return;
  if (const auto known = channels_.find(id); known != channels_.end())
    channels_of_schema_.erase({known->second.schema_id, id});
  channels_of_schema_.emplace(channel.schema_id, id);
  update(channels_.insert_or_assign(id, std::move(channel)).first->second);
}

void StreamTable::update(const mcap::Channel& channel) {
  const auto schema = schemas_.find(channel.schema_id);
  const trace_format::StreamId stream =
      trace_format::recognise(channel, schema == schemas_.end() ? nullptr : &schema->second);
  if (channel.id >= streams_.size()) streams_.resize(std::size_t{channel.id} + 1);
  streams_[channel.id] = stream;
  if (stream.stream == Stream::kForeign) return;
  const auto [first, is_new] = channel_of_.try_emplace(stream, channel.id);
  first->second = std::min(first->second, channel.id);
}

std::optional<int> StreamTable::version_of_schemas() const {
  for (int version = trace_format::kPointsVersion; version <= trace_format::kNewestVersion; ++version) {
    const auto is_of_version = [&](Stream stream) {
      const mcap::Channel* channel = find(stream);
      if (channel == nullptr) return stream == Stream::kEvents;
      const auto schema = schemas_.find(channel->schema_id);
      return schema != schemas_.end() && schema->second.data == trace_format::schema_of(stream, version).data;
    };
    if (is_of_version(Stream::kPose) && is_of_version(Stream::kColliders) && is_of_version(Stream::kEvents))
      return version;
  }
  return {};
}

const mcap::Channel* StreamTable::find(Stream stream, std::size_t person) const {
  if (is_foreign(person)) return nullptr;
  const auto found = channel_of_.find({stream, person});
  return found == channel_of_.end() ? nullptr : &channels_.at(found->second);
}

std::map<std::size_t, const mcap::Channel*> StreamTable::pose_channels() const {
  std::map<std::size_t, const mcap::Channel*> found;
  for (const auto& [id, channel] : channel_of_)
    if (id.stream == Stream::kPose && !is_foreign(id.person)) found.emplace(id.person, &channels_.at(channel));
  return found;
}

MessageStream::MessageStream(const mcap::ByteSource& source, const std::vector<MessagePlace>& places,
                             StreamTable& table, std::size_t threads, Report report)
    : source_(source), places_(places), table_(table), report_(std::move(report)), chunks_(source, threads) {}

void MessageStream::rewind() {
  chunks_.clear();
  next_place_ = 0;
  next_to_add_ = 0;
  chunk_ = mcap::Cursor({});
  run_ = {};
}

bool MessageStream::next(TraceMessage& message) {
  for (;;) {
    if (next_in_chunk(message) || next_in_run(message)) return true;
    if (next_place_ == places_.size()) return false;
    const MessagePlace& place = places_[next_place_++];
    if (place.in_chunk) {
      open_chunk(place);
    } else {
      run_ = place;
    }
  }
}

void MessageStream::add_chunks() {
  for (; chunks_.has_room() && next_to_add_ < places_.size(); ++next_to_add_)
    if (const MessagePlace& place = places_[next_to_add_]; place.in_chunk) chunks_.add(place.begin, place.end);
}

void MessageStream::open_chunk(const MessagePlace& place) {
  add_chunks();
  try {
    chunk_ = mcap::Cursor(chunks_.take());
    chunk_offset_ = place.begin;
    misfit_told_ = false;
  } catch (const Malformed& malformed) {
    report_({place.begin, place.end - place.begin, fmt::format("a Chunk: {}", malformed.what())});
  }
}

bool MessageStream::next_in_run(TraceMessage& message) {
  while (run_.begin < run_.end) {
    const std::uint64_t offset = std::exchange(run_.begin, run_.end);
    try {
      const mcap::Bytes content = mcap::read_record_at(source_, offset, Opcode::kMessage, run_.end, content_);
      run_.begin = offset + mcap::kRecordHeadBytes + content.size();
      if (take(offset, content, message)) return true;
    } catch (const Malformed& malformed) {
      report_({offset, run_.begin - offset, fmt::format("a Message: {}", malformed.what())});
    }
  }
  return false;
}

bool MessageStream::next_in_chunk(TraceMessage& message) {
  while (chunk_.remaining() > 0) {
    try {
      const mcap::InnerRecord record = mcap::next_record(chunk_);
      if (!mcap::belongs_in_chunks(record.opcode)) continue;
      if (!mcap::fits_its_fields(record)) {
        // Reports once for each chunk, which may hold millions of misfits.
        if (!std::exchange(misfit_told_, true))
          report_({chunk_offset_, 0, "records in a Chunk: they are shorter than their fields"});
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
  message.person = table_.person_of(message.message.channel_id);
  message.offset = offset;
  return message.stream != Stream::kForeign;
}

}  // namespace vestige
