#pragma once

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/mman.h>
#include <unistd.h>

#include <vector>

#include "tests/support/test_data.hpp"
#include "tests/traces/trace_fixture.hpp"
#include "traces/input_file.hpp"
#include "traces/mcap/byte_source.hpp"
#include "traces/mcap/record_walker.hpp"

namespace vestige::test {

inline constexpr std::uint64_t kFrames = 16;
inline constexpr std::uint64_t kFramesInAChunk = 4;

/// Every byte of a trace is cut and flipped; under the address sanitizer, which takes ten times as long, every seventh.
#ifdef __SANITIZE_ADDRESS__
inline constexpr std::size_t kByteStep = 7;
#else
inline constexpr std::size_t kByteStep = 1;
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

}  // namespace vestige::test
