#include "traces/mcap/indexed_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <tuple>
#include <utility>

#include "traces/base/error.hpp"
#include "traces/mcap/chunk_expander.hpp"

namespace vestige::mcap {

namespace {

constexpr std::uint64_t kMostOpenBytes = std::uint64_t{1} << 30;

}  // namespace

bool IndexedReader::Entry::operator>(const Entry& other) const {
  return std::tie(log_time, chunk, offset) > std::tie(other.log_time, other.chunk, other.offset);
}

IndexedReader::IndexedReader(const ByteSource& source, const TimeRange& range, TakeDefinition take_definition)
    : source_(source), range_(range), take_definition_(std::move(take_definition)) {
  SummaryResult result = read_summary(source);
  if (!result.summary)
    throw Error(source.name(), fmt::format("cannot be read by its index: {}", result.problem),
                "leave out '--order time', or run `vestige recover` on the file first");
  summary_ = std::move(*result.summary);
  const std::vector<ChunkIndex>& chunks = summary_.chunk_indexes;
  for (std::uint32_t chunk = 0; chunk < chunks.size(); ++chunk)
    if (range.overlaps(chunks[chunk].message_start_time, chunks[chunk].message_end_time)) by_start_.push_back(chunk);
  std::stable_sort(by_start_.begin(), by_start_.end(), [&](std::uint32_t a, std::uint32_t b) {
    return chunks[a].message_start_time < chunks[b].message_start_time;
  });
}

void IndexedReader::note(std::uint32_t chunk, std::string_view what) {
  const ChunkIndex& index = summary_.chunk_indexes[chunk];
  damages_.add({index.chunk_start_offset, index.chunk_length, fmt::format("a Chunk: {}", what)});
}

/// Opens every chunk that may have a message before the earliest known one.
void IndexedReader::open_due_chunks() {
  for (; next_chunk_ < by_start_.size(); ++next_chunk_) {
    const std::uint32_t chunk = by_start_[next_chunk_];
    if (!entries_.empty() && summary_.chunk_indexes[chunk].message_start_time > entries_.top().log_time) return;
    open(chunk);
    if (open_bytes_ + entries_.size() * sizeof(Entry) > kMostOpenBytes)
      throw Error(source_.name(), "the times of its chunks overlap, so more than 1 GiB must be sorted at once",
                  "leave out '--order time'");
  }
}

void IndexedReader::open(std::uint32_t chunk) {
  const ChunkIndex& index = summary_.chunk_indexes[chunk];
  OpenChunk& opened = open_chunks_[chunk];
  try {
    const Bytes content = read_record_at(source_, index.chunk_start_offset, Opcode::kChunk,
                                         index.chunk_start_offset + index.chunk_length, content_);
    const Bytes records = expand_chunk(decode_chunk(content), opened.expanded);
    // Uncompressed records still lie in `content_`, which the next chunk overwrites.
    if (records.data() != opened.expanded.bytes().data())
      std::copy(records.begin(), records.end(), opened.expanded.reset(records.size()).begin());
    opened.records = opened.expanded.bytes();
    open_bytes_ += opened.records.size();
    take_records(chunk, opened);
  } catch (const Malformed& malformed) {
    note(chunk, malformed.what());
  }
  if (opened.has_misfits) note(chunk, "some of its records are shorter than their fields");
  if (opened.contradicts_index) note(chunk, "it has messages outside the time range in its index");
  if (opened.messages_left > 0) return;
  open_bytes_ -= opened.records.size();
  open_chunks_.erase(chunk);
}

void IndexedReader::take_records(std::uint32_t chunk, OpenChunk& opened) {
  Cursor cursor(opened.records);
  while (cursor.remaining() > 0) {
    const std::uint64_t offset = opened.records.size() - cursor.remaining();
    const InnerRecord record = next_record(cursor);
    if (!belongs_in_chunks(record.opcode)) continue;
    if (fits_its_fields(record)) {
      take(record, offset, chunk, opened);
    } else {
      opened.has_misfits = true;
    }
  }
}

void IndexedReader::take(const InnerRecord& record, std::uint64_t offset, std::uint32_t chunk, OpenChunk& opened) {
  if (record.opcode != Opcode::kMessage) {
    if (take_definition_) take_definition_(record);
    return;
  }
  const ChunkIndex& index = summary_.chunk_indexes[chunk];
  const std::uint64_t log_time = decode_message(record.content).log_time;
  if (log_time < index.message_start_time || log_time > index.message_end_time) opened.contradicts_index = true;
  if (!range_.contains(log_time)) return;
  entries_.push({.log_time = log_time, .offset = offset, .chunk = chunk});
  ++opened.messages_left;
}

/// Closes the chunk of the message delivered last, if that was its last message.
void IndexedReader::close_finished_chunk() {
  const auto found = open_chunks_.find(current_);
  if (found == open_chunks_.end() || found->second.messages_left > 0) return;
  open_bytes_ -= found->second.records.size();
  open_chunks_.erase(found);
}

bool IndexedReader::next(Message& message) {
  close_finished_chunk();
  open_due_chunks();
  if (entries_.empty()) return false;
  const Entry entry = entries_.top();
  entries_.pop();
  current_ = entry.chunk;
  OpenChunk& opened = open_chunks_.at(current_);
  --opened.messages_left;
  Cursor cursor(opened.records.subspan(static_cast<std::size_t>(entry.offset)));
  message = decode_message(next_record(cursor).content);
  return true;
}

}  // namespace vestige::mcap
