// Recordings that last: parts, limits, the ring, chunks brought to disk.

#include "traces/recording/recorder.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <thread>
#include <utility>
#include <vector>

#include "tests/support/test_data.hpp"
#include "tests/traces/trace_file/small_trace.hpp"
#include "tests/traces/trace_file/trace_fixture.hpp"
#include "traces/base/error.hpp"
#include "traces/base/nanoseconds.hpp"
#include "traces/files/input_file.hpp"
#include "traces/mcap/stream_reader.hpp"
#include "traces/recording/recording_thread.hpp"
#include "traces/repair/trace_summary.hpp"
#include "traces/trace_file/message_stream.hpp"
#include "traces/trace_file/trace_messages.hpp"

namespace vestige {
namespace {

using test::kColliders;
using test::kNodes;
using ::testing::ElementsAre;

class RecorderTest : public ::testing::Test {
 protected:
  Recorder::Target target(const RecordingLimits& limits, std::size_t chunk_bytes = 4000) const {
    TraceWriterOptions writing = test::steady_options(chunk_bytes);
    writing.overwrite = overwrite_;
    return {.path = folder_ / "man.mcap",
            .session = {{"argv", "test"}},
            .people = {{avatar_, {.avatar_glb = glb_, .actuator_map_json = "{}"}}},
            .writing = writing,
            .limits = limits};
  }

  /// Records that many frames, or until it is full; returns the files.
  std::vector<std::filesystem::path> record(const RecordingLimits& limits, std::uint64_t frames) const {
    Recorder recorder(target(limits));
    for (std::uint64_t i = 0; i < frames; ++i)
      if (!recorder.write(test::frame(i, kNodes, kColliders))) break;
    recorder.finish();
    return recorder.files();
  }

  static std::vector<std::string> markers(const std::filesystem::path& path) {
    const mcap::FileSource source(path);
    mcap::StreamReader reader(source);
    StreamTable streams;
    MessageDecoder decoder;
    std::vector<std::string> texts;
    for (mcap::StreamRecord record; reader.next(record);) {
      if (record.opcode == mcap::Opcode::kSchema) streams.add(mcap::decode_schema(record.content));
      if (record.opcode == mcap::Opcode::kChannel) streams.add(mcap::decode_channel(record.content));
      if (record.opcode != mcap::Opcode::kMessage) continue;
      const mcap::Message message = mcap::decode_message(record.content);
      if (streams.stream_of(message.channel_id) != trace_format::Stream::kEvents) continue;
      const TraceEvent event = decoder.event(message.data);
      if (event.kind == trace_format::kMarkerKind) texts.emplace_back(event.text);
    }
    return texts;
  }

  /// Reads what must be a whole trace of frames as they were written.
  static std::vector<std::uint64_t> indexes(const std::filesystem::path& path) {
    TraceReader reader(path);
    std::vector<std::uint64_t> indexes;
    for (const TraceFrame& frame : test::read_frames(reader)) {
      EXPECT_TRUE(test::same_bits(frame, test::frame(frame.index, kNodes, kColliders))) << frame.index;
      indexes.push_back(frame.index);
    }
    EXPECT_TRUE(reader.complete()) << path;
    EXPECT_EQ(reader.people().front().actuator_map_json.size(), 2U);
    return indexes;
  }

