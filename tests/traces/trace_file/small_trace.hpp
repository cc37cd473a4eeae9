#pragma once

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cstring>
#include <vector>

#include "tests/support/long.hpp"
#include "tests/support/test_data.hpp"
#include "tests/traces/trace_file/trace_fixture.hpp"
#include "traces/files/input_file.hpp"
#include "traces/mcap/byte_source.hpp"
#include "traces/mcap/decode.hpp"
#include "traces/mcap/record_walker.hpp"

namespace vestige::test {

inline constexpr std::uint64_t kFrames = 16;
inline constexpr std::uint64_t kFramesInAChunk = 4;

/// Long tests cut and flip every byte of a trace, other tests every seventh. Under sanitizers, which take ten times as
/// long, it is every thirteenth.
#ifdef VESTIGE_SANITIZED
inline const std::size_t kByteStep = 13;
inline constexpr bool kMeasuresMemory = false;  ///< a sanitizer keeps what is freed
#else
inline const std::size_t kByteStep = test::is_long() ? 1 : 7;
inline constexpr bool kMeasuresMemory = true;
#endif

/// A file that is never on disk: thousands of small ones would wait for it.
class MemoryFile {
 public:
  MemoryFile() : descriptor_(::memfd_create("damaged.mcap", MFD_CLOEXEC)) {}
  ~MemoryFile() { ::close(descriptor_); }
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;
  std::filesystem::path path() const { return fmt::format("/proc/self/fd/{}", descriptor_); }
  void assign(std::span<const std::byte> bytes) const {
    ASSERT_EQ(::ftruncate(descriptor_, 0), 0);
    ASSERT_EQ(::pwrite(descriptor_, bytes.data(), bytes.size(), 0), static_cast<ssize_t>(bytes.size()));
  }

 private:
  int descriptor_;
};

/// A small trace in memory, and where its parts are.
struct SmallTrace {
  std::vector<std::byte> bytes;
  std::vector<mcap::RecordPlace> chunks;
  std::uint64_t head_end = 0;  ///< of schemas and channels, before the first chunk
  std::uint64_t data_end = 0;
};

inline SmallTrace small_trace(const TemporaryFolder& folder, Compression compression) {
  SmallTrace trace;
  TraceWriterOptions options = steady_options(1200);
  options.compression = compression;
  write_trace(folder / "whole.mcap", kFrames, options);
  trace.bytes = read_file(folder / "whole.mcap");
  const mcap::MemorySource source(trace.bytes);
  mcap::RecordWalker walker(source);
  mcap::RecordPlace place;
  while (walker.next(place)) {
    if (place.opcode == mcap::Opcode::kChunk) trace.chunks.push_back(place);
    if (place.opcode == mcap::Opcode::kDataEnd) trace.data_end = place.offset;
  }
  trace.head_end = trace.chunks.front().offset;
  return trace;
}

/// Where the contents of the messages of an uncompressed trace begin, in file order.
inline std::vector<std::uint64_t> message_places(std::span<const std::byte> bytes) {
  std::vector<std::uint64_t> places;
  const mcap::MemorySource source(bytes);
  mcap::RecordWalker walker(source);
  mcap::RecordPlace place;
  while (walker.next(place)) {
    if (place.opcode != mcap::Opcode::kChunk) continue;
    const mcap::Bytes content = bytes.subspan(place.content_offset(), place.content_bytes);
    const mcap::Chunk chunk = mcap::decode_chunk(content);
    mcap::Cursor cursor(chunk.records);
    while (cursor.remaining() > 0) {
      const mcap::InnerRecord record = mcap::next_record(cursor);
      if (record.opcode == mcap::Opcode::kMessage)
        places.push_back(static_cast<std::uint64_t>(record.content.data() - bytes.data()));
    }
  }
  return places;
}

/// Shortens the first message, which is frame 0's pose, to 3 bytes, and fills its place with a record of an unknown
/// kind. Of an uncompressed trace; no CRC tells.
inline void shorten_first_message(SmallTrace& trace) {
  constexpr std::uint64_t kFieldsBeforeCrc = 3 * 8;
  constexpr std::uint64_t kFieldsBeforeRecords = kFieldsBeforeCrc + 4 + 4 + 8;
  constexpr std::uint64_t kShortBytes = 3;
  const auto number_at = [&](std::uint64_t offset, auto value) {
    std::memcpy(trace.bytes.data() + offset, &value, sizeof value);
  };
  const std::uint64_t content = trace.chunks.front().content_offset();
  const std::uint64_t message = content + kFieldsBeforeRecords;
  const std::uint64_t filler = message + mcap::kRecordHeadBytes + kShortBytes;
  std::uint64_t message_bytes = 0;
  std::memcpy(&message_bytes, trace.bytes.data() + message + 1, sizeof message_bytes);
  number_at(message + 1, kShortBytes);
  number_at(filler, std::uint8_t{0x80});
  number_at(filler + 1, message_bytes - kShortBytes - mcap::kRecordHeadBytes);
  number_at(content + kFieldsBeforeCrc, std::uint32_t{0});
  number_at(trace.data_end + mcap::kRecordHeadBytes, std::uint32_t{0});
}

}  // namespace vestige::test
