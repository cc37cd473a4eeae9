// `vestige recompress` and `vestige trim`.

#include "traces/repair/rewrite.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <ctime>

#include "tests/traces/mcap/mcap_files.hpp"
#include "tests/traces/trace_file/small_trace.hpp"
#include "traces/base/error.hpp"
#include "traces/repair/trace_check.hpp"
#include "traces/repair/trace_summary.hpp"
#include "traces/trace_file/trace_format.hpp"

namespace vestige {
namespace {

using test::kFrames;
using test::small_trace;
using ::testing::HasSubstr;

std::vector<std::byte> rewrite(std::span<const std::byte> bytes, const RewriteOptions& options) {
  const mcap::MemorySource source(bytes);
  std::vector<std::byte> written;
  const Rewritten result = rewrite_mcap(source, test::into(written), options, test::go_on);
  EXPECT_TRUE(result.damages.empty());
  EXPECT_EQ(result.bytes, written.size());
  const mcap::MemorySource again(written);
  EXPECT_EQ(check_trace(again, test::go_on).problems.count(), 0U);
  return written;
}

TEST(Recompress, ChangesNothingButTheCompression) {
  const test::TemporaryFolder folder;
  const test::MemoryFile file;
  for (const Compression from : {Compression::kNone, Compression::kLz4, Compression::kZstd}) {
    const auto trace = small_trace(folder, from);
    for (const Compression to : {Compression::kNone, Compression::kLz4, Compression::kZstd}) {
      const auto written = rewrite(trace.bytes, {.compression = to});
      EXPECT_EQ(test::content_sha256(written), test::content_sha256(trace.bytes));
      file.assign(written);
      const McapSummary summary = summarise_mcap(file.path());
      EXPECT_EQ(summary.chunks, trace.chunks.size());
      const std::string name(mcap::name_of(to));
      EXPECT_EQ(summary.compression, std::vector<std::string>{name.empty() ? "none" : name});
    }
    std::filesystem::remove(folder / "whole.mcap");
  }
}

TEST(Recompress, KeepsFilesOfOthers) {
  VESTIGE_REQUIRE_DATA(test::data("mcap"));
  for (const auto& path : test::foreign_mcaps()) {
    const auto bytes = read_file(path);
    const auto written = rewrite(bytes, {.compression = Compression::kLz4});
    EXPECT_EQ(test::content_sha256(written), test::content_sha256(bytes)) << path;
  }
}

/// Returns the processor time in which so many channels and then so many schemas are rewritten.
std::clock_t time_to_rewrite(std::uint16_t count, const std::string& name) {
  std::vector<std::byte> bytes;
  mcap::Writer writer(test::into(bytes), {}, {.repeat_schemas = false, .repeat_channels = false});
  for (std::uint16_t id = 0; id < count; ++id)
    writer.write(mcap::Channel{.id = id, .schema_id = 0, .topic = "", .message_encoding = "", .metadata = {}});
  for (std::uint16_t id = 1; id <= count; ++id)
    writer.write(mcap::Schema{.id = id, .name = name, .encoding = "", .data = {}});
  writer.finish();
  const mcap::MemorySource source(bytes);
  std::vector<std::byte> written;
  const std::clock_t before = std::clock();
  EXPECT_TRUE(rewrite_mcap(source, test::into(written), {}, test::go_on).damages.empty());
  return std::clock() - before;
}

/// Definitions in a chunk, channels before what could be their schemas: these once took many seconds.
TEST(Recompress, TimeDoesNotGrowAsSchemasTimesChannels) {
  const std::string ours = trace_format::schema_of(trace_format::Stream::kPose).name;
  for (const std::string& name : {ours, std::string("other")}) {
    const std::clock_t of_few = time_to_rewrite(1250, name);
    const std::clock_t of_many = time_to_rewrite(20000, name);
    // 16 times as many: about 16 times as long, where each schema compared with each channel takes 256 times as long.
    EXPECT_LT(of_many, 80 * of_few) << name;
  }
}

TEST(Recompress, DoesNotMakeDamageLookSound) {
  const test::TemporaryFolder folder;
  auto trace = small_trace(folder, Compression::kNone);
  trace.bytes[trace.chunks[1].end() - 20] ^= std::byte{1};
  const auto glb = test::skeleton_glb(test::kNodes);
  *(std::search(trace.bytes.begin(), trace.bytes.end(), glb.begin(), glb.end()) + 30) ^= std::byte{1};
  const mcap::MemorySource source(trace.bytes);
  std::vector<std::byte> written;
  const Rewritten result = rewrite_mcap(source, test::into(written), {}, test::go_on);
  EXPECT_EQ(result.messages, 2 * (kFrames - test::kFramesInAChunk));
  EXPECT_EQ(result.damages.count(), 3U) << "attachment, chunk, data section";
  const std::string text(reinterpret_cast<const char*>(written.data()), written.size());
  EXPECT_THAT(text, ::testing::Not(HasSubstr("avatar.glb\n")));
  const mcap::MemorySource again(written);
  EXPECT_EQ(check_trace(again, test::go_on).container.attachments, 1U);
}

TEST(Recompress, SaysThatAMessageDoesNotFitItsFieldsAndKeepsTheOthers) {
  const test::TemporaryFolder folder;
  auto trace = small_trace(folder, Compression::kNone);
  test::shorten_first_message(trace);
  const mcap::MemorySource source(trace.bytes);
  std::vector<std::byte> written;
  const Rewritten result = rewrite_mcap(source, test::into(written), {}, test::go_on);
  EXPECT_EQ(result.messages, 2 * kFrames - 1);
  ASSERT_EQ(result.damages.count(), 1U);
  EXPECT_EQ(result.damages.kept()[0].offset, trace.chunks[0].offset);
  EXPECT_EQ(result.damages.kept()[0].bytes, mcap::kRecordHeadBytes + 3);
  EXPECT_THAT(result.damages.kept()[0].what, HasSubstr("shorter than their fields"));
}

TEST(Trim, KeepsWhatIsAtTheFirstTimeAndLeavesOutWhatIsAtTheLast) {
  const test::TemporaryFolder folder;
  const auto trace = small_trace(folder, Compression::kZstd);
  const auto time_of = [](std::uint64_t index) { return static_cast<std::uint64_t>(test::frame(index, 1, 0).time_ns); };
  const auto written = rewrite(trace.bytes, {.range = {.from_ns = time_of(3), .to_ns = time_of(9)}});
  const test::MemoryFile file;
  file.assign(written);
  TraceReader reader(file.path());
  const auto frames = test::read_frames(reader);
  ASSERT_EQ(frames.size(), 6U);
  for (std::size_t i = 0; i < frames.size(); ++i)
    EXPECT_TRUE(test::same_bits(frames[i], test::frame(i + 3, test::kNodes, test::kColliders)));
  EXPECT_TRUE(reader.complete());
}

TEST(Trim, RefusesATimeInWhichNothingIsAndSaysWhenSomethingIs) {
  const test::TemporaryFolder folder;
  const auto trace = small_trace(folder, Compression::kZstd);
  const mcap::MemorySource source(trace.bytes);
  std::vector<std::byte> written;
  try {
    rewrite_mcap(source, test::into(written), {.range = {.from_ns = 1'000'000'000}}, test::go_on);
    FAIL() << "wrote an empty trace";
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), HasSubstr("its messages are from 0 to 0.015000045 s"));
  }
}

}  // namespace
}  // namespace vestige
