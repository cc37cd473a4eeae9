// Copies of traces that gain messages beside their frames, as `vestige viz` makes.

#include "traces/repair/trace_copy.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>

#include "tests/support/message_of.hpp"
#include "tests/traces/mcap/mcap_files.hpp"
#include "tests/traces/trace_file/small_trace.hpp"
#include "traces/repair/trace_check.hpp"

namespace vestige {
namespace {

using test::kFrames;
using test::small_trace;
using ::testing::AllOf;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::Ne;
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

TEST(TraceCopy, LeavesOutChannelsWithoutMessages) {
  const test::TemporaryFolder folder;
  const Bytes trace = small_trace(folder, Compression::kZstd).bytes;
  const Bytes once = copy_of(trace, {channel("/one")});
  const mcap::MemorySource source(once);
  Bytes written;
  TraceCopy copy(source, test::into(written), std::vector<AddedChannel>{channel("/one"), channel("/two")});
  copy.finish();
  for (const auto& [id, one] : gather_definitions(mcap::MemorySource(written)).channels)
    EXPECT_THAT(one.topic, AllOf(Ne("/one"), Ne("/two")));
  EXPECT_EQ(test::content_sha256(written), test::content_sha256(trace));
}

TEST(TraceCopy, NotesMessagesOfChannelsThatNothingDefines) {
  mcap::ByteBuffer records;
  append_record(records, mcap::Channel{.id = 1, .schema_id = 0, .topic = "/a", .message_encoding = "", .metadata = {}});
  for (const std::uint16_t id : std::vector<std::uint16_t>{1, 9, 9})
    append_record(records, mcap::Message{.channel_id = id, .data = {}});
  const mcap::ByteBuffer bytes = test::file_of_chunk(records, 0);
  const mcap::MemorySource source(bytes);
  Bytes written;
  TraceCopy copy(source, test::into(written), std::vector<AddedChannel>{channel("/one")});
  copy.finish();
  const mcap::DamageList damages = copy.damages();
  std::vector<std::string> faults;
  for (const mcap::Damage& damage : damages.kept()) faults.push_back(damage.what);
  EXPECT_THAT(faults, Contains(HasSubstr("a Message of channel 9, which is not defined")).Times(1));
  EXPECT_THAT(messages_of(written), SizeIs(1));
}

/// Why a trace of these bytes gets no copy with a channel /one.
std::string refusal_of(const Bytes& bytes) {
  const mcap::MemorySource source(bytes);
  Bytes written;
  TraceCopy copy(source, test::into(written), std::vector<AddedChannel>{channel("/one")});
  return test::message_of([&] { copy.finish(); });
}

TEST(TraceCopy, RefusesDefinitionsThatItCouldNotForesee) {
  mcap::ByteBuffer late;
  append_record(late,
                mcap::Channel{.id = 65535, .schema_id = 0, .topic = "/late", .message_encoding = "", .metadata = {}});
  EXPECT_THAT(refusal_of(test::file_of_chunk(late, 0)), HasSubstr("channel 65535 is defined inside a chunk only"));
  mcap::Schema schema = channel("/one").schema;
  schema.id = 5;
  mcap::ByteBuffer twice;
  mcap::append_magic(twice);
  append_record(twice, mcap::Header{});
  append_record(twice, schema);
  mcap::ByteBuffer other;
  schema.name = "Other";
  append_record(other, schema);
  append_record(twice, mcap::Chunk{.uncompressed_size = other.size(), .compression = "", .records = other});
  EXPECT_THAT(refusal_of(twice), HasSubstr("schema 5 is defined twice, differently"));
}

}  // namespace
}  // namespace vestige
