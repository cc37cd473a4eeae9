#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "tests/support/message_of.hpp"
#include "tests/support/test_data.hpp"
#include "tests/traces/mcap/mcap_files.hpp"
#include "tests/traces/trace_file/small_trace.hpp"
#include "tests/traces/trace_file/trace_fixture.hpp"
#include "traces/base/error.hpp"
#include "traces/base/sha256.hpp"
#include "traces/files/input_file.hpp"
#include "traces/repair/trace_summary.hpp"
#include "traces/trace_file/trace_format.hpp"

namespace vestige {
namespace {

using test::kColliders;
using test::kNodes;
using test::message_of;
using ::testing::HasSubstr;

class TraceFileCompressed : public ::testing::TestWithParam<Compression> {};

TEST_P(TraceFileCompressed, ReadsBackToTheSameBits) {
  const test::TemporaryFolder folder;
  TraceWriterOptions options = test::steady_options(4096);
  options.compression = GetParam();
  const auto glb = test::skeleton_glb(kNodes);
  const std::vector<std::byte> png(100, std::byte{7});
  std::vector<TraceFrame> written;
  {
    TraceWriter writer(
        folder / "a.mcap", {{"argv", "vestige record"}},
        {{test::skeleton(kNodes), {.avatar_glb = glb, .actuator_map_png = png, .actuator_map_json = "{\"a\": 1}"}}},
        options);
    for (std::uint64_t i = 0; i < 200; ++i) {
      TraceFrame frame = test::frame(i, kNodes, i % 5);
      if (i % 50 == 9) frame.teleported = {3, 10};
      writer.write(frame);
      written.push_back(frame);
    }
    writer.finish();
    EXPECT_EQ(writer.frame_count(), 200U);
    EXPECT_EQ(writer.bytes_written(), std::filesystem::file_size(folder / "a.mcap"));
  }
  TraceReader reader(folder / "a.mcap");
  EXPECT_EQ(reader.session().at("argv"), "vestige record");
  EXPECT_EQ(reader.session().at("format_version"), "1");
  EXPECT_EQ(reader.session().at("sha256:avatar.glb"), sha256_hex(glb));
  EXPECT_THAT(reader.people().front().avatar_glb, ::testing::ElementsAreArray(glb));
  EXPECT_THAT(reader.people().front().actuator_map_png, ::testing::ElementsAreArray(png));
  EXPECT_EQ(reader.people().front().actuator_map_json.size(), 8U);
  EXPECT_EQ(reader.people().front().node_names.at(1), "node 1 \"\xC3\xA9\"");
  const auto read = test::read_frames(reader);
  ASSERT_EQ(read.size(), written.size());
  for (std::size_t i = 0; i < read.size(); ++i) EXPECT_TRUE(test::same_bits(read[i], written[i])) << i;
  EXPECT_THAT(reader.collider_ids(), ::testing::ElementsAre(3, 10, 17, 24));
  EXPECT_EQ(reader.frame_count(), 200U);
  EXPECT_TRUE(reader.complete());
  EXPECT_TRUE(reader.warnings().empty());
}

INSTANTIATE_TEST_SUITE_P(Compressions, TraceFileCompressed,
                         ::testing::Values(Compression::kNone, Compression::kLz4, Compression::kZstd));

TEST(TraceFile, ReadsTheSameAgainAfterRewindingAndWhileCounting) {
  const test::TemporaryFolder folder;
  test::write_trace(folder / "a.mcap", 50, test::steady_options(2000));
  TraceReader reader(folder / "a.mcap");
  TraceFrame frame;
  for (int i = 0; i < 20; ++i) ASSERT_TRUE(reader.next(frame));
  EXPECT_EQ(reader.frame_count(), 50U);
  ASSERT_TRUE(reader.next(frame));
  EXPECT_EQ(frame.index, 20U);
  reader.rewind();
  EXPECT_EQ(test::read_frames(reader).size(), 50U);
  EXPECT_FALSE(reader.next(frame));
}

TEST(TraceFile, WithoutFramesIsCompleteAndEmpty) {
  const test::TemporaryFolder folder;
  test::write_trace(folder / "a.mcap", 0, test::steady_options());
  TraceReader reader(folder / "a.mcap");
  TraceFrame frame;
  EXPECT_FALSE(reader.next(frame));
  EXPECT_TRUE(reader.complete());
}

TEST(TraceFile, IsTheSameBytesForTheSameFrames) {
  const test::TemporaryFolder folder;
  test::write_trace(folder / "a.mcap", 30, test::steady_options());
  test::write_trace(folder / "b.mcap", 30, test::steady_options());
  EXPECT_EQ(read_file(folder / "a.mcap"), read_file(folder / "b.mcap"));
}

TEST(TraceFile, CountsDropsAndKeepsMarkers) {
  const test::TemporaryFolder folder;
  const auto glb = test::skeleton_glb(kNodes);
  TraceWriter writer(folder / "a.mcap", {}, {{test::skeleton(kNodes), {.avatar_glb = glb}}}, test::steady_options());
  writer.note_marker("before anything");
  writer.write(test::frame(0, kNodes, 1));
  writer.note_dropped("/colliders", 3);
  writer.note_dropped("/pose", 4);
  writer.write(test::frame(8, kNodes, 1));
  writer.finish();
  TraceReader reader(folder / "a.mcap");
  EXPECT_EQ(reader.dropped(), 7U);
  EXPECT_EQ(reader.frame_count(), 2U);
  const auto frames = test::read_frames(reader);
  ASSERT_EQ(frames.size(), 2U);
  EXPECT_EQ(frames[1].index, 8U);
  EXPECT_EQ(summarise_mcap(folder / "a.mcap").dropped, 7U);
}

TEST(TraceFile, RefusesFramesThatContradictTheTrace) {
  const test::TemporaryFolder folder;
  const auto glb = test::skeleton_glb(kNodes);
  TraceWriter writer(folder / "a.mcap", {}, {{test::skeleton(kNodes), {.avatar_glb = glb}}}, test::steady_options());
  writer.write(test::frame(5, kNodes, 1));
  EXPECT_THAT(message_of([&] { writer.write(test::frame(5, kNodes, 1)); }), HasSubstr("comes after frame 5"));
  TraceFrame early = test::frame(6, kNodes, 1);
  early.time_ns = 1;
  EXPECT_THAT(message_of([&] { writer.write(early); }), HasSubstr("is earlier"));
  EXPECT_THAT(message_of([&] { writer.write(test::frame(6, kNodes + 1, 1)); }), HasSubstr("4 nodes"));
  TraceFrame twice = test::frame(6, kNodes, 2);
  twice.colliders[1].id = twice.colliders[0].id;
  EXPECT_THAT(message_of([&] { writer.write(twice); }), HasSubstr("it has collider 3 twice"));
  EXPECT_THAT(message_of([&] { writer.write(test::frame(std::uint64_t{1} << 32, kNodes, 1)); }), HasSubstr("32 bits"));
  writer.write(test::frame(6, kNodes, 1));
  writer.finish();
  EXPECT_THAT(message_of([&] { writer.write(test::frame(7, kNodes, 1)); }), HasSubstr("closed"));
  TraceReader reader(folder / "a.mcap");
  EXPECT_EQ(reader.frame_count(), 2U);
}

TEST(TraceFile, ClosesAChunkBySizeAndByAge) {
  const test::TemporaryFolder folder;
  test::write_trace(folder / "one.mcap", 20, test::steady_options());
  EXPECT_EQ(summarise_mcap(folder / "one.mcap").chunks, 1U);
  test::write_trace(folder / "each.mcap", 20, test::steady_options(1));
  EXPECT_EQ(summarise_mcap(folder / "each.mcap").chunks, 20U);
  test::write_trace(folder / "old.mcap", 20, {.chunk_s = 0});
  EXPECT_EQ(summarise_mcap(folder / "old.mcap").chunks, 20U);
}

TEST(TraceFile, ExplainsWhatIsNoTrace) {
  const test::TemporaryFolder folder;
  EXPECT_THAT(message_of([] { TraceReader("/no/such.mcap"); }), HasSubstr("there is no such file"));
  EXPECT_THAT(message_of([] { TraceReader("/tmp"); }), HasSubstr("is a folder"));
  std::ofstream(folder / "empty.mcap").flush();
  EXPECT_THAT(message_of([&] { TraceReader(folder / "empty.mcap"); }), HasSubstr("is empty"));
  std::ofstream(folder / "text.mcap") << "this is not the file you are looking for";
  EXPECT_THAT(message_of([&] { TraceReader(folder / "text.mcap"); }), HasSubstr("is not an MCAP file"));
  EXPECT_THAT(message_of([&] { summarise_mcap(folder / "text.mcap"); }), HasSubstr("is not an MCAP file"));
}

TEST(TraceFile, OfSomeoneElseIsRefusedByTheReaderButSummarised) {
  const auto file = test::data("mcap/compressed/multi-lz4.mcap");
  VESTIGE_REQUIRE_DATA(file);
  EXPECT_THAT(message_of([&] { TraceReader reader(file); }), HasSubstr("not a trace of vestige"));
  const McapSummary summary = summarise_mcap(file);
  EXPECT_EQ(summary.messages, 600U);
  EXPECT_EQ(summary.channels.size(), 3U);
  EXPECT_EQ(summary.chunks, 11U);
  EXPECT_THAT(summary.compression, ::testing::ElementsAre("lz4"));
  EXPECT_EQ(summary.attachments.size(), 1U);
  EXPECT_TRUE(summary.complete);
}

TEST(TraceFile, RefusesAPoseThatDoesNotFitTheAvatar) {
  const test::TemporaryFolder folder;
  const auto glb = test::skeleton_glb(kNodes + 1);
  {
    TraceWriter writer(folder / "a.mcap", {}, {{test::skeleton(kNodes), {.avatar_glb = glb}}}, test::steady_options());
    writer.write(test::frame(0, kNodes, 0));
    writer.finish();
  }
  EXPECT_THAT(message_of([&] { TraceReader reader(folder / "a.mcap"); }),
              HasSubstr("its poses have 3 nodes, but its avatar has 4"));
}

TEST(TraceFile, SaysWhereItContradictsItsSession) {
  const test::TemporaryFolder folder;
  test::write_trace(folder / "a.mcap", 5, test::steady_options());
  const std::string whole = read_text_file(folder / "a.mcap");
  const std::string glb_sha256 = sha256_hex(test::skeleton_glb(kNodes));
  const auto changed = [&](const std::string& what, std::size_t at, char to, std::size_t times = 1) {
    std::string bytes = whole;
    for (std::size_t i = 0; i < times; ++i) {
      const std::size_t found = bytes.find(what);
      EXPECT_NE(found, std::string::npos);
      bytes[found + at] = to;
    }
    std::ofstream(folder / "b.mcap", std::ios::binary) << bytes;
    TraceReader reader(folder / "b.mcap");
    EXPECT_EQ(test::read_frames(reader).size(), 5U);
    EXPECT_FALSE(reader.complete());
    const McapSummary summary = summarise_mcap(folder / "b.mcap");
    EXPECT_FALSE(summary.complete);
    // The summary also verifies the CRC of the data section.
    if (times == 1) {
      EXPECT_THAT(summary.warnings, ::testing::IsSupersetOf(reader.warnings()));
    }
    return fmt::format("{}", fmt::join(reader.warnings(), "\n"));
  };
  // Behind the key stands the length of the value.
  EXPECT_THAT(changed("format_version", 14 + 4, 'x'), HasSubstr("its format version is 'x', which is no version"));
  const char other = glb_sha256[5] == '0' ? '1' : '0';
  EXPECT_THAT(changed(glb_sha256, 5, other), HasSubstr("that of the session is damaged"));
  // In the session, in the channel /pose, and in the summary.
  EXPECT_THAT(changed(glb_sha256, 5, other, 3), HasSubstr("the attachment avatar.glb is not the recorded one"));
}

TEST(TraceReader, RefusesALaterFormatVersion) {
  const test::TemporaryFolder folder;
  test::write_trace(folder / "a.mcap", 5, test::steady_options());
  std::string bytes = read_text_file(folder / "a.mcap");
  bytes[bytes.find("format_version") + 14 + 4] = '9';
  std::ofstream(folder / "b.mcap", std::ios::binary) << bytes;
  try {
    TraceReader reader(folder / "b.mcap");
    FAIL() << "it was read";
  } catch (const Error& error) {
    EXPECT_THAT(error.fault(), HasSubstr("b.mcap: its format version is 9, and this vestige reads versions up to 3"));
    EXPECT_THAT(error.remedy(), HasSubstr("later version"));
  }
  EXPECT_THAT(fmt::format("{}", fmt::join(summarise_mcap(folder / "b.mcap").warnings, "\n")),
              HasSubstr("its format version is 9"));
}

TEST(TraceFile, OfSpheresGivesTheirRadiiBackToTheBit) {
  const test::TemporaryFolder folder;
  TraceWriterOptions options = test::steady_options();
  options.shape = ColliderShape::kSpheres;
  const std::vector<std::byte> glb = test::skeleton_glb(kNodes);
  std::vector<TraceFrame> written;
  for (std::uint64_t i = 0; i < 3; ++i) {
    TraceFrame& frame = written.emplace_back(test::frame(i, kNodes, kColliders));
    if (i != 1) frame.colliders[i % kColliders].radius_m = 0.1F / static_cast<float>(i + 1);  // frame 1: points only
  }
  {
    TraceWriter writer(folder / "a.mcap", {}, {{test::skeleton(kNodes), {.avatar_glb = glb}}}, options);
    for (const TraceFrame& frame : written) writer.write(frame);
    writer.finish();
  }
  TraceReader reader(folder / "a.mcap");
  EXPECT_EQ(reader.shape(), ColliderShape::kSpheres);
  EXPECT_EQ(reader.session().at("format_version"), "2");
  const auto frames = test::read_frames(reader);
  ASSERT_EQ(frames.size(), written.size());
  for (std::size_t i = 0; i < frames.size(); ++i) EXPECT_TRUE(test::same_bits(frames[i], written[i])) << i;
  EXPECT_EQ(reader.sphere_ids(), (std::vector<std::uint32_t>{3}));
  EXPECT_TRUE(reader.complete());
}

TEST(TraceFile, RefusesToRecordARadiusThatNoneCanHave) {
  const test::TemporaryFolder folder;
  TraceWriterOptions options = test::steady_options();
  options.shape = ColliderShape::kSpheres;
  const std::vector<std::byte> glb = test::skeleton_glb(kNodes);
  for (const float wrong : {-1.0F, 10.5F, NAN, INFINITY}) {
    options.overwrite = Overwrite::kAllow;
    TraceWriter writer(folder / "a.mcap", {}, {{test::skeleton(kNodes), {.avatar_glb = glb}}}, options);
    TraceFrame frame = test::frame(0, kNodes, kColliders);
    frame.colliders[0].radius_m = wrong;
    EXPECT_THROW(writer.write(frame), Error) << wrong;
  }
}

TEST(TraceSummary, SaysWhatATraceHolds) {
  const test::TemporaryFolder folder;
  test::write_trace(folder / "a.mcap", 100, test::steady_options(3000));
  const McapSummary summary = summarise_mcap(folder / "a.mcap");
  EXPECT_EQ(summary.profile, "vestige");
  EXPECT_EQ(summary.messages, 200U);
  EXPECT_GT(summary.chunks, 1U);
  EXPECT_GT(summary.compressed_bytes, 0U);
  EXPECT_LT(summary.compressed_bytes, summary.uncompressed_bytes);
  EXPECT_EQ(summary.session, TraceReader(folder / "a.mcap").session());
  EXPECT_NEAR(summary.duration_s, 0.099000297, 1e-12);
  ASSERT_EQ(summary.channels.size(), 2U);
  EXPECT_EQ(summary.channels[0].topic, "/pose");
  EXPECT_EQ(summary.channels[0].schema, "vestige.trace.PoseFrame");
  EXPECT_EQ(summary.channels[0].encoding, "flatbuffer");
  EXPECT_EQ(summary.channels[0].messages, 100U);
  EXPECT_NEAR(summary.channels[0].rate_hz, 1000, 0.01);
  ASSERT_EQ(summary.attachments.size(), 2U);
  EXPECT_EQ(summary.attachments[0].name, "avatar.glb");
  EXPECT_EQ(summary.attachments[0].sha256, sha256_hex(test::skeleton_glb(kNodes)));
  EXPECT_THAT(summary.warnings, ::testing::IsEmpty());
  EXPECT_TRUE(summary.complete);
}

TEST(TraceSummary, KeepsTheFirstThousandWarningsAndCountsTheRest) {
  for (const std::uint32_t broken : {1U, 1000U, 1001U, 3000U}) {
    std::vector<std::byte> bytes;
    mcap::Writer writer(test::into(bytes), {}, {});
    writer.write(trace_format::schema_of(trace_format::Stream::kEvents));
    const mcap::Channel events = trace_format::channel_of(trace_format::Stream::kEvents);
    writer.write(events);
    for (std::uint32_t i = 0; i < broken; ++i)
      writer.write(mcap::Message{.channel_id = events.id, .sequence = i, .log_time = i, .publish_time = i, .data = {}});
    writer.finish();
    test::MemoryFile file;
    file.assign(bytes);
    const McapSummary summary = summarise_mcap(file.path());
    EXPECT_EQ(summary.messages, broken);
    EXPECT_FALSE(summary.complete);
    EXPECT_EQ(summary.warnings.size(), std::min(broken, 1001U));
    EXPECT_THAT(summary.warnings.front(), HasSubstr("a Message: "));
    if (broken <= 1000) continue;
    EXPECT_EQ(summary.warnings.back(), fmt::format("{}: and {} more", file.path().string(), broken - 1000));
  }
}

}  // namespace
}  // namespace vestige
