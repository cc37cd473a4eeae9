#include "traces/mcap/indexed_reader.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "traces/error.hpp"
#include "traces/mcap/chunk_expander.hpp"
#include "traces/mcap/decode.hpp"

namespace vestige::mcap {

namespace {

/// Chunks that overlap in time are read in turns; recorders rarely interleave more.
constexpr std::size_t kOpenChunks = 4;

}  // namespace

IndexedReader::IndexedReader(const ByteSource& source) : source_(source) {
  SummaryResult result = read_summary(source);
  if (!result.summary)
    throw Error(source.name(), fmt::format("cannot be read by its index: {}", result.problem), "recover it first");
  summary_ = std::move(*result.summary);
  damaged_.resize(summary_.chunk_indexes.size());
  for (std::uint32_t chunk = 0; chunk < summary_.chunk_indexes.size(); ++chunk) {
    const std::size_t before = entries_.size();
    try {
      index_chunk(chunk);
    } catch (const Malformed& malformed) {
      entries_.resize(before);
      note(chunk, malformed.what());
    }
  }
  std::stable_sort(entries_.begin(), entries_.end(), [](const Entry& a, const Entry& b) {
    if (a.log_time != b.log_time) return a.log_time < b.log_time;
    return a.chunk != b.chunk ? a.chunk < b.chunk : a.offset < b.offset;
  });
}

void IndexedReader::index_chunk(std::uint32_t chunk) {
  const ChunkIndex& index = summary_.chunk_indexes[chunk];
  if (index.message_index_offsets.empty()) {
    index_by_expanding(chunk);
    return;
  }
  RawBuffer buffer;
  for (const auto& [channel, offset] : index.message_index_offsets) {
    const Bytes content = read_record_at(source_, offset, Opcode::kMessageIndex, summary_.data_section_end, buffer);
    for (const MessageIndexEntry& entry : decode_message_index(content).entries)
      entries_.push_back({.log_time = entry.log_time, .offset = entry.offset, .chunk = chunk});
  }
}

void IndexedReader::index_by_expanding(std::uint32_t chunk) {
  const Bytes records = records_of(chunk);
  Cursor cursor(records);
  while (cursor.remaining() > 0) {
    const std::uint64_t offset = records.size() - cursor.remaining();
    const InnerRecord record = next_record(cursor);
    if (record.opcode != Opcode::kMessage) continue;
    entries_.push_back({.log_time = decode_message(record.content).log_time, .offset = offset, .chunk = chunk});
  }
}

Bytes IndexedReader::records_of(std::uint32_t chunk) {
  const auto found = std::find_if(open_chunks_.begin(), open_chunks_.end(),
                                  [&](const OpenChunk& open) { return open.chunk == chunk; });
  if (found != open_chunks_.end()) {
    open_chunks_.splice(open_chunks_.begin(), open_chunks_, found);
    return open_chunks_.front().records;
  }
  const ChunkIndex& index = summary_.chunk_indexes[chunk];
  RawBuffer content;
  RawBuffer expanded;
  const Bytes records = expand_chunk(decode_chunk(read_record_at(source_, index.chunk_start_offset, Opcode::kChunk,
                                                                 summary_.data_section_end, content)),
                                     expanded);
  if (open_chunks_.size() == kOpenChunks) open_chunks_.pop_back();
  open_chunks_.push_front({.chunk = chunk, .records = {records.begin(), records.end()}});
  return open_chunks_.front().records;
}

void IndexedReader::note(std::uint32_t chunk, std::string_view what) {
  if (damaged_[chunk]) return;
  damaged_[chunk] = true;
  const ChunkIndex& index = summary_.chunk_indexes[chunk];
  damages_.push_back({index.chunk_start_offset, index.chunk_length, fmt::format("a Chunk: {}", what)});
}

bool IndexedReader::next(Message& message) {
  while (next_entry_ < entries_.size()) {
    const Entry entry = entries_[next_entry_++];
    if (damaged_[entry.chunk]) continue;
    try {
      const Bytes records = records_of(entry.chunk);
      if (entry.offset > records.size()) throw Malformed("a message index points outside it");
      Cursor cursor(records.subspan(static_cast<std::size_t>(entry.offset)));
      const InnerRecord record = next_record(cursor);
      if (record.opcode != Opcode::kMessage) throw Malformed("a message index points to no message");
      message = decode_message(record.content);
      return true;
    } catch (const Malformed& malformed) {
      note(entry.chunk, malformed.what());
    }
  }
  return false;
}

}  // namespace vestige::mcap
