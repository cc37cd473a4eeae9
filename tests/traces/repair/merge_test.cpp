// `vestige merge`: parts of one recording become the whole again.

#include "traces/repair/merge.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <malloc.h>

#include <algorithm>
#include <memory>

#include "tests/traces/mcap/mcap_files.hpp"
#include "tests/traces/trace_file/small_trace.hpp"
#include "traces/base/error.hpp"
#include "traces/repair/rewrite.hpp"
#include "traces/trace_file/mcap_output.hpp"

namespace vestige {
namespace {

using test::kFrames;
using test::small_trace;
using ::testing::HasSubstr;

using Bytes = std::vector<std::byte>;

std::uint64_t time_of(std::uint64_t index) {
  return static_cast<std::uint64_t>(test::frame(index, 1, 0).time_ns);
}

/// Frames first … last - 1.
Bytes part(const Bytes& whole, std::uint64_t first, std::uint64_t last) {
  const mcap::MemorySource source(whole);
  Bytes written;
  rewrite_mcap(source, test::into(written), {.range = {.from_ns = time_of(first), .to_ns = time_of(last)}},
               test::go_on);
  return written;
}

struct Merge {
  Merged merged;
  Bytes bytes;
};

Merge merge(const std::vector<Bytes>& parts) {
  std::vector<std::unique_ptr<mcap::ByteSource>> sources;
  for (const Bytes& bytes : parts) sources.push_back(std::make_unique<mcap::MemorySource>(bytes));
  Merge result;
  result.merged = merge_traces(sources, test::into(result.bytes), test::go_on);
  return result;
}

std::string refusal(const std::vector<Bytes>& parts) {
  try {
    merge(parts);
  } catch (const Error& error) {
    return error.what();
  }
  return "merged";
}

Bytes recording(const test::TemporaryFolder& folder, std::uint64_t frames, std::size_t nodes, const std::string& map,
                double shift = 0) {
  const std::vector<std::byte> glb = test::skeleton_glb(nodes);
  TraceWriterOptions options = test::steady_options(1200);
  options.overwrite = Overwrite::kAllow;
  TraceWriter writer(folder / "other.mcap", {{"argv", "test"}},
                     {{test::skeleton(nodes), {.avatar_glb = glb, .actuator_map_json = map}}}, options);
  for (std::uint64_t i = 0; i < frames; ++i) {
    TraceFrame frame = test::frame(i, nodes, test::kColliders);
    frame.colliders[0].position_m.x += shift;
    writer.write(frame);
  }
  writer.note_marker("end");
  writer.finish();
  return read_file(folder / "other.mcap");
}

TEST(Merge, MakesTheWholeOfItsPartsInAnyOrder) {
  const test::TemporaryFolder folder;
  const Bytes whole = small_trace(folder, Compression::kZstd).bytes;
  const Merge result = merge({part(whole, 11, 99), part(whole, 0, 5), part(whole, 5, 11)});
  EXPECT_EQ(test::content_sha256(result.bytes), test::content_sha256(whole));
  EXPECT_EQ(result.merged.frames, kFrames);
  EXPECT_EQ(result.merged.duplicates, 0U);
  EXPECT_EQ(result.merged.missing_frames, 0U);
}

TEST(Merge, WritesFramesThatSeveralPartsHaveOnce) {
  const test::TemporaryFolder folder;
  const Bytes whole = recording(folder, kFrames, test::kNodes, "{}");
  const Merge result = merge({part(whole, 0, 9), part(whole, 4, 99), whole});
  EXPECT_EQ(test::content_sha256(result.bytes), test::content_sha256(whole));
  EXPECT_EQ(result.merged.duplicates, 2 * 5 + 2 * kFrames + 1);
}

TEST(Merge, CountsFramesThatNoPartHas) {
  const test::TemporaryFolder folder;
  const Bytes whole = small_trace(folder, Compression::kZstd).bytes;
  EXPECT_EQ(merge({part(whole, 0, 4), part(whole, 10, 99)}).merged.missing_frames, 6U);
}

TEST(Merge, RefusesWhatIsNoPartOfTheSameRecordingAndSaysWhy) {
  const test::TemporaryFolder folder;
  const Bytes whole = recording(folder, kFrames, test::kNodes, "{}");
  EXPECT_THAT(refusal({whole, recording(folder, 4, test::kNodes + 1, "{}")}),
              HasSubstr("its avatar differs from that of"));
  EXPECT_THAT(refusal({whole, recording(folder, 4, test::kNodes, "{\"a\":1}")}),
              HasSubstr("its actuator map's description differs from that of"));
  EXPECT_THAT(refusal({whole, recording(folder, 4, test::kNodes, "{}", 1)}),
              HasSubstr("its frame 0 (at 0 ns) differs"));
}

TEST(Merge, TakesWhatViewersDrawFromTheFirstFile) {
  const test::TemporaryFolder folder;
  const std::vector<std::byte> glb = test::skeleton_glb(test::kNodes);
  // Each file's first frame has /viz.
  const auto record = [&](const char* name, std::uint64_t first, std::uint64_t last) {
    TraceWriterOptions options = test::steady_options(1200);
    options.viz = Viz::kScene;
    TraceWriter writer(folder / name, {{"argv", "test"}}, {{test::skeleton(test::kNodes), {.avatar_glb = glb}}},
                       options);
    for (std::uint64_t i = first; i < last; ++i) writer.write(test::frame(i, test::kNodes, test::kColliders));
    writer.finish();
    return read_file(folder / name);
  };
  const Merge result = merge({record("a.mcap", 0, 8), record("b.mcap", 4, 12)});
  EXPECT_EQ(result.merged.frames, 12U);
  EXPECT_EQ(result.merged.duplicates, 2U * 4);
  EXPECT_EQ(result.merged.messages, 2U * 12 + 2) << "/viz of the first frame only";
  EXPECT_TRUE(result.merged.other_sessions.empty());
}

/// The same with `count` messages of another's at its beginning, each in a chunk of its own.
Bytes with_others(const Bytes& whole, std::size_t count, std::size_t bytes) {
  constexpr std::uint16_t kOther = 99;
  const mcap::MemorySource source(whole);
  Bytes written;
  McapOutput output(test::into(written), "vestige", mcap::Compression::kZstd, gather_definitions(source));
  output.add(mcap::Channel{.id = kOther, .schema_id = 0, .topic = "/other", .message_encoding = "", .metadata = {}});
  output.write_definitions();
  const std::vector<std::byte> zeros(bytes);
  for (std::size_t i = 0; i < count; ++i) {
    output.write(mcap::Message{.channel_id = kOther, .data = zeros});
    output.end_chunk();
  }
  mcap::StreamReader reader(source);
  mcap::StreamRecord record;
  while (reader.next(record)) {
    if (record.opcode == mcap::Opcode::kMetadata) output.write(mcap::decode_metadata(record.content));
    if (record.opcode == mcap::Opcode::kAttachment) output.write(mcap::decode_attachment(record.content));
    if (record.opcode == mcap::Opcode::kMessage) output.write(mcap::decode_message(record.content));
  }
  output.finish();
  return written;
}

TEST(Merge, KeepsNoMoreThanAChunkOfAMomentInMemory) {
  constexpr std::size_t kCount = 128;
  constexpr std::size_t kBytes = std::size_t{1} << 20;
  const test::TemporaryFolder folder;
  const Bytes whole = recording(folder, kFrames, test::kNodes, "{}");
  std::vector<std::unique_ptr<mcap::ByteSource>> sources;
  const Bytes large = with_others(whole, kCount, kBytes);
  for (const Bytes* bytes : {&large, &whole}) sources.push_back(std::make_unique<mcap::MemorySource>(*bytes));
  const auto allocated = [] {
    const auto info = ::mallinfo2();
    return info.uordblks + info.hblkhd;
  };
  const std::size_t before = allocated();
  std::size_t most = before;
  const Merged merged = merge_traces(
      sources, [&](mcap::Bytes /*bytes*/) { most = std::max(most, allocated()); }, test::go_on);
  EXPECT_EQ(merged.frames, kFrames);
  EXPECT_EQ(merged.duplicates, 2 * kFrames + 1);
  EXPECT_EQ(merged.messages, kCount + 2 * kFrames + 1);
  EXPECT_LT(most - before, kCount * kBytes / 2);
}

TEST(Merge, NamesWhatTheSessionsOfOtherRecordingsDifferIn) {
  const test::TemporaryFolder folder;
  const std::vector<std::byte> glb = test::skeleton_glb(test::kNodes);
  const auto record = [&](const char* name, const Session& session, std::uint64_t first) {
    TraceWriter writer(folder / name, session, {{test::skeleton(test::kNodes), {.avatar_glb = glb}}},
                       test::steady_options(1200));
    for (std::uint64_t i = first; i < first + 4; ++i) writer.write(test::frame(i, test::kNodes, test::kColliders));
    writer.finish();
    return read_file(folder / name);
  };
  const Bytes first = record("a.mcap", {{"argv", "test"}, {"seed", "1"}}, 0);
  const Bytes other = record("b.mcap", {{"argv", "test"}, {"seed", "2"}, {"live", "-"}}, 4);
  const Merge result = merge({first, first, other});
  EXPECT_EQ(result.merged.frames, 8U);
  ASSERT_EQ(result.merged.other_sessions.size(), 1U);
  EXPECT_THAT(result.merged.other_sessions[0].keys, ::testing::ElementsAre("live", "seed"));
}

TEST(Merge, NotesAMessageThatDoesNotFitItsFieldsAndReadsOn) {
  const test::TemporaryFolder folder;
  test::SmallTrace trace = small_trace(folder, Compression::kNone);
  const Bytes rest = part(trace.bytes, 8, 99);
  test::shorten_first_message(trace);
  const Merge result = merge({part(trace.bytes, 0, 8), trace.bytes, rest});
  EXPECT_EQ(result.merged.frames, kFrames - 1);
  ASSERT_EQ(result.merged.damages.size(), 1U);
  ASSERT_EQ(result.merged.damages[0].list.count(), 1U);
  EXPECT_THAT(result.merged.damages[0].list.kept()[0].what, HasSubstr("shorter than their fields"));
}

TEST(Merge, RefusesFilesOfOthers) {
  VESTIGE_REQUIRE_DATA(test::data("mcap"));
  const auto foreign = read_file(test::data("mcap/compressed/multi-zstd.mcap"));
  EXPECT_THAT(refusal({foreign, foreign}), HasSubstr("is not a trace of vestige"));
}

}  // namespace
}  // namespace vestige
