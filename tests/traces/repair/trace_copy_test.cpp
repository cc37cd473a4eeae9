// Copies of traces that gain messages beside their frames, as `vestige viz` makes.

#include "traces/repair/trace_copy.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>

#include "tests/traces/mcap/mcap_files.hpp"
#include "tests/traces/trace_file/small_trace.hpp"
#include "traces/base/error.hpp"
#include "traces/repair/trace_check.hpp"

namespace vestige {
namespace {

using test::kFrames;
using test::small_trace;
using ::testing::HasSubstr;
using ::testing::SizeIs;

using Bytes = std::vector<std::byte>;

AddedChannel channel(const std::string& topic) {
  return {{.topic = topic, .message_encoding = "json", .metadata = {}},
          {.name = "Note", .encoding = "jsonschema", .data = Bytes(2, std::byte{'a'})}};
}

/// A copy with a message on each added channel in each frame.
Bytes copy_of(const Bytes& bytes, const std::vector<AddedChannel>& added) {
  const mcap::MemorySource source(bytes);
  Bytes written;
  TraceCopy copy(source, test::into(written), added);
  for (std::uint32_t frame = 0; frame < kFrames; ++frame) {
    copy.copy_through(frame);
    for (std::size_t i = 0; i < added.size(); ++i) {
      const std::string note = fmt::format("{}", frame);
      copy.write(i, frame, frame * 1'000'003ULL, std::as_bytes(std::span(note)));
    }
  }
  copy.finish();
  EXPECT_TRUE(copy.damages().empty());
  EXPECT_EQ(copy.bytes_written(), written.size());
  const mcap::MemorySource again(written);
  EXPECT_EQ(check_trace(again, test::go_on).problems.count(), 0U);
  return written;
}

/// "TOPIC SEQUENCE" of each message, in the order of the file.
std::vector<std::string> messages_of(const Bytes& bytes) {
  const mcap::MemorySource source(bytes);
  mcap::StreamReader reader(source);
  mcap::StreamRecord record;
  std::map<std::uint16_t, std::string> topics;
  std::vector<std::string> messages;
  while (reader.next(record)) {
    if (record.opcode == mcap::Opcode::kChannel) {
      const mcap::Channel one = mcap::decode_channel(record.content);
      topics[one.id] = one.topic;
    }
    if (record.opcode != mcap::Opcode::kMessage) continue;
    const mcap::Message message = mcap::decode_message(record.content);
    messages.push_back(fmt::format("{} {}", topics.at(message.channel_id), message.sequence));
  }
  return messages;
}

TEST(TraceCopy, KeepsEverything) {
  const test::TemporaryFolder folder;
  for (const Compression compression : {Compression::kNone, Compression::kLz4, Compression::kZstd}) {
    const auto trace = small_trace(folder, compression);
    EXPECT_EQ(test::content_sha256(copy_of(trace.bytes, {})), test::content_sha256(trace.bytes));
    std::filesystem::remove(folder / "whole.mcap");
  }
}

TEST(TraceCopy, PutsWhatIsAddedBehindTheFrameThatItBelongsTo) {
  const test::TemporaryFolder folder;
  const auto trace = small_trace(folder, Compression::kZstd);
  const std::vector<std::string> before = messages_of(trace.bytes);
  std::vector<std::string> expected;
  for (std::size_t i = 0; i < before.size(); ++i) {
    expected.push_back(before[i]);
    const auto number = [](const std::string& message) { return message.substr(message.rfind(' ')); };
    if (i + 1 < before.size() && number(before[i + 1]) == number(before[i])) continue;
    expected.push_back("/one" + number(before[i]));
    expected.push_back("/two" + number(before[i]));
  }
  EXPECT_EQ(messages_of(copy_of(trace.bytes, {channel("/one"), channel("/two")})), expected);
}

TEST(TraceCopy, ReplacesWhatTheTraceHasOnTheSameTopic) {
  const test::TemporaryFolder folder;
  const Bytes once = copy_of(small_trace(folder, Compression::kZstd).bytes, {channel("/one"), channel("/two")});
  const Bytes again = copy_of(once, {channel("/one"), channel("/two")});
  EXPECT_EQ(messages_of(again), messages_of(once));
  const mcap::MemorySource source(again);
  const Definitions definitions = gather_definitions(source);
  EXPECT_THAT(definitions.channels, SizeIs(gather_definitions(mcap::MemorySource(once)).channels.size()));
}

TEST(TraceCopy, RefusesDefinitionsThatItCouldNotForesee) {
  mcap::ByteBuffer records;
  append_record(records,
                mcap::Channel{.id = 65535, .schema_id = 0, .topic = "/late", .message_encoding = "", .metadata = {}});
  const mcap::ByteBuffer bytes = test::file_of_chunk(records, 0);
  const mcap::MemorySource source(bytes);
  Bytes written;
  const std::vector<AddedChannel> added = {channel("/one")};
  TraceCopy copy(source, test::into(written), added);
  try {
    copy.finish();
    ADD_FAILURE() << "the channel took the messages of another";
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), HasSubstr("channel 65535 is defined inside a chunk only"));
  }
}

}  // namespace
}  // namespace vestige
