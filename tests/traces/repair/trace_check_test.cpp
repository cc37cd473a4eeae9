// What `vestige doctor` finds: nothing in sound files, and in broken ones what is wrong, where.

#include "traces/repair/trace_check.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>

#include "tests/support/memory_growth.hpp"
#include "tests/traces/mcap/mcap_files.hpp"
#include "tests/traces/trace_file/forged_trace.hpp"
#include "tests/traces/trace_file/small_trace.hpp"
#include "traces/base/error.hpp"
#include "traces/mcap/encode.hpp"
#include "traces/mcap/summary.hpp"
#include "traces/trace_file/trace_format.hpp"
#include "traces/trace_file/trace_messages.hpp"
#include "traces/trace_file/trace_reader.hpp"

namespace vestige {
namespace {

using mcap::Problem;
using test::kFrames;
using test::small_trace;
using test::SmallTrace;
using ::testing::HasSubstr;
using trace_format::Stream;

TraceCheck check(std::span<const std::byte> bytes) {
  const mcap::MemorySource source(bytes);
  return check_trace(source, test::go_on);
}

std::string text_of(const TraceCheck& check) {
  std::string text;
  for (const Problem& problem : check.problems.kept())
    text += fmt::format("{}+{}: {}; {}\n", problem.offset, problem.bytes, problem.what, problem.consequence);
  return text;
}

bool any(const TraceCheck& check, const std::function<bool(const Problem&)>& predicate) {
  return std::any_of(check.problems.kept().begin(), check.problems.kept().end(), predicate);
}

bool covers(const Problem& problem, std::uint64_t at) {
  return problem.offset <= at && at < problem.offset + problem.bytes;
}

class TraceCheckCompressed : public ::testing::TestWithParam<Compression> {
 protected:
  const test::TemporaryFolder folder_;
  const SmallTrace trace_ = small_trace(folder_, GetParam());
};

TEST_P(TraceCheckCompressed, FindsNothingInASoundTrace) {
  const TraceCheck result = check(trace_.bytes);
  EXPECT_EQ(result.problems.count(), 0U) << text_of(result);
  EXPECT_TRUE(result.is_trace);
  EXPECT_TRUE(result.readable());
  EXPECT_EQ(result.frames, kFrames);
  EXPECT_EQ(result.container.chunks, trace_.chunks.size());
}

TEST_P(TraceCheckCompressed, NamesWhereAFileIsCut) {
  for (std::size_t length = 1; length < trace_.bytes.size(); length += test::kByteStep) {
    const TraceCheck result = check(std::span(trace_.bytes).first(length));
    // The last problem that leads to the end, or stands at it.
    EXPECT_TRUE(any(result, [&](const Problem& problem) { return problem.offset + problem.bytes == length; }))
        << length << "\n"
        << text_of(result);
    EXPECT_EQ(result.readable(), length >= trace_.chunks.front().end()) << length << "\n" << text_of(result);
  }
}

TEST_P(TraceCheckCompressed, NamesEveryFlippedByte) {
  const test::MemoryGrowth growth;
  for (std::size_t at = 0; at < trace_.bytes.size(); at += test::kByteStep) {
    for (const int flip : {0x01, 0xFF}) {
      std::vector<std::byte> damaged = trace_.bytes;
      damaged[at] ^= static_cast<std::byte>(flip);
      const TraceCheck result = check(damaged);
      ASSERT_TRUE(any(result, [&](const Problem& problem) { return covers(problem, at); })) << at << "\n"
                                                                                            << text_of(result);
      EXPECT_TRUE(result.readable()) << at;
      for (const mcap::RecordPlace& chunk : trace_.chunks) {
        if (at <= chunk.offset || at >= chunk.end()) continue;
        // Compressed data has bits that mean nothing.
        if (GetParam() != Compression::kNone && result.container.damaged_chunks == 0 && result.frames == kFrames)
          continue;
        EXPECT_TRUE(any(result,
                        [&](const Problem& problem) {
                          return problem.offset == chunk.offset || problem.offset == chunk.offset + 1;
                        }))
            << at << "\n"
            << text_of(result);
      }
    }
  }
  if (test::kMeasuresMemory) {
    EXPECT_LT(growth.kibibytes(), 64 << 10);
  }
}

INSTANTIATE_TEST_SUITE_P(Compressions, TraceCheckCompressed,
                         ::testing::Values(Compression::kNone, Compression::kLz4, Compression::kZstd));

TEST(TraceCheck, NamesASecondFileBehindTheFirstAndHowToReadIt) {
  const test::TemporaryFolder folder;
  const SmallTrace trace = small_trace(folder, Compression::kZstd);
  std::vector<std::byte> twice = trace.bytes;
  twice.insert(twice.end(), trace.bytes.begin(), trace.bytes.end());
  const TraceCheck result = check(twice);
  ASSERT_EQ(result.problems.count(), 1U) << text_of(result);
  const Problem& problem = result.problems.kept().front();
  EXPECT_EQ(problem.offset, trace.bytes.size());
  EXPECT_THAT(problem.what, HasSubstr("second MCAP file"));
  EXPECT_THAT(problem.consequence, HasSubstr(std::to_string(trace.bytes.size() + 1)));
}

TEST(TraceCheck, ATraceWithoutAFrameCannotBeReplayed) {
  const test::TemporaryFolder folder;
  test::write_trace(folder / "empty.mcap", 0, test::steady_options(1200));
  const TraceCheck result = check(read_file(folder / "empty.mcap"));
  EXPECT_EQ(result.problems.count(), 1U) << text_of(result);
  EXPECT_FALSE(result.readable());
}

TEST(TraceCheck, FindsNothingInSoundFilesOfOthers) {
  VESTIGE_REQUIRE_DATA(test::data("mcap"));
  int count = 0;
  for (const auto& file : test::foreign_mcaps()) {
    const TraceCheck result = check(read_file(file));
    EXPECT_EQ(result.problems.count(), 0U) << file << "\n" << text_of(result);
    EXPECT_FALSE(result.is_trace) << file;
    ++count;
  }
  EXPECT_EQ(count, 420);
}

TEST(TraceCheck, SaysThatNothingCanBeReadInWhatIsNoMcapFile) {
  const std::string text = "time_s,id,x,y,z\n0,1,2,3,4\n";
  const TraceCheck result = check(std::as_bytes(std::span(text)));
  EXPECT_GT(result.problems.count(), 0U);
  EXPECT_FALSE(result.readable());
  EXPECT_FALSE(result.container.begins_as_mcap);
}

TEST(TraceCheck, NamesAMessageOfAnUnknownChannelWithItsPlaceInTheChunk) {
  test::ForgedTrace trace;
  trace.frame(0, 0);
  trace.message(9, 0, 0, {});
  const TraceCheck result = check(trace.finished());
  ASSERT_EQ(result.problems.count(), 1U) << text_of(result);
  const Problem& problem = result.problems.kept().front();
  EXPECT_THAT(problem.what, HasSubstr("channel 9 is not defined"));
  EXPECT_GT(problem.offset, 0U);
  ASSERT_TRUE(problem.offset_in_chunk);
  EXPECT_GT(*problem.offset_in_chunk, 0U);
  EXPECT_EQ(result.frames, 1U);
}

TEST(TraceCheck, GoesOnBehindARecordWhoseFieldsDoNotFit) {
  mcap::ByteBuffer records = {static_cast<std::byte>(mcap::Opcode::kMessage), std::byte{3}};
  records.resize(mcap::kRecordHeadBytes + 3);
  append_record(records, mcap::Channel{.id = 1, .topic = "/a", .message_encoding = "json", .metadata = {}});
  append_record(records, mcap::Message{.channel_id = 1, .sequence = 0, .log_time = 0, .publish_time = 0, .data = {}});
  const mcap::ByteBuffer bytes = test::file_of_chunk(records, 0);
  const TraceCheck result = check(bytes);
  EXPECT_THAT(text_of(result), HasSubstr("it is skipped"));
  EXPECT_EQ(result.container.messages, 1U);
}

TEST(TraceCheck, NamesFramesThatContradictAvatarAndEachOther) {
  const auto only = [](const std::function<void(test::ForgedTrace&)>& forge) {
    test::ForgedTrace trace;
    trace.frame(0, 0);
    trace.frame(1, 10);
    forge(trace);
    const TraceCheck result = check(trace.finished());
    EXPECT_EQ(result.problems.count(), 1U) << text_of(result);
    EXPECT_TRUE(result.readable());
    return result.problems.count() == 0 ? std::string() : result.problems.kept().front().what;
  };
  EXPECT_THAT(only([](test::ForgedTrace& trace) { trace.pose(2, 20, 4); }),
              HasSubstr("its pose has 4 nodes, but the avatar has 3"));
  EXPECT_THAT(only([](test::ForgedTrace& trace) { trace.frame(2, 9); }),
              HasSubstr("its time, 9 ns, is earlier than that of the frame before"));
  EXPECT_THAT(only([](test::ForgedTrace& trace) { trace.frame(0, 20); }), HasSubstr("frame 0 comes after frame 1"));
  EXPECT_THAT(only([](test::ForgedTrace& trace) { trace.pose(1, 10); }), HasSubstr("frame 1 has two poses"));
  EXPECT_THAT(only([](test::ForgedTrace& trace) { trace.frame(5, 20); }), HasSubstr("frames 2 to 4 are missing"));
  EXPECT_THAT(only([](test::ForgedTrace& trace) { trace.colliders(2, 20, {}); }), HasSubstr("frame 2 has no pose"));
  EXPECT_THAT(only([](test::ForgedTrace& trace) {
                trace.pose(2, 20);
                trace.colliders(2, 20, {{.id = 7}, {.id = 8}, {.id = 7}});
              }),
              HasSubstr("it has collider 7 twice"));
  EXPECT_THAT(only([](test::ForgedTrace& trace) { trace.message(1, 2, 20, {}); }), HasSubstr("not a valid FlatBuffer"));
  EXPECT_THAT(only([](test::ForgedTrace& trace) { trace.dropped(1, 12); }),
              HasSubstr("12 messages of /pose were dropped"));
  EXPECT_THAT(only([](test::ForgedTrace& trace) { trace.pose(2, 20); }),
              HasSubstr("frame 2 has no message of /colliders"));
}

/// What `doctor` and a reader say of the same file.
void expect_agreement(const std::vector<std::byte>& bytes, std::uint64_t problems) {
  const TraceCheck result = check(bytes);
  EXPECT_EQ(result.problems.count(), problems) << text_of(result);
  test::MemoryFile file;
  file.assign(bytes);
  TraceReader reader(file.path());
  std::uint64_t frames = 0;
  bool refused = false;
  try {
    for (TraceFrame frame; reader.next(frame);) ++frames;
  } catch (const Error&) {
    refused = true;
  }
  EXPECT_EQ(result.frames, frames) << text_of(result);
  EXPECT_EQ(text_of(result).find("refuses the file") != std::string::npos, refused) << text_of(result);
  EXPECT_EQ(reader.complete() && !refused, problems == 0) << text_of(result);
}

TEST(TraceCheck, AgreesWithReadersAboutWhatAFrameIs) {
  const auto agree = [](std::uint64_t problems, const std::function<void(test::ForgedTrace&)>& forge) {
    test::ForgedTrace trace;
    trace.frame(0, 0);
    forge(trace);
    expect_agreement(trace.finished(), problems);
  };
  {
    SCOPED_TRACE("an event of another frame between a frame's parts");
    agree(2, [](test::ForgedTrace& trace) {
      trace.pose(1, 1);
      trace.message(3, 2, 2, MessageEncoder().event({.kind = "marker", .text = "here"}));
      trace.colliders(1, 1, {});
    });
  }
  {
    SCOPED_TRACE("an event that does not decode behind a pose that does not");
    agree(2, [](test::ForgedTrace& trace) {
      trace.message(1, 1, 1, {});
      trace.message(3, 1, 1, {});
    });
  }
  {
    SCOPED_TRACE("a pose that does not decode before one that does");
    agree(1, [](test::ForgedTrace& trace) {
      trace.message(1, 1, 1, {});
      trace.frame(1, 1);
    });
  }
  {
    SCOPED_TRACE("a frame without a pose between others");
    agree(1, [](test::ForgedTrace& trace) {
      trace.colliders(5, 5, {});
      trace.frame(1, 6);
    });
  }
  {
    SCOPED_TRACE("colliders that do not decode");
    agree(1, [](test::ForgedTrace& trace) {
      trace.pose(1, 1);
      trace.message(2, 1, 1, {});
    });
  }
}

TEST(TraceCheck, SaysOfBytesBehindTheEndThatNothingIsMissing) {
  test::ForgedTrace trace;
  trace.frame(0, 0);
  std::vector<std::byte> bytes = trace.finished();
  bytes.resize(bytes.size() + 5);
  const TraceCheck result = check(bytes);
  ASSERT_EQ(result.problems.count(), 1U) << text_of(result);
  EXPECT_THAT(text_of(result),
              HasSubstr("the file ends here; more bytes follow, which are not read; readers may refuse"));
}

TEST(TraceCheck, TimeDoesNotGrowWithRepeatedDefinitionsAndOffsets) {
  mcap::ByteBuffer bytes;
  mcap::append_magic(bytes);
  append_record(bytes, mcap::Header{});
  append_record(bytes, mcap::Schema{.id = 1, .name = "a", .encoding = "", .data = std::vector<std::byte>(16 << 20)});
  for (int i = 0; i < 100'000; ++i) append_record(bytes, mcap::Schema{.id = 1, .name = "", .encoding = "", .data = {}});
  append_record(bytes, mcap::DataEnd{});
  for (int i = 0; i < 100'000; ++i) {
    append_record(bytes, mcap::SummaryOffset{.group_start = 1, .group_length = 1});
    append_record(bytes, mcap::Statistics{});
  }
  append_record(bytes, mcap::Footer{});
  mcap::append_magic(bytes);
  // Minutes, if each were compared with all others.
  EXPECT_GT(check(bytes).problems.count(), 200'000U);
}

TEST(TraceCheck, CountsTheFramesUpToWhereReadersStop) {
  test::ForgedTrace trace;
  for (const std::uint32_t sequence : {0U, 1U, 1U, 2U, 3U}) trace.frame(sequence, sequence);
  const TraceCheck result = check(trace.finished());
  EXPECT_THAT(text_of(result), HasSubstr("`vestige replay` refuses the file"));
  EXPECT_EQ(result.frames, 1U) << "frame 1 is there twice";
}

TEST(TraceCheck, NamesOfTopicsThatWereDroppedMayBeAnything) {
  test::ForgedTrace trace;
  trace.frame(0, 0);
  const std::string name(1 << 20, 'x');
  for (std::uint32_t i = 0; i < 20; ++i) trace.dropped(0, 1, name);
  const TraceCheck result = check(trace.finished());
  EXPECT_EQ(result.dropped, 20U);
  EXPECT_LT(result.problems.kept().front().what.size(), 1000U);
}

TEST(TraceCheck, CountsProblemsWithoutEndAndKeepsTheFirst) {
  test::ForgedTrace trace;
  trace.frame(0, 0);
  for (std::uint32_t i = 0; i < 3000; ++i) trace.message(9, i, i, {});
  const TraceCheck result = check(trace.finished());
  EXPECT_EQ(result.problems.count(), 3000U);
  EXPECT_EQ(result.problems.kept().size(), mcap::ProblemList::kMostKept);
}

/// A sound file whose summary is written anew, with one record changed and a CRC that holds.
std::vector<std::byte> with_other_summary(const SmallTrace& trace, const std::function<void(mcap::Summary&)>& change) {
  const mcap::MemorySource source(trace.bytes);
  mcap::Summary summary = *mcap::read_summary(source).summary;
  change(summary);
  mcap::ByteBuffer bytes(trace.bytes.begin(),
                         trace.bytes.begin() + static_cast<std::ptrdiff_t>(summary.data_section_end));
  for (const mcap::ChunkIndex& index : summary.chunk_indexes) append_record(bytes, index);
  append_record(bytes, *summary.statistics);
  append_record(bytes, mcap::Footer{.summary_start = summary.data_section_end});
  mcap::append_magic(bytes);
  return bytes;
}

TEST(TraceCheck, NamesAnIndexThatContradictsTheData) {
  const test::TemporaryFolder folder;
  const SmallTrace trace = small_trace(folder, Compression::kZstd);
  const auto finding = [&](const std::function<void(mcap::Summary&)>& change) {
    const TraceCheck result = check(with_other_summary(trace, change));
    EXPECT_EQ(result.frames, kFrames);
    return text_of(result);
  };
  EXPECT_EQ(finding([](mcap::Summary&) {}), "");
  EXPECT_THAT(finding([](mcap::Summary& summary) { ++summary.chunk_indexes[1].message_end_time; }),
              HasSubstr("ChunkIndex: says that message_end_time is"));
  EXPECT_THAT(finding([](mcap::Summary& summary) { summary.chunk_indexes[1].chunk_start_offset += 1; }),
              HasSubstr("but no Chunk begins there"));
  EXPECT_THAT(finding([](mcap::Summary& summary) { summary.chunk_indexes.pop_back(); }),
              HasSubstr(fmt::format("{}+{}: Chunk: no index lists it", trace.chunks.back().offset,
                                    trace.chunks.back().end() - trace.chunks.back().offset)));
  EXPECT_THAT(finding([](mcap::Summary& summary) { ++summary.statistics->message_count; }),
              HasSubstr("Statistics: says that message_count is 33, but it is 32"));
}

TEST(TraceCheck, NamesAMessageIndexThatContradictsItsChunk) {
  const test::TemporaryFolder folder;
  const SmallTrace trace = small_trace(folder, Compression::kZstd);
  std::vector<std::byte> bytes = trace.bytes;
  // The first entry's time: behind head, channel and length of the list.
  const std::uint64_t index = trace.chunks.front().end();
  bytes[index + mcap::kRecordHeadBytes + 2 + 4] ^= std::byte{1};
  EXPECT_THAT(text_of(check(bytes)), HasSubstr(fmt::format("{}+", index)));
  EXPECT_THAT(text_of(check(bytes)), HasSubstr("MessageIndex: lists a message at time 1 and offset 0"));
}

}  // namespace
}  // namespace vestige
