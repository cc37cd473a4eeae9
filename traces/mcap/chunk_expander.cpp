#include "traces/mcap/chunk_expander.hpp"

#include <algorithm>
#include <limits>

#include "traces/mcap/crc32.hpp"
#include "traces/mcap/decode.hpp"

namespace vestige::mcap {

namespace {

constexpr std::size_t kMostAhead = 8;
constexpr std::uint64_t kMostBytesAhead = std::uint64_t{8} << 20;

}  // namespace

Bytes expand_chunk(const Chunk& chunk, RawBuffer& out) {
  Bytes records = chunk.records;
  if (!chunk.compression.empty() || chunk.uncompressed_size != records.size()) {
    decompress(chunk.compression, chunk.records, chunk.uncompressed_size, out);
    records = out.bytes();
  }
  if (chunk.uncompressed_crc != 0 && crc32(records) != chunk.uncompressed_crc) throw Malformed("its CRC is wrong");
  return records;
}

ChunkQueue::ChunkQueue(const ByteSource& source, std::size_t threads)
    : source_(source), places_(std::min(threads, kMostAhead)) {}

void ChunkQueue::add(std::uint64_t begin, std::uint64_t end) {
  Place& place = places_[added_ % places_.size()];
  place.begin = begin;
  place.end = end;
  // `take` does what is deferred: with a single thread everything, otherwise what finds no thread.
  const std::launch policy = places_.size() == 1 ? std::launch::deferred : std::launch::async | std::launch::deferred;
  place.records = std::async(policy, [this, &place] { return load(place, kMostBytesAhead, place.buffers); });
  ++added_;
}

Bytes ChunkQueue::take() {
  Place& place = places_[taken_++ % places_.size()];
  if (const std::optional<Bytes> records = place.records.get()) return *records;
  return *load(place, std::numeric_limits<std::uint64_t>::max(), own_);
}

void ChunkQueue::clear() {
  for (Place& place : places_) place.records = {};
  taken_ = added_;
}

std::optional<Bytes> ChunkQueue::load(const Place& place, std::uint64_t most_bytes, Buffers& buffers) const {
  // The length in the file may be broken; `place` has the corrected length.
  const std::uint64_t begin = place.begin + kRecordHeadBytes;
  if (place.end - begin > most_bytes) return {};
  source_.read_at(begin, buffers.content.reset(static_cast<std::size_t>(place.end - begin)));
  const Chunk chunk = decode_chunk(buffers.content.bytes());
  if (chunk.uncompressed_size > most_bytes) return {};
  return expand_chunk(chunk, buffers.expanded);
}

}  // namespace vestige::mcap
