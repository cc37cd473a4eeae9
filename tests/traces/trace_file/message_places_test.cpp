// Where messages stand in files that others wrote: in chunks, outside, both, in no order; and what of them is missing.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

#include "tests/support/message_of.hpp"
#include "tests/traces/trace_file/forged_trace.hpp"
#include "tests/traces/trace_file/small_trace.hpp"
#include "traces/mcap/indexed_reader.hpp"
#include "traces/mcap/summary.hpp"
#include "traces/repair/trace_summary.hpp"
#include "traces/trace_file/trace_index.hpp"
#include "traces/trace_file/trace_reader.hpp"

namespace vestige {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using trace_format::Stream;

std::vector<std::uint64_t> numbers_of(std::span<const std::byte> bytes, bool complete = true) {
  test::MemoryFile file;
  file.assign(bytes);
  TraceReader reader(file.path());
  std::vector<std::uint64_t> numbers;
  for (TraceFrame frame; reader.next(frame);) numbers.push_back(frame.index);
  EXPECT_EQ(reader.complete(), complete) << ::testing::PrintToString(reader.warnings());
  return numbers;
}

/// Ends a file with a summary of one's own.
void append_summary(mcap::ByteBuffer& bytes, const mcap::Summary& summary) {
  for (const mcap::Schema& schema : summary.schemas) append_record(bytes, schema);
  for (const mcap::Channel& channel : summary.channels) append_record(bytes, channel);
  append_record(bytes, *summary.statistics);
  for (const mcap::ChunkIndex& index : summary.chunk_indexes) append_record(bytes, index);
  for (const mcap::AttachmentIndex& index : summary.attachment_indexes) append_record(bytes, index);
  for (const mcap::MetadataIndex& index : summary.metadata_indexes) append_record(bytes, index);
  append_record(bytes, summary.footer);
  mcap::append_magic(bytes);
}

TEST(MessagePlaces, AFileWithoutChunksIsRead) {
  test::ForgedTrace trace({.chunking = mcap::Chunking::kNone});
  for (std::uint32_t i = 0; i < 3; ++i) trace.frame(i, i);
  EXPECT_THAT(numbers_of(trace.finished()), ElementsAre(0, 1, 2));
}

TEST(MessagePlaces, AFileWithoutChunksIsReadAgainFromTheBeginning) {
  test::ForgedTrace trace({.chunking = mcap::Chunking::kNone});
  for (std::uint32_t i = 0; i < 3; ++i) trace.frame(i, i);
  test::MemoryFile file;
  file.assign(trace.finished());
  TraceReader reader(file.path());
  TraceFrame frame;
  ASSERT_TRUE(reader.next(frame) && reader.next(frame));
  reader.rewind();
  ASSERT_TRUE(reader.next(frame));
  EXPECT_EQ(frame.index, 0U);
  EXPECT_TRUE(reader.complete()) << ::testing::PrintToString(reader.warnings());
}

TEST(MessagePlaces, MillionsOutsideChunksTakeNoMemoryEach) {
  test::ForgedTrace trace({.chunking = mcap::Chunking::kNone});
  for (std::uint32_t i = 0; i < 1000; ++i) trace.frame(i, i);
  const mcap::MemorySource source(trace.finished());
  EXPECT_EQ(index_trace(source).places.size(), 1U);
}

TEST(MessagePlaces, MessagesBehindTheLastChunkAreReadThoughNoIndexHasThem) {
  test::ForgedTrace trace;
  trace.frame(0, 0);
  trace.end_chunk();
  trace.frame(1, 1);
  const std::vector<std::byte>& sound = trace.finished();
  const mcap::MemorySource source(sound);
  mcap::Summary summary = *mcap::read_summary(source).summary;
  ASSERT_EQ(summary.chunk_indexes.size(), 2U);
  EXPECT_TRUE(mcap::leads_to_everything(source, summary));

  // The same, but the second chunk's records stand there without it.
  const mcap::ChunkIndex second = summary.chunk_indexes[1];
  summary.chunk_indexes.pop_back();
  mcap::RawBuffer content;
  const mcap::Chunk chunk = mcap::decode_chunk(
      mcap::read_record_at(source, second.chunk_start_offset, mcap::Opcode::kChunk, sound.size(), content));
  mcap::ByteBuffer bytes(sound.begin(), sound.begin() + static_cast<std::ptrdiff_t>(second.chunk_start_offset));
  bytes.insert(bytes.end(), chunk.records.begin(), chunk.records.end());
  append_record(bytes, mcap::DataEnd{});
  --summary.statistics->chunk_count;
  summary.footer = {.summary_start = bytes.size()};
  append_summary(bytes, summary);

  const mcap::MemorySource mixed(bytes);
  ASSERT_TRUE(mcap::read_summary(mixed).summary) << mcap::read_summary(mixed).problem;
  EXPECT_FALSE(mcap::leads_to_everything(mixed, *mcap::read_summary(mixed).summary));
  EXPECT_THAT(numbers_of(bytes), ElementsAre(0, 1));
}

TEST(MessagePlaces, AFrameWithoutItsCollidersIsReadWithoutAnyAndSaid) {
  test::ForgedTrace trace;
  trace.frame(0, 0);
  trace.pose(1, 1);
  trace.frame(2, 2);
  test::MemoryFile file;
  file.assign(trace.finished());
  TraceReader reader(file.path());
  EXPECT_EQ(reader.frame_count(), 3U);
  EXPECT_FALSE(reader.complete());
  ASSERT_EQ(reader.warnings().size(), 1U);
  EXPECT_THAT(reader.warnings().front(), HasSubstr("frame 1 has no message of /colliders"));
}

TEST(MessagePlaces, AChunkIsReadThoughItsLengthIsBroken) {
  test::ForgedTrace trace;
  trace.frame(0, 0);
  trace.end_chunk();
  trace.frame(1, 1);
  std::vector<std::byte> bytes = trace.finished();
  const mcap::MemorySource source(bytes);
  const mcap::ChunkIndex chunk = mcap::read_summary(source).summary->chunk_indexes[0];
  bytes[chunk.chunk_start_offset + 4] ^= std::byte{1};
  EXPECT_THAT(numbers_of(bytes, false), ElementsAre(0, 1));
}

TEST(MessagePlaces, ChunksThatTheSummaryHidesAreRead) {
  test::ForgedTrace trace;
  trace.frame(0, 0);
  trace.end_chunk();
  trace.frame(1, 1);
  const std::vector<std::byte>& sound = trace.finished();
  const mcap::MemorySource source(sound);
  const mcap::Summary whole = *mcap::read_summary(source).summary;
  const auto with = [&](const std::function<void(mcap::Summary&)>& change) {
    mcap::Summary summary = whole;
    change(summary);
    mcap::ByteBuffer bytes(sound.begin(), sound.begin() + static_cast<std::ptrdiff_t>(whole.data_section_end));
    append_summary(bytes, summary);
    return bytes;
  };
  const auto without_crc = [](mcap::Summary& summary) { summary.footer.summary_crc = 0; };
  EXPECT_THAT(numbers_of(with(without_crc)), ElementsAre(0, 1));
  // Its last chunk stands, as the footer has it, in the summary.
  EXPECT_THAT(numbers_of(with([&](mcap::Summary& summary) {
                           without_crc(summary);
                           summary.footer.summary_start = summary.chunk_indexes.back().chunk_start_offset;
                           summary.chunk_indexes.pop_back();
                           --summary.statistics->chunk_count;
                         }),
                         false),
              ElementsAre(0, 1));
  // Its last chunk stands, as the index has it, among the message indexes of the first.
  EXPECT_THAT(numbers_of(with([&](mcap::Summary& summary) {
                without_crc(summary);
                summary.chunk_indexes.front().message_index_length += summary.chunk_indexes.back().chunk_length;
                summary.chunk_indexes.pop_back();
                --summary.statistics->chunk_count;
              })),
              ElementsAre(0, 1));
}

TEST(MessagePlaces, CollidersInAnyOrderTakeNoTimeBySorting) {
  test::ForgedTrace trace;
  constexpr std::uint32_t kMany = 1'000'000;
  std::vector<ColliderSample> colliders(kMany);
  for (std::uint32_t i = 0; i < kMany; ++i) colliders[i].id = kMany - i;
  trace.pose(0, 0);
  trace.colliders(0, 0, colliders);
  test::MemoryFile file;
  file.assign(trace.finished());
  TraceReader reader(file.path());
  EXPECT_EQ(reader.collider_ids().size(), kMany);
}

TEST(MessagePlaces, MoreThanAMillionCollidersAreRefused) {
  test::ForgedTrace trace;
  constexpr std::uint32_t kTooMany = 1'000'001;
  std::vector<ColliderSample> colliders(kTooMany);
  for (std::uint32_t i = 0; i < kTooMany; ++i) colliders[i].id = i;
  trace.pose(0, 0);
  trace.colliders(0, 0, colliders);
  test::MemoryFile file;
  file.assign(trace.finished());
  TraceReader reader(file.path());
  EXPECT_THAT(test::message_of([&] { reader.collider_ids(); }), HasSubstr("more than 1000000 colliders"));
}

/// Notes where it is read.
class WatchedSource final : public mcap::ByteSource {
 public:
  explicit WatchedSource(std::span<const std::byte> bytes) : bytes_(bytes) {}
  std::string name() const override { return "watched"; }
  std::uint64_t size() const override { return bytes_.size(); }
  void read_at(std::uint64_t offset, std::span<std::byte> out) const override {
    offsets.insert(offset);
    bytes_.read_at(offset, out);
  }
  mutable std::set<std::uint64_t> offsets;

