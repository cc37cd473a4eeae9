#include "traces/mcap/check/chunk_salvage.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <string_view>

#include "traces/mcap/chunk_expander.hpp"
#include "traces/mcap/crc32.hpp"

namespace vestige::mcap {

namespace {

bool begins_with(Bytes bytes, std::array<unsigned char, 4> magic) {
  return bytes.size() >= magic.size() && std::memcmp(bytes.data(), magic.data(), magic.size()) == 0;
}

/// Returns the compression called `name`. If the name is damaged, returns the compression whose magic bytes begin
/// `data`.
std::string_view likely_compression(std::string_view name, Bytes data) {
  for (const Compression known : {Compression::kNone, Compression::kLz4, Compression::kZstd})
    if (name == name_of(known)) return name_of(known);
  if (begins_with(data, {0x28, 0xB5, 0x2F, 0xFD})) return name_of(Compression::kZstd);  // RFC 8878, 3.1.1
  if (begins_with(data, {0x04, 0x22, 0x4D, 0x18})) return name_of(Compression::kLz4);   // LZ4 Frame Format
  return name;
}

/// The opcodes for which `belongs_in_chunks` is true.
constexpr std::array kInner = {Opcode::kSchema, Opcode::kChannel, Opcode::kMessage};

/// Returns the offset of the first byte equal to `opcode` from `position` on, or the size if there is no such byte.
std::size_t find(Bytes bytes, Opcode opcode, std::size_t position) {
  const void* found = std::memchr(bytes.data() + position, static_cast<int>(opcode), bytes.size() - position);
  if (found == nullptr) return bytes.size();
  return static_cast<std::size_t>(static_cast<const std::byte*>(found) - bytes.data());
}

}  // namespace

ChunkRemains salvage_chunk(Bytes content, RawBuffer& out) {
  Chunk chunk;
  try {
    Cursor cursor(content);
    cursor.number<std::uint64_t>();
    cursor.number<std::uint64_t>();
    chunk.uncompressed_size = cursor.number<std::uint64_t>();
    chunk.uncompressed_crc = cursor.number<std::uint32_t>();
    chunk.compression = cursor.string();
    const auto claimed = cursor.number<std::uint64_t>();
    chunk.records = cursor.bytes(std::min<std::uint64_t>(claimed, cursor.remaining()));
  } catch (const Malformed&) {
    return {};
  }
  try {
    return {.records = expand_chunk(chunk, out), .trust = Trust::kVerified};
  } catch (const Malformed&) {
    // The code below expands as much as it can.
  }
  const std::string_view compression = likely_compression(chunk.compression, chunk.records);
  const std::uint64_t claimed = std::min(chunk.uncompressed_size, kMaxChunkBytes - 1);
  Bytes records = decompress_beginning(compression, chunk.records, static_cast<std::size_t>(claimed + 1), out);
  // If the data expands to more than the claimed size, the claim is what is damaged.
  if (records.size() > claimed) records = decompress_beginning(compression, chunk.records, kMaxChunkBytes, out);
  const bool whole = chunk.uncompressed_crc != 0 && crc32(records) == chunk.uncompressed_crc;
  return {.records = records, .trust = whole ? Trust::kVerified : Trust::kUnverified};
}

bool is_whole_chunk(Bytes content, RawBuffer& out) {
  const auto natural = natural_content_bytes(Opcode::kChunk, content);
  if (!natural || *natural != content.size()) return false;
  try {
    const Chunk chunk = decode_chunk(content);
    if (chunk.uncompressed_crc == 0) return false;
    expand_chunk(chunk, out);
    return true;
  } catch (const Malformed&) {
    return false;
  }
}

/// Returns the first place from `position` on where the opcode byte is one that may begin a record. Remembers later
/// finds, so that no byte is searched twice for the same opcode.
std::size_t SalvagedRecords::next_opcode(std::size_t position) {
  if (position == records_.size() || belongs_in_chunks(opcode_at(position))) return position;
  std::size_t nearest = records_.size();
  for (std::size_t i = 0; i < kInner.size(); ++i) {
    if (next_[i] <= position) next_[i] = find(records_, kInner[i], position);
    nearest = std::min(nearest, next_[i]);
  }
  return nearest;
}

std::uint64_t SalvagedRecords::length_at(std::size_t offset) const {
  std::uint64_t length = 0;
  std::memcpy(&length, records_.data() + offset + 1, sizeof length);
  return length;
}

/// Whether a record that may stand in a chunk could begin here, even if its end is missing.
bool SalvagedRecords::is_head(std::size_t offset) const {
  const Opcode opcode = opcode_at(offset);
  if (!belongs_in_chunks(opcode)) return false;
  if (records_.size() - offset < kRecordHeadBytes) return true;
  const std::uint64_t length = length_at(offset);
  return length <= kMaxChunkBytes && length >= least_content_bytes(opcode).value_or(0);
}

/// Judges mainly by the length field: random bytes rarely give a length that fits.
bool SalvagedRecords::is_believable(std::size_t offset) const {
  const std::size_t rest = records_.size() - offset;
  if (rest < kRecordHeadBytes) return false;
  const std::uint64_t length = length_at(offset);
  if (length > rest - kRecordHeadBytes || !is_head(offset)) return false;
  const std::size_t end = offset + kRecordHeadBytes + static_cast<std::size_t>(length);
  return end == records_.size() || is_head(end);
}

bool SalvagedRecords::next(InnerRecord& record) {
  position_ = next_opcode(position_);
  while (position_ < records_.size() && !is_believable(position_)) position_ = next_opcode(position_ + 1);
  if (position_ == records_.size()) return false;
  record.opcode = opcode_at(position_);
  record.content = records_.subspan(position_ + kRecordHeadBytes, static_cast<std::size_t>(length_at(position_)));
  position_ += kRecordHeadBytes + record.content.size();
  return true;
}

}  // namespace vestige::mcap
