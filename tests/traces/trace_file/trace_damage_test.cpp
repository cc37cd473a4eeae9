// Foreign and damaged bytes: every cut and every flipped byte of a small trace. Never a crash, never much memory, and
// whatever chunk is whole is read.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <optional>

#include "tests/support/memory_growth.hpp"
#include "tests/support/test_data.hpp"
#include "tests/traces/trace_file/small_trace.hpp"
#include "tests/traces/trace_file/trace_fixture.hpp"
#include "traces/base/error.hpp"
#include "traces/files/input_file.hpp"
#include "traces/mcap/chunk_expander.hpp"
#include "traces/mcap/encode.hpp"
#include "traces/mcap/stream_reader.hpp"
#include "traces/mcap/summary.hpp"
#include "traces/repair/trace_summary.hpp"

namespace vestige {
namespace {

using test::kByteStep;
using test::kColliders;
using test::kFrames;
using test::kFramesInAChunk;
using test::kNodes;
using test::MemoryFile;
using test::small_trace;
using test::SmallTrace;
using ::testing::HasSubstr;

void write_bytes(const std::filesystem::path& path, std::span<const std::byte> bytes) {
  std::ofstream(path, std::ios::binary)
      .write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
}

std::uint64_t frames_in(std::size_t chunks) {
  return std::min(kFrames, chunks * kFramesInAChunk);
}

/// Reads all there is; every frame must be as it was written. Nothing when the file is refused.
std::optional<std::uint64_t> intact_frames(const std::filesystem::path& path, bool& complete) {
  try {
    TraceReader reader(path);
    const auto frames = test::read_frames(reader);
    for (const TraceFrame& frame : frames)
      EXPECT_TRUE(test::same_bits(frame, test::frame(frame.index, kNodes, kColliders)));
    EXPECT_EQ(reader.frame_count(), frames.size());
    complete = reader.complete();
    EXPECT_EQ(complete, reader.warnings().empty());
    return frames.size();
  } catch (const Error&) {
    return {};
  }
}

/// What a reader delivers and says, until it refuses the file.
struct Read {
  std::vector<TraceFrame> frames;
  std::vector<std::string> told;  ///< warnings, and then why it is refused
};

Read read_with(std::size_t threads, const std::filesystem::path& path) {
  Read read;
  try {
    TraceReader reader(path, People::kOne, threads);
    try {
      TraceFrame first;
      reader.next(first);
      reader.rewind();
      read.frames = test::read_frames(reader);
      EXPECT_EQ(reader.frame_count(), read.frames.size());
    } catch (const Error& error) {
      read.told.emplace_back(error.what());
    }
    read.told.insert(read.told.begin(), reader.warnings().begin(), reader.warnings().end());
  } catch (const Error& error) {
    read.told.emplace_back(error.what());
  }
  return read;
}

void expect_same_with_threads(const std::filesystem::path& path) {
  const Read one = read_with(1, path);
  const Read three = read_with(3, path);
  EXPECT_EQ(three.told, one.told);
  EXPECT_TRUE(
      std::ranges::equal(three.frames, one.frames, [](const auto& a, const auto& b) { return test::same_bits(a, b); }));
}

TEST(TraceDamage, ACutAnywhereKeepsEveryWholeChunk) {
  const test::TemporaryFolder folder;
  const SmallTrace trace = small_trace(folder, Compression::kZstd);
  ASSERT_EQ(trace.chunks.size(), 4U);
  const MemoryFile file;
  for (std::size_t length = 0; length < trace.bytes.size(); length += kByteStep) {
    file.assign(std::span(trace.bytes).first(length));
    bool complete = true;
    const auto frames = intact_frames(file.path(), complete);
    if (length < trace.head_end) continue;
    const auto whole = static_cast<std::size_t>(std::count_if(
        trace.chunks.begin(), trace.chunks.end(), [&](const auto& chunk) { return chunk.end() <= length; }));
    ASSERT_TRUE(frames) << length;
    EXPECT_EQ(*frames, frames_in(whole)) << length;
    EXPECT_FALSE(complete) << length;
    const McapSummary summary = summarise_mcap(file.path());
    EXPECT_EQ(summary.messages, 2 * frames_in(whole)) << length;
    EXPECT_FALSE(summary.complete) << length;
  }
}

TEST(TraceDamage, ThreadsChangeNothingThatIsReadOrSaid) {
  const test::TemporaryFolder folder;
  const SmallTrace trace = small_trace(folder, Compression::kZstd);
  const MemoryFile file;
  for (std::size_t at = trace.head_end; at < trace.data_end; at += kByteStep) {
    file.assign(std::span(trace.bytes).first(at));
    expect_same_with_threads(file.path());
    std::vector<std::byte> damaged = trace.bytes;
    damaged[at] ^= std::byte{0x41};
    file.assign(damaged);
    expect_same_with_threads(file.path());
  }
}

TEST(TraceDamage, ChunksTooLargeToExpandAheadAreReadInTheirTurn) {
  const test::TemporaryFolder folder;
  TraceWriterOptions options = test::steady_options(std::size_t{9} << 20);
  for (const Compression compression : {Compression::kNone, Compression::kZstd}) {
    options.compression = compression;
    options.overwrite = Overwrite::kAllow;
    test::write_trace(folder / "large.mcap", 60'000, options);
    ASSERT_EQ(summarise_mcap(folder / "large.mcap").chunks, 3U);
    TraceReader reader(folder / "large.mcap", People::kOne, 3);
    EXPECT_EQ(reader.frame_count(), 60'000U);
    TraceFrame frame;
    for (std::uint64_t i = 0; i < reader.frame_count(); ++i) {
      ASSERT_TRUE(reader.next(frame));
      ASSERT_TRUE(test::same_bits(frame, test::frame(i, kNodes, kColliders))) << i;
    }
  }
}

class TraceDamageCompressed : public ::testing::TestWithParam<Compression> {};

TEST_P(TraceDamageCompressed, AFlippedByteCostsAtMostTheChunkThatItIsIn) {
  const test::TemporaryFolder folder;
  const SmallTrace trace = small_trace(folder, GetParam());
  const MemoryFile file;
  // What stands around chunks is the same for all.
  const std::vector<int> flips = GetParam() == Compression::kNone ? std::vector{0x01, 0xFF} : std::vector{0x41};
  for (std::size_t at = 0; at < trace.bytes.size(); at += kByteStep) {
    for (const int flip : flips) {
      std::vector<std::byte> damaged = trace.bytes;
      damaged[at] ^= static_cast<std::byte>(flip);
      file.assign(damaged);
      bool complete = true;
      const auto frames = intact_frames(file.path(), complete);
      try {
        const McapSummary summary = summarise_mcap(file.path());
        EXPECT_FALSE(summary.complete) << at;
      } catch (const Error&) {
        EXPECT_LT(at, mcap::kMagicBytes);
      }
      // A damaged avatar makes the trace useless, and its definitions may be the only ones that say what it is.
      if (at < trace.head_end) continue;
      ASSERT_TRUE(frames) << at;
      const bool in_chunk = std::any_of(trace.chunks.begin(), trace.chunks.end(),
                                        [&](const auto& chunk) { return at >= chunk.offset && at < chunk.end(); });
      EXPECT_GE(*frames, kFrames - (in_chunk ? kFramesInAChunk : 0)) << at;
    }
  }
}

TEST_P(TraceDamageCompressed, AFlippedByteWithoutFooterCostsAtMostTheChunkThatItIsInOrBefore) {
  const test::TemporaryFolder folder;
  SmallTrace trace = small_trace(folder, GetParam());
  trace.bytes.resize(trace.data_end);
  const MemoryFile file;
  for (std::size_t at = trace.head_end; at < trace.bytes.size(); at += kByteStep) {
    std::vector<std::byte> damaged = trace.bytes;
    damaged[at] ^= std::byte{0x41};
    file.assign(damaged);
    bool complete = true;
    const auto frames = intact_frames(file.path(), complete);
    ASSERT_TRUE(frames) << at;
    EXPECT_GE(*frames, kFrames - kFramesInAChunk) << at;
    EXPECT_FALSE(complete);
  }
}

INSTANTIATE_TEST_SUITE_P(Compressions, TraceDamageCompressed,
                         ::testing::Values(Compression::kNone, Compression::kLz4, Compression::kZstd));

TEST(TraceDamage, ADamagedChunkIsReportedWithItsOffset) {
  const test::TemporaryFolder folder;
  const SmallTrace trace = small_trace(folder, Compression::kNone);
  std::vector<std::byte> damaged = trace.bytes;
  damaged[trace.chunks[1].end() - 20] ^= std::byte{1};
  write_bytes(folder / "a.mcap", damaged);
  TraceReader reader(folder / "a.mcap");
  EXPECT_TRUE(reader.complete()) << "damage is found by reading";
  const auto frames = test::read_frames(reader);
  ASSERT_EQ(frames.size(), kFrames - kFramesInAChunk);
  EXPECT_EQ(frames[4].index, 8U) << "the gap shows";
  EXPECT_FALSE(reader.complete());
  ASSERT_EQ(reader.warnings().size(), 1U);
  EXPECT_THAT(reader.warnings()[0],
              HasSubstr(fmt::format("at byte {}: a Chunk: its CRC is wrong", trace.chunks[1].offset)));
  EXPECT_EQ(reader.frame_count(), kFrames - kFramesInAChunk);
  EXPECT_EQ(reader.warnings().size(), 1U) << "nothing is said twice";
}

TEST(TraceDamage, NothingIsReadFromTheMiddleOfAChunkThatIsCut) {
  // In a chunk that is not compressed, coordinates may look like a record that leads to the chunk's own messages.
  const test::TemporaryFolder folder;
  TraceWriterOptions options = test::steady_options(100'000);
  options.compression = Compression::kNone;
  test::write_trace(folder / "whole.mcap", 1000, options);
  std::vector<std::byte> bytes = read_file(folder / "whole.mcap");
  std::vector<mcap::RecordPlace> chunks;
  {
    const mcap::MemorySource source(bytes);
    mcap::RecordWalker walker(source);
    for (mcap::RecordPlace place; walker.next(place);)
      if (place.opcode == mcap::Opcode::kChunk) chunks.push_back(place);
  }
  ASSERT_GE(chunks.size(), 2U);
  std::vector<std::uint64_t> messages = test::message_places(bytes);
  std::erase_if(messages, [&](std::uint64_t at) { return at < chunks[1].offset || at >= chunks[1].end(); });
  const std::uint64_t liar = messages[2] + 60;
  const std::uint64_t end = messages[messages.size() - 20] - mcap::kRecordHeadBytes;
  const std::uint64_t length = end - liar - mcap::kRecordHeadBytes;
  ASSERT_GT(length, std::uint64_t{1} << 16) << "long enough to be believed without a look at its fields";
  std::memcpy(bytes.data() + liar + 1, &length, sizeof length);
  bytes.resize(chunks[1].end() - 1);
  for (const mcap::Opcode opcode : {mcap::Opcode::kAttachmentIndex, mcap::Opcode::kMessageIndex}) {
    bytes[liar] = static_cast<std::byte>(opcode);
    write_bytes(folder / "cut.mcap", bytes);
    TraceReader reader(folder / "cut.mcap");
    const auto frames = test::read_frames(reader);
    ASSERT_FALSE(frames.empty());
    EXPECT_EQ(frames.size(), frames.back().index + 1) << "those of the first chunk";
    EXPECT_FALSE(reader.complete());
  }
}

TEST(TraceDamage, AMessageWhoseFieldsDoNotFitCostsItsFrameAlone) {
  const test::TemporaryFolder folder;
  SmallTrace trace = small_trace(folder, Compression::kNone);
  test::shorten_first_message(trace);
  write_bytes(folder / "a.mcap", trace.bytes);
  TraceReader reader(folder / "a.mcap");
  EXPECT_EQ(test::read_frames(reader).size(), kFrames - 1);
  EXPECT_FALSE(reader.complete());
  ASSERT_FALSE(reader.warnings().empty());
  EXPECT_THAT(reader.warnings()[0], HasSubstr("they are shorter than their fields"));
}

TEST(TraceDamage, ABrokenSummaryIsNoLoss) {
  const test::TemporaryFolder folder;
  const SmallTrace trace = small_trace(folder, Compression::kZstd);
  std::vector<std::byte> damaged = trace.bytes;
  damaged[trace.data_end + 40] ^= std::byte{1};
  write_bytes(folder / "a.mcap", damaged);
  TraceReader reader(folder / "a.mcap");
  EXPECT_EQ(test::read_frames(reader).size(), kFrames);
  EXPECT_FALSE(reader.complete());
  EXPECT_THAT(reader.warnings().at(0), HasSubstr("summary's CRC is wrong"));
}

TEST(TraceDamage, ADamagedAvatarIsRefused) {
  const test::TemporaryFolder folder;
  SmallTrace trace = small_trace(folder, Compression::kZstd);
  const auto glb = test::skeleton_glb(kNodes);
  const auto place = std::search(trace.bytes.begin(), trace.bytes.end(), glb.begin(), glb.end());
  ASSERT_NE(place, trace.bytes.end());
  *(place + 30) ^= std::byte{1};
  write_bytes(folder / "a.mcap", trace.bytes);
  try {
    TraceReader reader(folder / "a.mcap");
    FAIL() << "took a damaged avatar";
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), HasSubstr("no undamaged attachment avatar.glb"));
  }
}

TEST(TraceDamage, FramesThatComeTwiceAreRefused) {
  const test::TemporaryFolder folder;
  const SmallTrace trace = small_trace(folder, Compression::kZstd);
  // The first chunk again, at the end of a file without footer.
  std::vector<std::byte> bytes(trace.bytes.begin(), trace.bytes.begin() + static_cast<std::ptrdiff_t>(trace.data_end));
  const mcap::RecordPlace& chunk = trace.chunks.front();
  bytes.insert(bytes.end(), trace.bytes.begin() + static_cast<std::ptrdiff_t>(chunk.offset),
               trace.bytes.begin() + static_cast<std::ptrdiff_t>(chunk.end()));
  write_bytes(folder / "a.mcap", bytes);
  TraceReader reader(folder / "a.mcap");
  try {
    test::read_frames(reader);
    FAIL() << "went back in time";
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), HasSubstr(fmt::format("at byte {}: frame 0: comes after frame 15", trace.data_end)));
  }
}

TEST(TraceDamage, ClaimsOfHugeSizesCostNoMemory) {
  const test::TemporaryFolder folder;
  mcap::ByteBuffer bytes;
  mcap::append_magic(bytes);
  append_record(bytes, mcap::Header{});
  for (const std::uint64_t claim : {mcap::kMaxChunkBytes, mcap::kMaxChunkBytes + 1, ~std::uint64_t{0}}) {
    for (const char* compression : {"", "lz4", "zstd", "rot13"}) {
      append_record(bytes, mcap::Chunk{.uncompressed_size = claim, .compression = compression, .records = {}});
    }
  }
  const mcap::MemorySource source(bytes);
  mcap::StreamReader reader(source);
  mcap::StreamRecord record;
  const test::MemoryGrowth growth;
  while (reader.next(record)) continue;
  EXPECT_EQ(reader.damages().count(), 13U) << "twelve chunks, no footer";
  EXPECT_LT(growth.kibibytes(), 64 << 10);
}

TEST(TraceDamage, LargeChunksAreNotInMemoryTogether) {
  constexpr std::size_t kChunkBytes = std::size_t{32} << 20;
  constexpr int kChunks = 8;
  mcap::Chunk chunk = {.uncompressed_size = kChunkBytes, .compression = "zstd", .records = {}};
  std::vector<std::byte> zeros;
  mcap::compress(Compression::kZstd, std::vector<std::byte>(kChunkBytes), zeros);
  chunk.records = zeros;
  mcap::ByteBuffer bytes;
  append_record(bytes, chunk);
  const mcap::MemorySource source(bytes);
  const test::MemoryGrowth growth;
  mcap::ChunkQueue queue(source, kChunks);
  for (int i = 0; i < kChunks; ++i) queue.add(0, bytes.size());
  for (int i = 0; i < kChunks; ++i) EXPECT_EQ(queue.take().size(), kChunkBytes);
  if (test::kMeasuresMemory) {
    EXPECT_LT(growth.kibibytes(), 2 * kChunkBytes >> 10);
  }
}

TEST(TraceDamage, ABombIsRefusedAtTheSizeItClaims) {
  const std::vector<std::byte> zeros(std::size_t{1} << 20);
  for (const Compression compression : {Compression::kLz4, Compression::kZstd}) {
    std::vector<std::byte> small;
    mcap::compress(compression, zeros, small);
    mcap::RawBuffer out;
    EXPECT_NO_THROW(mcap::decompress(mcap::name_of(compression), small, zeros.size(), out));
    for (const std::uint64_t claim : {zeros.size() - 1, zeros.size() + 1, std::size_t{0}})
      EXPECT_THROW(mcap::decompress(mcap::name_of(compression), small, claim, out), mcap::Malformed);
    small.pop_back();
    EXPECT_THROW(mcap::decompress(mcap::name_of(compression), small, zeros.size(), out), mcap::Malformed);
  }
}

TEST(TraceDamage, EachBrokenPlaceIsSaidOnce) {
  const test::TemporaryFolder folder;
  SmallTrace trace = small_trace(folder, Compression::kZstd);
  // The kinds of two chunks, between which others are whole.
  for (const std::size_t chunk : {0U, 2U}) trace.bytes[trace.chunks[chunk].offset] = std::byte{0};
  const mcap::MemorySource source(trace.bytes);
  mcap::StreamReader reader(source);
  mcap::StreamRecord record;
  while (reader.next(record)) continue;
  std::vector<std::uint64_t> offsets;
  const mcap::DamageList damages = reader.damages();
  for (const mcap::Damage& damage : damages.kept()) offsets.push_back(damage.offset);
  EXPECT_THAT(offsets, ::testing::ElementsAre(trace.chunks[0].offset, trace.chunks[2].offset));
}

TEST(TraceDamage, AFileMadeOfDamageCostsNoMemory) {
  mcap::ByteBuffer bytes;
  mcap::append_magic(bytes);
  append_record(bytes, mcap::Header{});
  constexpr std::uint64_t kDamaged = 100'000;
  for (std::uint64_t i = 0; i < kDamaged; ++i)
    append_record(bytes, mcap::Chunk{.uncompressed_size = 1, .compression = "rot13", .records = {}});
  const MemoryFile file;
  file.assign(bytes);
  const mcap::MemorySource source(bytes);
  const test::MemoryGrowth growth;
  mcap::StreamReader reader(source);
  mcap::StreamRecord record;
  while (reader.next(record)) continue;
  EXPECT_EQ(reader.damages().count(), kDamaged + 1) << "and no footer";
  EXPECT_EQ(summarise_mcap(file.path()).warnings.size(), mcap::DamageList::kMostKept + 1);
  if (test::kMeasuresMemory) {
    EXPECT_LT(growth.kibibytes(), 4 << 10);
  }
}

TEST(TraceDamage, SearchingThroughLiesTakesLinearTime) {
  // Every byte looks like the beginning of a record that reaches far ahead.
  std::vector<std::byte> bytes(std::size_t{1} << 20);
  mcap::ByteBuffer magic;
  mcap::append_magic(magic);
  std::copy(magic.begin(), magic.end(), bytes.begin());
  for (std::size_t i = magic.size(); i + 9 <= bytes.size(); i += 9) {
    bytes[i] = std::byte{6};
    bytes[i + 2] = std::byte{0x40};
  }
  const mcap::MemorySource source(bytes);
  mcap::StreamReader reader(source);
  mcap::StreamRecord record;
  while (reader.next(record)) continue;
  EXPECT_FALSE(reader.damages().empty());
}

}  // namespace
}  // namespace vestige