 private:
  mcap::MemorySource bytes_;
};

class IndexedMessages : public ::testing::Test {
 protected:
  /// Chunks of the times 0 to 9, 10 to 19, …, each backwards; the third overlaps the fourth.
  IndexedMessages() {
    mcap::Writer writer(test::into(bytes_), {}, {.compression = Compression::kZstd});
    writer.write(mcap::Channel{.id = 1, .topic = "/a", .message_encoding = "json", .metadata = {}});
    for (std::uint64_t chunk = 0; chunk < 5; ++chunk) {
      for (std::uint64_t i = 0; i < 10; ++i) write(writer, 10 * chunk + 9 - i);
      if (chunk == 2) write(writer, 35);
      writer.close_chunk();
    }
    writer.finish();
  }
  static void write(mcap::Writer& writer, std::uint64_t time) {
    writer.write(mcap::Message{.channel_id = 1, .sequence = 0, .log_time = time, .publish_time = 0, .data = {}});
  }
  static std::vector<std::uint64_t> times_of(const mcap::ByteSource& source, const mcap::TimeRange& range) {
    mcap::IndexedReader reader(source, range);
    std::vector<std::uint64_t> times;
    for (mcap::Message message; reader.next(message);) times.push_back(message.log_time);
    EXPECT_TRUE(reader.damages().empty());
    return times;
  }

