#include "traces/mcap/stream_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include "traces/mcap/chunk_expander.hpp"
#include "traces/mcap/crc32.hpp"

namespace vestige::mcap {

std::uint32_t crc32_of(const ByteSource& source, std::uint64_t begin, std::uint64_t end) {
  constexpr std::uint64_t kBlockBytes = 1 << 16;
  std::vector<std::byte> block(kBlockBytes);
  std::uint32_t crc = 0;
  while (begin < end) {
    const auto count = static_cast<std::size_t>(std::min(end - begin, kBlockBytes));
    source.read_at(begin, std::span(block).first(count));
    crc = crc32(std::span(block).first(count), crc);
    begin += count;
  }
  return crc;
}

StreamReader::StreamReader(const ByteSource& source, ChunkHandling handling)
    : source_(source), handling_(handling), walker_(source), data_crc_(crc32(std::as_bytes(std::span(kMagic)))) {}

DamageList StreamReader::damages() const {
  DamageList sorted = damages_;
  sorted.sort_by_offset();
  return sorted;
}

bool StreamReader::next(StreamRecord& record) {
  RecordPlace place;
  for (;;) {
    if (next_in_chunk(record)) return true;
    const bool found = walker_.next(place);
    for (const Damage& damage : walker_.damages()) damages_.add(damage);
    if (!found) return false;
    const Bytes content = walker_.content(place, content_);
    check(place, content);
    if (place.opcode == Opcode::kChunk) {
      if (!open_chunk(place, content) || handling_ == ChunkHandling::kExpand) continue;
    }
    record = {.opcode = place.opcode, .content = content, .offset = place.offset, .in_chunk = false};
    return true;
  }
}

bool StreamReader::next_in_chunk(StreamRecord& record) {
  while (chunk_.remaining() > 0) {
    try {
      const InnerRecord inner = next_record(chunk_);
      if (!belongs_in_chunks(inner.opcode)) continue;
      if (!fits_its_fields(inner)) {
        misfit_bytes_ += kRecordHeadBytes + inner.content.size();
        continue;
      }
      record = {.opcode = inner.opcode, .content = inner.content, .offset = chunk_place_.offset, .in_chunk = true};
      return true;
    } catch (const Malformed& malformed) {
      damages_.add({chunk_place_.offset, chunk_.remaining(),
                    fmt::format("the rest of a Chunk's records: {}", malformed.what())});
      chunk_ = Cursor({});
    }
  }
  note_misfits();
  return false;
}

/// Adds one note for all misfits of a chunk, since there may be millions.
void StreamReader::note_misfits() {
  if (const std::uint64_t bytes = std::exchange(misfit_bytes_, 0); bytes > 0)
    damages_.add({chunk_place_.offset, bytes, "records in a Chunk: they are shorter than their fields"});
}

bool StreamReader::open_chunk(const RecordPlace& place, Bytes content) {
  try {
    chunk_ = Cursor(expand_chunk(decode_chunk(content), expanded_));
    chunk_place_ = place;
    return true;
  } catch (const Malformed& malformed) {
    damages_.add({place.offset, place.end() - place.offset, fmt::format("a Chunk: {}", malformed.what())});
    return false;
  }
}

void StreamReader::check(const RecordPlace& place, Bytes content) {
  try {
    switch (place.opcode) {
      case Opcode::kDataEnd:
        check_data_section(place, content);
        break;
      case Opcode::kFooter:
        check_summary(place, content);
        break;
      case Opcode::kAttachment:
        if (!attachment_crc_holds(content, decode_attachment(content))) throw Malformed("its CRC is wrong");
        break;
      case Opcode::kChunk:
      case Opcode::kMessage:
        break;
      default:
        if (least_content_bytes(place.opcode) && !natural_content_bytes(place.opcode, content))
          throw Malformed("it is shorter than its fields");
    }
  } catch (const Malformed& malformed) {
    damages_.add(
        {place.offset, place.end() - place.offset, fmt::format("a {}: {}", name_of(place.opcode), malformed.what())});
  }
  if (place.offset == data_end_) {
    std::array<std::byte, kRecordHeadBytes> head = {};
    source_.read_at(place.offset, head);
    data_crc_ = crc32(content, crc32(head, data_crc_));
    data_end_ = place.end();
  }
}

void StreamReader::check_data_section(const RecordPlace& place, Bytes content) {
  data_end_seen_ = true;
  const std::uint32_t expected = decode_data_end(content).data_section_crc;
  // After broken framing the CRC misses bytes, and that damage was already noted.
  if (expected != 0 && place.offset == data_end_ && data_crc_ != expected)
    throw Malformed("the CRC over everything before it is wrong: some byte there has changed");
}

void StreamReader::check_summary(const RecordPlace& place, Bytes content) {
  if (!data_end_seen_) damages_.add({place.offset, 0, "there is no DataEnd before the Footer"});
  const Footer footer = decode_footer(content);
  if (footer.summary_start > place.offset || footer.summary_offset_start > place.offset)
    throw Malformed("it says that the summary begins after it");
  if (footer.summary_crc == 0) return;
  const std::uint64_t begin = footer.summary_start != 0 ? footer.summary_start : place.offset;
  if (crc32_of(source_, begin, place.end() - sizeof footer.summary_crc) != footer.summary_crc)
    throw Malformed("the summary's CRC is wrong");
}

}  // namespace vestige::mcap
