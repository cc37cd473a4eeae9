// What `vestige recover` makes of damaged files.

#include "traces/repair/recover.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <optional>

#include "tests/support/memory_growth.hpp"
#include "tests/traces/mcap/mcap_files.hpp"
#include "tests/traces/trace_file/small_trace.hpp"
#include "traces/base/error.hpp"
#include "traces/mcap/encode.hpp"
#include "traces/mcap/stream_reader.hpp"
#include "traces/repair/trace_check.hpp"
#include "traces/repair/trace_summary.hpp"
#include "traces/trace_file/trace_format.hpp"
#include "traces/trace_file/trace_messages.hpp"

namespace vestige {
namespace {

using test::kColliders;
using test::kFrames;
using test::kFramesInAChunk;
using test::kNodes;
using test::small_trace;
using test::SmallTrace;
using ::testing::HasSubstr;

struct Outcome {
  Recovery recovery;
  std::vector<std::byte> bytes;
  std::vector<TraceFrame> frames;
};

/// Recovers, and reads what was written, which must be sound and complete. Nothing when nothing could be recovered.
std::optional<Outcome> recover(std::span<const std::byte> bytes) {
  Outcome outcome;
  try {
    const mcap::MemorySource source(bytes);
    outcome.recovery = recover_mcap(source, test::into(outcome.bytes), test::go_on);
  } catch (const Error&) {
    return {};
  }
  const mcap::MemorySource written(outcome.bytes);
  const TraceCheck check = check_trace(written, test::go_on);
  EXPECT_EQ(check.container.damaged_chunks, 0U);
  EXPECT_TRUE(check.container.has_footer);
  return outcome;
}

/// Metadata have no CRC, and stay as they are: what is damaged in them is all that the reader may find.
enum class Head { kSound, kDamaged };

void read_frames(Outcome& outcome, Head head = Head::kSound) {
  static const test::MemoryFile file;
  file.assign(outcome.bytes);
  TraceReader reader(file.path());
  outcome.frames = test::read_frames(reader);
  for (const std::string& warning : reader.warnings()) {
    EXPECT_EQ(head, Head::kDamaged) << warning;
    EXPECT_THAT(warning, HasSubstr("SHA-256"));
  }
  EXPECT_TRUE(reader.complete() || !reader.warnings().empty());
}

bool is_as_written(const TraceFrame& frame) {
  return test::same_bits(frame, test::frame(frame.index, kNodes, kColliders));
}

std::size_t intact(const std::vector<TraceFrame>& frames) {
  return static_cast<std::size_t>(std::count_if(frames.begin(), frames.end(), is_as_written));
}

class RecoverCompressed : public ::testing::TestWithParam<Compression> {
 protected:
  const test::TemporaryFolder folder_;
  const SmallTrace trace_ = small_trace(folder_, GetParam());
};

TEST_P(RecoverCompressed, WritesASoundTraceAsItWas) {
  auto outcome = recover(trace_.bytes);
  ASSERT_TRUE(outcome);
  read_frames(*outcome);
  EXPECT_FALSE(outcome->recovery.lost_something());
  EXPECT_EQ(intact(outcome->frames), kFrames);
  EXPECT_EQ(outcome->recovery.chunks_whole, trace_.chunks.size());
  EXPECT_EQ(test::content_sha256(outcome->bytes), test::content_sha256(trace_.bytes));
}

TEST_P(RecoverCompressed, MendsAFormatVersionThatIsNotThatOfTheSchemas) {
  std::vector<std::byte> bytes = trace_.bytes;
  const std::string_view key = "format_version";
  const auto found = std::search(bytes.begin(), bytes.end(), key.begin(), key.end(),
                                 [](std::byte byte, char letter) { return byte == static_cast<std::byte>(letter); });
  ASSERT_NE(found, bytes.end());
  std::byte& digit = found[static_cast<std::ptrdiff_t>(key.size() + 4)];  // behind the length of the value
  for (const char wrong : {'9', 'x', '0', '2'}) {
    digit = static_cast<std::byte>(wrong);
    auto outcome = recover(bytes);
    ASSERT_TRUE(outcome) << wrong;
    ASSERT_FALSE(outcome->recovery.repaired.empty()) << wrong;
    EXPECT_THAT(outcome->recovery.repaired.front(), HasSubstr("format version")) << wrong;
    read_frames(*outcome);
    EXPECT_EQ(intact(outcome->frames), kFrames) << wrong;
  }
}

TEST_P(RecoverCompressed, KeepsEveryWholeChunkOfAFileThatIsCutAnywhere) {
  for (std::size_t length = 1; length < trace_.bytes.size(); length += test::kByteStep) {
    auto outcome = recover(std::span(trace_.bytes).first(length));
    if (length < trace_.head_end) continue;
    ASSERT_TRUE(outcome) << length;
    read_frames(*outcome);
    const auto whole = static_cast<std::size_t>(std::count_if(
        trace_.chunks.begin(), trace_.chunks.end(), [&](const auto& chunk) { return chunk.end() <= length; }));
    EXPECT_GE(intact(outcome->frames), whole * kFramesInAChunk) << length;
    EXPECT_EQ(intact(outcome->frames), outcome->frames.size()) << length << ": nothing is made up";
    const auto begun = static_cast<std::size_t>(std::count_if(
        trace_.chunks.begin(), trace_.chunks.end(), [&](const auto& chunk) { return chunk.offset < length; }));
    EXPECT_EQ(outcome->recovery.lost_something(), outcome->frames.size() < begun * kFramesInAChunk) << length;
  }
}

TEST_P(RecoverCompressed, KeepsEveryIntactChunkWhateverByteIsFlipped) {
  const test::MemoryGrowth growth;
  std::size_t kept_of_damaged_chunks = 0;
  std::size_t damaged_chunks = 0;
  for (std::size_t at = 0; at < trace_.bytes.size(); at += test::kByteStep) {
    for (const int flip : {0x01, 0xFF}) {
      std::vector<std::byte> damaged = trace_.bytes;
      damaged[at] ^= static_cast<std::byte>(flip);
      auto outcome = recover(damaged);
      ASSERT_TRUE(outcome) << at;
      const bool has_avatar = outcome->recovery.attachments == 2;
      EXPECT_TRUE(has_avatar || at < trace_.head_end) << at;
      if (!has_avatar) {
        EXPECT_TRUE(outcome->recovery.lost_something()) << at;
        EXPECT_EQ(outcome->recovery.messages, 2 * kFrames) << at;
        continue;
      }
      read_frames(*outcome, at < trace_.head_end ? Head::kDamaged : Head::kSound);
      const bool in_chunk = std::any_of(trace_.chunks.begin(), trace_.chunks.end(),
                                        [&](const auto& chunk) { return at >= chunk.offset && at < chunk.end(); });
      const std::size_t sound = intact(outcome->frames);
      EXPECT_GE(sound, kFrames - (in_chunk ? kFramesInAChunk : 0)) << at;
      // What is not as it was recorded is said to be unverified.
      if (sound < outcome->frames.size()) {
        EXPECT_GT(outcome->recovery.messages_unverified, 0U) << at;
      }
      if (sound < kFrames) {
        EXPECT_TRUE(outcome->recovery.lost_something()) << at;
      }
      if (in_chunk) {
        ++damaged_chunks;
        kept_of_damaged_chunks += sound - (kFrames - kFramesInAChunk);
      }
    }
  }
  if (GetParam() == Compression::kNone) {
    EXPECT_GT(kept_of_damaged_chunks, 2 * damaged_chunks) << "most frames of a damaged chunk are still there";
  }
  if (test::kMeasuresMemory) {
    EXPECT_LT(growth.kibibytes(), 64 << 10);
  }
}

INSTANTIATE_TEST_SUITE_P(Compressions, RecoverCompressed,
                         ::testing::Values(Compression::kNone, Compression::kLz4, Compression::kZstd));

TEST(Recover, FindsChunksAgainBehindGarbageAndWithoutTheirBeginning) {
  const test::TemporaryFolder folder;
  const SmallTrace trace = small_trace(folder, Compression::kZstd);
  std::vector<std::byte> bytes = trace.bytes;
  const auto at = [&](std::uint64_t offset) { return bytes.begin() + static_cast<std::ptrdiff_t>(offset); };
  std::fill(at(trace.chunks[1].offset - 3), at(trace.chunks[1].end() - 3), std::byte{0xAA});
  auto outcome = recover(bytes);
  ASSERT_TRUE(outcome);
  read_frames(*outcome);
  EXPECT_EQ(intact(outcome->frames), kFrames - kFramesInAChunk);
  EXPECT_GT(outcome->recovery.bytes_lost, trace.chunks[1].content_bytes);
  EXPECT_EQ(outcome->recovery.messages_lost, 2 * kFramesInAChunk);

  // Only the end of a file: what is left says itself what it is, but has no avatar.
  const auto tail = std::span(trace.bytes).subspan(static_cast<std::size_t>(trace.chunks[2].offset));
  const auto rest = recover(tail);
  ASSERT_TRUE(rest);
  EXPECT_EQ(rest->recovery.messages, 2 * 2 * kFramesInAChunk);
}

TEST(Recover, KeepsADamagedAttachmentUnderANameThatNobodyTakesForTheRealOne) {
  const test::TemporaryFolder folder;
  SmallTrace trace = small_trace(folder, Compression::kZstd);
  const auto glb = test::skeleton_glb(kNodes);
  const auto place = std::search(trace.bytes.begin(), trace.bytes.end(), glb.begin(), glb.end());
  *(place + 30) ^= std::byte{1};
  const auto outcome = recover(trace.bytes);
  ASSERT_TRUE(outcome);
  EXPECT_EQ(outcome->recovery.damaged_attachments, std::vector<std::string>{"avatar.glb"});
  EXPECT_TRUE(outcome->recovery.lost_something());
  const std::string text(reinterpret_cast<const char*>(outcome->bytes.data()), outcome->bytes.size());
  EXPECT_THAT(text, HasSubstr("avatar.glb.damaged"));
}

TEST(Recover, SaysThatASecondFileBehindTheFirstIsLeftOut) {
  const test::TemporaryFolder folder;
  const SmallTrace trace = small_trace(folder, Compression::kZstd);
  std::vector<std::byte> twice = trace.bytes;
  twice.insert(twice.end(), trace.bytes.begin(), trace.bytes.end());
  const auto outcome = recover(twice);
  ASSERT_TRUE(outcome);
  EXPECT_EQ(outcome->recovery.another_file_at, trace.bytes.size());
  EXPECT_EQ(outcome->recovery.bytes_lost, trace.bytes.size());
  EXPECT_TRUE(outcome->recovery.lost_something());
}

TEST(Recover, LeavesOutWhatNoCrcVouchesForAndNobodyCanHaveRecorded) {
  // One chunk, so that no intact frame bounds those of the damaged one.
  const test::TemporaryFolder folder;
  TraceWriterOptions options = test::steady_options(1 << 20);
  options.compression = Compression::kNone;
  test::write_trace(folder / "whole.mcap", kFrames, options);
  const std::vector<std::byte> whole = read_file(folder / "whole.mcap");
  const auto messages = test::message_places(whole);  // pose, colliders, pose, …
  ASSERT_EQ(messages.size(), 2 * kFrames);
  const auto damaged_at = [&](std::size_t frame, auto damage) {
    std::vector<std::byte> bytes = whole;
    damage(bytes, messages[2 * frame]);
    damage(bytes, messages[2 * frame + 1]);
    auto outcome = recover(bytes);
    EXPECT_TRUE(outcome);
    read_frames(*outcome);
    EXPECT_EQ(intact(outcome->frames), kFrames - 1) << frame;
    EXPECT_EQ(outcome->frames.size(), kFrames - 1) << frame;
  };
  for (const std::size_t frame : {std::size_t{0}, std::size_t{7}, std::size_t{kFrames - 1}}) {
    // The frame's number, behind the channel's, in both of its messages.
    damaged_at(frame,
               [](std::vector<std::byte>& bytes, std::uint64_t content) { bytes[content + 2 + 3] = std::byte{0xA0}; });
    // Its time, in the record but not in the message.
    damaged_at(frame, [](std::vector<std::byte>& bytes, std::uint64_t content) {
      bytes[content + 2 + 4 + 4] = std::byte{0x77};
    });
  }
}

TEST(Recover, AFileThatItWroteSaysWhatWasLost) {
  const test::TemporaryFolder folder;
  const SmallTrace trace = small_trace(folder, Compression::kNone);
  std::vector<std::byte> damaged = trace.bytes;
  damaged[trace.chunks[1].offset + 100] ^= std::byte{1};
  const auto outcome = recover(damaged);
  ASSERT_TRUE(outcome);
  ASSERT_GT(outcome->recovery.messages_unverified, 0U);
  const auto said = testing::AllOf(HasSubstr("was recovered from a damaged file"), HasSubstr("not verified by a CRC"));
  const test::MemoryFile file;
  file.assign(outcome->bytes);
  EXPECT_THAT(TraceReader(file.path()).recovered(), said);
  EXPECT_THAT(summarise_mcap(file.path()).recovered, said);
  const mcap::MemorySource source(outcome->bytes);
  const TraceCheck check = check_trace(source, test::go_on);
  EXPECT_THAT(check.problems.kept(), testing::Contains(testing::Field(&mcap::Problem::what, said)));
  EXPECT_EQ(TraceReader(folder / "whole.mcap").recovered(), "");
}

TEST(Recover, KeepsWhatFollowsAMessageWhoseFieldsDoNotFit) {
  const test::TemporaryFolder folder;
  SmallTrace trace = small_trace(folder, Compression::kNone);
  test::shorten_first_message(trace);
  auto outcome = recover(trace.bytes);
  ASSERT_TRUE(outcome);
  read_frames(*outcome);
  EXPECT_EQ(intact(outcome->frames), kFrames - 1);
  EXPECT_EQ(outcome->recovery.bytes_lost, mcap::kRecordHeadBytes + 3);
  EXPECT_EQ(outcome->recovery.messages_left_out, 1U) << "the colliders of the frame that has no pose";
  EXPECT_TRUE(outcome->recovery.lost_something());
}

TEST(Recover, GivesAChannelNoSchemaThatComesAfterItsMessages) {
  mcap::ByteBuffer bytes;
  mcap::append_magic(bytes);
  append_record(bytes, mcap::Header{});
  append_record(bytes,
                mcap::Channel{.id = 1, .schema_id = 7, .topic = "/a", .message_encoding = "json", .metadata = {}});
  append_record(bytes, mcap::Message{.channel_id = 1, .sequence = 0, .log_time = 1, .publish_time = 1, .data = {}});
  mcap::ByteBuffer late;
  append_record(late, mcap::Schema{.id = 7, .name = "late", .encoding = "jsonschema", .data = {}});
  append_record(late, mcap::Message{.channel_id = 1, .sequence = 1, .log_time = 2, .publish_time = 2, .data = {}});
  append_record(bytes, mcap::Chunk{.uncompressed_size = late.size(), .compression = "", .records = late});
  const auto outcome = recover(bytes);
  ASSERT_TRUE(outcome);
  EXPECT_EQ(outcome->recovery.messages, 2U);
  const mcap::MemorySource written(outcome->bytes);
  mcap::StreamReader reader(written);
  mcap::StreamRecord record;
  while (reader.next(record)) EXPECT_NE(record.opcode, mcap::Opcode::kSchema) << "would change what the channel means";
  EXPECT_TRUE(reader.damages().empty());
}

TEST(Recover, FramesFitTheFirstChannelOfPosesWhateverOthersSay) {
  const auto channel = [](std::uint16_t id, const char* nodes) {
    mcap::Channel pose = trace_format::channel_of(trace_format::Stream::kPose);
    pose.id = id;
    pose.metadata["nodes"] = nodes;
    return pose;
  };
  MessageEncoder encoder;
  mcap::ByteBuffer records;
  append_record(records, trace_format::schema_of(trace_format::Stream::kPose));
  append_record(records, channel(5, R"(["a"])"));
  append_record(records, mcap::Message{.channel_id = 5,
                                       .sequence = 0,
                                       .log_time = 0,
                                       .publish_time = 0,
                                       .data = encoder.pose(0, test::frame(0, 1, 0).poses.front())});
  append_record(records, channel(1, R"(["a","b","c"])"));
  append_record(records, mcap::Message{.channel_id = 1,
                                       .sequence = 1,
                                       .log_time = 1,
                                       .publish_time = 1,
                                       .data = encoder.pose(1, test::frame(1, 3, 0).poses.front())});
  const auto outcome = recover(test::file_of_chunk(records, 0));
  ASSERT_TRUE(outcome);
  EXPECT_EQ(outcome->recovery.messages, 1U);
  EXPECT_TRUE(outcome->recovery.lost_something());
  const auto again = recover(outcome->bytes);
  ASSERT_TRUE(again);
  EXPECT_EQ(again->recovery.messages, 1U) << "nor is it lost when the channels are sorted by their numbers";
}

TEST_P(RecoverCompressed, SaysWhatIsLostWithARecordThatIsMadeAnew) {
  const auto with_hole = [&](std::uint64_t begin, std::uint64_t end, std::uint64_t size) {
    std::vector<std::byte> bytes(trace_.bytes.begin(), trace_.bytes.begin() + static_cast<std::ptrdiff_t>(size));
    std::fill(bytes.begin() + static_cast<std::ptrdiff_t>(begin), bytes.begin() + static_cast<std::ptrdiff_t>(end),
              std::byte{0});
    const auto outcome = recover(bytes);
    return outcome ? outcome->recovery.bytes_lost : 0;
  };
  const std::uint64_t index = trace_.chunks[0].end();  // a MessageIndex
  const std::uint64_t chunks = trace_.chunks[2].end() - trace_.chunks[1].offset;
  EXPECT_GE(with_hole(index + mcap::kRecordHeadBytes + 3, trace_.chunks[2].end(), trace_.data_end), chunks);
  EXPECT_GE(with_hole(0, trace_.head_end, trace_.bytes.size()), trace_.head_end);
}

// A fuzzer's finding: what expands to much that is no record kept it busy for half a minute.
TEST(Recover, FindsMessagesBehindMuchThatIsNone) {
  constexpr std::size_t kMuch = std::size_t{8} << 20;
  for (const std::byte garbage : {std::byte{0}, static_cast<std::byte>(mcap::Opcode::kMessage)}) {
    mcap::ByteBuffer records;
    append_record(records, mcap::Channel{.id = 1, .topic = "/a", .message_encoding = "json", .metadata = {}});
    const auto append_message = [&](std::uint32_t number) {
      append_record(
          records,
          mcap::Message{.channel_id = 1, .sequence = number, .log_time = number, .publish_time = number, .data = {}});
    };
    append_message(0);
    append_message(1);  // not believed, for what follows it
    records.insert(records.end(), kMuch, garbage);
    append_message(2);
    const mcap::ByteBuffer bytes = test::file_of_chunk(records, 1);
    const auto outcome = recover(bytes);
    ASSERT_TRUE(outcome);
    EXPECT_EQ(outcome->recovery.messages, 2U);
    EXPECT_EQ(outcome->recovery.messages_unverified, 2U);
  }
}

TEST(Recover, LeavesOutFramesThatComeTwice) {
  const test::TemporaryFolder folder;
  const SmallTrace trace = small_trace(folder, Compression::kZstd);
  std::vector<std::byte> bytes(trace.bytes.begin(), trace.bytes.begin() + static_cast<std::ptrdiff_t>(trace.data_end));
  const mcap::RecordPlace& chunk = trace.chunks.front();
  bytes.insert(bytes.end(), trace.bytes.begin() + static_cast<std::ptrdiff_t>(chunk.offset),
               trace.bytes.begin() + static_cast<std::ptrdiff_t>(chunk.end()));
  auto outcome = recover(bytes);
  ASSERT_TRUE(outcome);
  read_frames(*outcome);
  EXPECT_EQ(intact(outcome->frames), kFrames);
  EXPECT_EQ(outcome->recovery.messages_left_out, 2 * kFramesInAChunk);
}

// A fuzzer's finding: /pose is defined behind messages of it, which wait for those around them.
TEST(Recover, DoesNotChangeLaterWhatItHasWritten) {
  const auto outcome =
      recover(read_file(std::filesystem::path(VESTIGE_SOURCE_DIR) / "tests/fuzz/seeds/trace/late-definition.mcap"));
  ASSERT_TRUE(outcome);
  const auto again = recover(outcome->bytes);
  ASSERT_TRUE(again);
  EXPECT_EQ(again->recovery.messages, outcome->recovery.messages);
  EXPECT_EQ(again->recovery.messages_left_out, 0U);
}

TEST(Recover, WritesSoundFilesOfOthersAsTheyWere) {
  VESTIGE_REQUIRE_DATA(test::data("mcap"));
  for (const auto& file : test::foreign_mcaps()) {
    const auto bytes = read_file(file);
    const auto outcome = recover(bytes);
    ASSERT_TRUE(outcome) << file;
    EXPECT_FALSE(outcome->recovery.lost_something()) << file;
    EXPECT_EQ(test::content_sha256(outcome->bytes), test::content_sha256(bytes)) << file;
  }
}

TEST(Recover, KeepsWhatItCanOfFilesOfOthersThatAreCut) {
  VESTIGE_REQUIRE_DATA(test::data("mcap"));
  for (const char* name : {"multi-zstd", "multi-lz4", "multi-none", "multi-none-unchunked"}) {
    const auto bytes = read_file(test::data(fmt::format("mcap/compressed/{}.mcap", name)));
    std::uint64_t last = 0;
    for (std::size_t length = 64; length < bytes.size(); length += bytes.size() / 40) {
      const auto outcome = recover(std::span(bytes).first(length));
      const std::uint64_t messages = outcome ? outcome->recovery.messages : 0;
      EXPECT_GE(messages, last) << name << " cut at " << length;
      last = messages;
    }
    EXPECT_GT(last, 500U) << name;
  }
}

TEST(Recover, RefusesWhatHoldsNothing) {
  const std::string text = "time_s,id,x,y,z\n0,1,2,3,4\n";
  const mcap::MemorySource source(std::as_bytes(std::span(text)));
  std::vector<std::byte> out;
  EXPECT_THROW(recover_mcap(source, test::into(out), test::go_on), Error);
}

TEST(Recover, StopsWhenAsked) {
  const test::TemporaryFolder folder;
  const SmallTrace trace = small_trace(folder, Compression::kZstd);
  const mcap::MemorySource source(trace.bytes);
  std::vector<std::byte> out;
  EXPECT_THROW(recover_mcap(source, test::into(out), [](double) { return false; }), Error);
}

}  // namespace
}  // namespace vestige