  std::vector<std::byte> bytes_;
};

TEST_F(IndexedMessages, ComeInOrderOfTimeFromChunksThatOverlap) {
  const std::vector<std::uint64_t> times = times_of(mcap::MemorySource(bytes_), {});
  EXPECT_EQ(times.size(), 51U);
  EXPECT_TRUE(std::is_sorted(times.begin(), times.end()));
}

TEST_F(IndexedMessages, OfATimeAreFoundWithoutReadingTheOtherChunks) {
  const WatchedSource source(bytes_);
  EXPECT_THAT(times_of(source, {.from_ns = 34, .to_ns = 37}), ElementsAre(34, 35, 35, 36));
  const mcap::Summary summary = *mcap::read_summary(source).summary;
  for (std::size_t i = 0; i < summary.chunk_indexes.size(); ++i)
    EXPECT_EQ(source.offsets.contains(summary.chunk_indexes[i].chunk_start_offset), i == 2 || i == 3) << i;
}

TEST_F(IndexedMessages, AreReadNoSoonerThanTheirTurnComes) {
  const WatchedSource source(bytes_);
  mcap::IndexedReader reader(source);
  mcap::Message message;
  ASSERT_TRUE(reader.next(message));
  const std::vector<mcap::ChunkIndex>& chunks = reader.summary().chunk_indexes;
  for (std::size_t i = 0; i < chunks.size(); ++i)
    EXPECT_EQ(source.offsets.contains(chunks[i].chunk_start_offset), i == 0) << i;
}

TEST_F(IndexedMessages, OfATimeInWhichNothingIsAreNone) {
  EXPECT_THAT(times_of(mcap::MemorySource(bytes_), {.from_ns = 50}), IsEmpty());
}

TEST_F(IndexedMessages, OfTheLatestTimeThereIsAreFound) {
  std::vector<std::byte> bytes;
  mcap::Writer writer(test::into(bytes), {}, {});
  writer.write(mcap::Channel{.id = 1, .topic = "/a", .message_encoding = "json", .metadata = {}});
  write(writer, ~std::uint64_t{0});
  writer.finish();
  EXPECT_THAT(times_of(mcap::MemorySource(bytes), {}), ElementsAre(~std::uint64_t{0}));
}

TEST_F(IndexedMessages, ThatContradictTheirIndexAreDeliveredAndSaid) {
  const mcap::MemorySource source(bytes_);
  mcap::Summary summary = *mcap::read_summary(source).summary;
  mcap::ByteBuffer bytes(bytes_.begin(), bytes_.begin() + static_cast<std::ptrdiff_t>(summary.data_section_end));
  for (const mcap::Channel& channel : summary.channels) append_record(bytes, channel);
  append_record(bytes, *summary.statistics);
  summary.chunk_indexes[1].message_start_time = 15;
  summary.chunk_indexes[1].message_index_offsets.clear();
  for (const mcap::ChunkIndex& index : summary.chunk_indexes) append_record(bytes, index);
  append_record(bytes, mcap::Footer{.summary_start = summary.data_section_end});
  mcap::append_magic(bytes);
  const mcap::MemorySource lying(bytes);
  mcap::IndexedReader reader(lying);
  std::uint64_t messages = 0;
  for (mcap::Message message; reader.next(message);) ++messages;
  EXPECT_EQ(messages, 51U);
  ASSERT_EQ(reader.damages().count(), 1U);
  EXPECT_THAT(reader.damages().kept().front().what, HasSubstr("outside the time range in its index"));
}

TEST_F(IndexedMessages, OfChunksThatAllOverlapAreSortedEachExpandedOnce) {
  std::vector<std::byte> bytes;
  mcap::Writer writer(test::into(bytes), {}, {.compression = Compression::kZstd});
  writer.write(mcap::Channel{.id = 1, .topic = "/a", .message_encoding = "json", .metadata = {}});
  constexpr std::uint64_t kChunks = 50;
  constexpr std::uint64_t kMessages = 2000;
  for (std::uint64_t chunk = 0; chunk < kChunks; ++chunk) {
    for (std::uint64_t i = 0; i < kMessages; ++i) write(writer, i * kChunks + chunk);
    writer.close_chunk();
  }
  writer.finish();
  const std::vector<std::uint64_t> times = times_of(mcap::MemorySource(bytes), {});
  EXPECT_EQ(times.size(), kChunks * kMessages);
  EXPECT_TRUE(std::is_sorted(times.begin(), times.end()));
}

TEST(TraceSummary, CountsWhatWasDroppedOfTopicsWithoutEnd) {
  test::ForgedTrace trace;
  for (std::uint32_t i = 0; i < 3000; ++i) trace.dropped(0, 1, fmt::format("/topic {}", i));
  test::MemoryFile file;
  file.assign(trace.finished());
  const McapSummary summary = summarise_mcap(file.path());
  EXPECT_EQ(summary.dropped, 3000U);
  EXPECT_LE(summary.dropped_by_topic.size(), 1001U);
  EXPECT_EQ(summary.dropped_by_topic.at("(other topics)"), 2000U);
}

}  // namespace
}  // namespace vestige