  const test::TemporaryFolder folder_;
  const Avatar avatar_ = test::skeleton(kNodes);
  const std::vector<std::byte> glb_ = test::skeleton_glb(kNodes);
  Overwrite overwrite_ = Overwrite::kRefuse;
};

std::vector<std::uint64_t> range(std::uint64_t first, std::uint64_t end) {
  std::vector<std::uint64_t> all;
  for (; first < end; ++first) all.push_back(first);
  return all;
}

TEST_F(RecorderTest, WithoutLimitsWritesOneTrace) {
  EXPECT_THAT(record({}, 20), ElementsAre(folder_ / "man.mcap"));
  EXPECT_EQ(indexes(folder_ / "man.mcap"), range(0, 20));
}

TEST_F(RecorderTest, NeverWritesALargerFileThanAllowedAndHardlyASmallerOne) {
  for (const std::uint64_t most : {20'000U, 33'333U, 100'001U}) {
    overwrite_ = Overwrite::kAllow;
    record({.max_bytes = most}, 100'000);
    const auto bytes = std::filesystem::file_size(folder_ / "man.mcap");
    EXPECT_LE(bytes, most);
    EXPECT_GT(bytes, most * 8 / 10);
    const auto frames = indexes(folder_ / "man.mcap");
    EXPECT_EQ(frames, range(0, frames.size()));
  }
}

TEST_F(RecorderTest, SaysWhenNotEvenOneFrameFits) {
  EXPECT_THROW(record({.max_bytes = 900}, 5), Error);
  EXPECT_FALSE(std::filesystem::exists(folder_ / "man.mcap"));
}

TEST_F(RecorderTest, SplitsByTimeIntoWholeTraces) {
  // Frames are 1.000003 ms apart, and parts end at multiples of 10 ms.
  const auto files = record({.split_s = 0.01}, 25);
  ASSERT_THAT(files, ElementsAre(folder_ / "man-0001.mcap", folder_ / "man-0002.mcap", folder_ / "man-0003.mcap"));
  EXPECT_EQ(indexes(files[0]), range(0, 10));
  EXPECT_EQ(indexes(files[1]), range(10, 20));
  EXPECT_EQ(indexes(files[2]), range(20, 25));
}

TEST_F(RecorderTest, PartsMayBeLongerThanAnyTimeThereIs) {
  EXPECT_THAT(record({.split_s = 1e12}, 5), ElementsAre(folder_ / "man-0001.mcap"));
}

TEST_F(RecorderTest, SplitsBySizeWithoutLosingAFrame) {
  for (const RecordingLimits& limits :
       {RecordingLimits{.split_bytes = 20'000}, RecordingLimits{.max_bytes = 20'000, .split_s = 1000.0}}) {
    overwrite_ = Overwrite::kAllow;
    std::vector<std::uint64_t> all;
    const auto files = record(limits, 400);
    EXPECT_GT(files.size(), 3U);
    for (const auto& file : files) {
      EXPECT_LE(std::filesystem::file_size(file), 20'000U);
      const auto part = indexes(file);
      all.insert(all.end(), part.begin(), part.end());
    }
    EXPECT_EQ(all, range(0, 400));
  }
}

TEST_F(RecorderTest, RefusesPartsOfAnEarlierRecordingAndReplacesAllOfThemWhenAllowed) {
  record({.split_s = 0.01}, 45);
  EXPECT_EQ(existing_parts(folder_ / "man.mcap").size(), 5U);
  EXPECT_THROW(record({.split_s = 0.01}, 15), Error);
  overwrite_ = Overwrite::kAllow;
  record({.split_s = 0.01}, 15);
  EXPECT_THAT(existing_parts(folder_ / "man.mcap"), ElementsAre(folder_ / "man-0001.mcap", folder_ / "man-0002.mcap"));
}

TEST_F(RecorderTest, PartsOfAnEarlierRecordingGoBeforeTheNewOneCanBeCutShort) {
  record({.split_s = 0.01}, 45);
  overwrite_ = Overwrite::kAllow;
  Recorder recorder(target({.split_s = 0.01}));
  EXPECT_EQ(existing_parts(folder_ / "man.mcap").size(), 5U) << "without a frame nothing is replaced yet";
  EXPECT_THROW(record({.split_bytes = 100}, 1), Error);
  EXPECT_EQ(existing_parts(folder_ / "man.mcap").size(), 5U) << "not even one frame fits";
  EXPECT_EQ(indexes(folder_ / "man-0001.mcap"), range(0, 10)) << "the earlier one";
  recorder.write(test::frame(0, kNodes, kColliders));
  EXPECT_THAT(existing_parts(folder_ / "man.mcap"), ElementsAre(folder_ / "man-0001.mcap"));
  EXPECT_EQ(recorder.removed().size(), 4U);
}

TEST_F(RecorderTest, WhatOnlyHasTheNameOfAPartIsNotRemoved) {
  std::ofstream(folder_ / "man-0009.mcap") << "thesis";
  overwrite_ = Overwrite::kAllow;
  EXPECT_THROW(record({.split_s = 0.01}, 1), Error);
  EXPECT_EQ(read_text_file(folder_ / "man-0009.mcap"), "thesis");
}

TEST_F(RecorderTest, AnEarlierRecordingStaysUntilAFrameCanReplaceIt) {
  record({}, 10);
  overwrite_ = Overwrite::kAllow;
  EXPECT_THROW(record({.max_bytes = 100}, 1), Error);
  { const Recorder without_frames(target({})); }
  EXPECT_EQ(indexes(folder_ / "man.mcap"), range(0, 10));
  record({}, 5);
  EXPECT_EQ(indexes(folder_ / "man.mcap"), range(0, 5));
}

TEST_F(RecorderTest, ARingKeepsTheLastSecondsOnly) {
  record({.ring_s = 0.01}, 20'000);
  EXPECT_EQ(indexes(folder_ / "man.mcap"), range(19'990, 20'000));
}

TEST_F(RecorderTest, ARingKeepsWhatFitsIntoItsMemory) {
  FrameRing ring({.bytes = std::uint64_t{2} << 20});
  for (std::uint64_t i = 0; i < 50'000; ++i) {
    ring.push(test::frame(i, kNodes, kColliders));
    ASSERT_LE(ring.bytes(), std::uint64_t{3} << 20);
  }
  std::vector<std::uint64_t> kept;
  ring.contents().for_each([](const RecordingNote&) {},
                           [&](const TraceFrame& frame) {
                             kept.push_back(frame.index);
                             return true;
                           });
  ASSERT_GT(kept.size(), 1000U);
  EXPECT_EQ(kept, range(50'000 - kept.size(), 50'000));
}

TEST_F(RecorderTest, ARingKeepsTeleportsAndNotesWithTheirFrames) {
  Recorder recorder(target({.ring_s = 0.0021}));
  for (std::uint64_t i = 0; i < 10; ++i) {
    TraceFrame frame = test::frame(i, kNodes, kColliders);
    frame.teleported = {static_cast<std::uint32_t>(i)};
    recorder.note({.kind = RecordingNote::Kind::kDropped, .count = i, .text = "/pose"});
    recorder.note({.kind = RecordingNote::Kind::kMarker, .text = fmt::format("marker {}", i)});
    recorder.write(frame);
  }
  recorder.finish();
  EXPECT_THAT(markers(folder_ / "man.mcap"), ElementsAre("marker 7", "marker 8", "marker 9"));
  TraceReader reader(folder_ / "man.mcap");
  const auto frames = test::read_frames(reader);
  ASSERT_EQ(frames.size(), 3U);
  for (const TraceFrame& frame : frames) EXPECT_THAT(frame.teleported, ElementsAre(frame.index));
  EXPECT_EQ(reader.dropped(), 8U + 9U) << "that of the first frame stood before what is kept";
}

TEST_F(RecorderTest, ASnapshotOfARingIsATraceOfItsOwn) {
  Recorder recorder(target({.ring_s = 0.01}));
  for (std::uint64_t i = 0; i < 50; ++i) {
    recorder.write(test::frame(i, kNodes, kColliders));
    if (i == 29 || i == 39) recorder.snapshot();
  }
  recorder.finish();
  EXPECT_THAT(recorder.files(),
              ElementsAre(folder_ / "man-0001.mcap", folder_ / "man-0002.mcap", folder_ / "man.mcap"));
  EXPECT_EQ(indexes(folder_ / "man-0001.mcap"), range(20, 30));
  EXPECT_EQ(indexes(folder_ / "man-0002.mcap"), range(30, 40));
  EXPECT_EQ(indexes(folder_ / "man.mcap"), range(40, 50));
}

TEST_F(RecorderTest, ASnapshotThatWasWrittenIsTold) {
  std::vector<std::pair<std::filesystem::path, double>> told;
  Recorder::Target where = target({.ring_s = 0.01});
  where.snapshot_written = [&](const std::filesystem::path& path, double seconds) { told.emplace_back(path, seconds); };
  Recorder recorder(std::move(where));
  const auto frame = [](std::uint64_t i) { return test::frame(i, kNodes, kColliders); };
  for (std::uint64_t i = 0; i < 30; ++i) recorder.write(frame(i));
  recorder.snapshot();
  recorder.finish();
  const double seconds = static_cast<double>(frame(29).time_ns - frame(20).time_ns) / kNanosecondsPerSecond;
  EXPECT_THAT(told, ElementsAre(std::pair(folder_ / "man-0001.mcap", seconds)));
}

TEST_F(RecorderTest, ASnapshotThatFailsIsSaidAndTheRingIsWrittenAllTheSame) {
  overwrite_ = Overwrite::kAllow;
  std::filesystem::create_directory(folder_ / "man-0001.mcap");
  Recorder recorder(target({.ring_s = 0.01}));
  for (std::uint64_t i = 0; i < 50; ++i) recorder.write(test::frame(i, kNodes, kColliders));
  recorder.snapshot();
  EXPECT_THROW(recorder.finish(), Error);
  EXPECT_EQ(indexes(folder_ / "man.mcap"), range(40, 50));
}

TEST_F(RecorderTest, ARingThatIsNeverFinishedIsWrittenAllTheSame) {
  {
    Recorder recorder(target({.ring_s = 0.01}));
    for (std::uint64_t i = 0; i < 50; ++i) recorder.write(test::frame(i, kNodes, kColliders));
  }
  EXPECT_EQ(indexes(folder_ / "man.mcap"), range(40, 50));
}

TEST_F(RecorderTest, DropsAreCountedByTopic) {
  Recorder recorder(target({}));
  recorder.write(test::frame(0, kNodes, kColliders));
  recorder.note({.count = 2, .text = "/pose"});
  recorder.note({.count = 3, .text = "input"});
  recorder.write(test::frame(3, kNodes, kColliders));
  recorder.note({.count = 1, .text = "input"});
  recorder.finish();
  const McapSummary summary = summarise_mcap(folder_ / "man.mcap");
  EXPECT_EQ(summary.dropped, 6U);
  EXPECT_EQ(summary.dropped_by_topic, (std::map<std::string, std::uint64_t>{{"/pose", 2}, {"input", 4}}));
}

TEST_F(RecorderTest, AChunkIsWrittenWhenItIsOldThoughNoFrameComes) {
  Recorder::Target where = target({});
  where.writing.chunk_s = 0.02;
  Recorder recorder(std::move(where));
  RecordingThread thread(recorder);
  for (std::uint64_t i = 0; i < 3; ++i)
    thread.put(test::frame(i, kNodes, kColliders), {}, RecordingThread::WhenBehind::kWait);
  // The source stalls; the trace is looked at while it is still being written.
  std::size_t seen = 0;
  for (int tries = 0; tries < 1000 && seen < 3; ++tries) {
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
    TraceReader reader(folder_ / "man.mcap");
    seen = test::read_frames(reader).size();
  }
  EXPECT_EQ(seen, 3U);
  thread.stop();
  recorder.finish();
}

TEST_F(RecorderTest, ThreadDropsWhatFindsNoRoomAndWaitsForASourceThatCan) {
  Recorder recorder(target({}));
  {
    RecordingThread thread(recorder, 1);  // room for one frame at a time
    std::uint64_t taken = 0;
    std::uint64_t offered = 0;
    while (taken == offered && offered < 1'000'000) {
      ++offered;
      taken += thread.put(test::frame(offered, kNodes, kColliders), {}, RecordingThread::WhenBehind::kDrop) ? 1U : 0U;
    }
    EXPECT_LT(taken, offered);
    for (std::uint64_t i = 1; i <= 100; ++i)
      EXPECT_TRUE(thread.put(test::frame(offered + i, kNodes, kColliders), {}, RecordingThread::WhenBehind::kWait));
    thread.stop();
    EXPECT_EQ(recorder.frame_count(), taken + 100);
  }
  recorder.finish();
}

TEST_F(RecorderTest, ThreadHandsOnWhatFailed) {
  Recorder recorder(target({}));
  RecordingThread thread(recorder);
  thread.put(test::frame(5, kNodes, kColliders), {}, RecordingThread::WhenBehind::kWait);
  thread.put(test::frame(5, kNodes, kColliders), {}, RecordingThread::WhenBehind::kWait);
  EXPECT_THROW(thread.stop(), Error);
}

}  // namespace
}  // namespace vestige
