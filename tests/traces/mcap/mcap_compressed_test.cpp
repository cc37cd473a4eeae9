// Files of 600 messages, not in order of time, in six channels: uncompressed, lz4, zstd, and without chunks.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "tests/support/test_data.hpp"
#include "traces/base/sha256.hpp"
#include "traces/mcap/indexed_reader.hpp"
#include "traces/mcap/stream_reader.hpp"
#include "traces/mcap/writer.hpp"

namespace vestige::mcap {
namespace {

class McapCompressed : public ::testing::TestWithParam<const char*> {
 protected:
  std::filesystem::path file() const { return test::data(fmt::format("mcap/compressed/{}.mcap", GetParam())); }
  nlohmann::json expected() const {
    return nlohmann::json::parse(
        std::ifstream(test::data(fmt::format("mcap/compressed/{}.expected.json", GetParam()))));
  }
};

TEST_P(McapCompressed, StreamsEveryRecordAndEveryMessageBitForBit) {
  VESTIGE_REQUIRE_DATA(file());
  const FileSource source(file());
  StreamReader reader(source, ChunkHandling::kExpand);
  std::map<std::string, int> types;
  Sha256 sha;
  StreamRecord record;
  while (reader.next(record)) {
    ++types[std::string(name_of(record.opcode))];
    if (record.opcode != Opcode::kMessage) continue;
    const Message message = decode_message(record.content);
    const std::string head =
        fmt::format("{},{},{},{},", message.channel_id, message.sequence, message.log_time, message.publish_time);
    sha.update(std::as_bytes(std::span(head)));
    sha.update(message.data);
  }
  EXPECT_TRUE(reader.damages().empty());
  EXPECT_EQ(nlohmann::json(types), expected()["types"]);
  EXPECT_EQ(sha.hex(), expected()["message_stream_sha256"]);
}

TEST_P(McapCompressed, IndexesTheMessagesByTime) {
  VESTIGE_REQUIRE_DATA(file());
  const FileSource source(file());
  IndexedReader reader(source);
  Message message;
  std::uint64_t count = 0;
  std::uint64_t last = 0;
  while (reader.next(message)) {
    EXPECT_GE(message.log_time, last);
    last = message.log_time;
    ++count;
  }
  // Messages outside chunks have no index.
  EXPECT_EQ(count, reader.summary().chunk_indexes.empty() ? 0U : 600U);
}

TEST(McapWriter, GivesAChunkTheTimesOfItsEarliestAndLatestMessage) {
  std::vector<std::byte> written;
  Writer writer([&](Bytes bytes) { written.insert(written.end(), bytes.begin(), bytes.end()); }, {}, {});
  writer.write(Channel{.id = 1, .schema_id = 0, .topic = "t", .message_encoding = "", .metadata = {}});
  for (const std::uint64_t time : {5U, 9U, 2U, 7U})
    writer.write(Message{.channel_id = 1, .sequence = 0, .log_time = time, .publish_time = 0, .data = {}});
  writer.close_chunk();
  writer.write(Message{.channel_id = 1, .sequence = 0, .log_time = 3, .publish_time = 0, .data = {}});
  writer.finish();

  const MemorySource source(written);
  IndexedReader reader(source);
  ASSERT_EQ(reader.summary().chunk_indexes.size(), 2U);
  EXPECT_EQ(reader.summary().chunk_indexes[0].message_start_time, 2U);
  EXPECT_EQ(reader.summary().chunk_indexes[0].message_end_time, 9U);
  EXPECT_EQ(reader.summary().chunk_indexes[1].message_start_time, 3U);
  EXPECT_EQ(reader.summary().chunk_indexes[1].message_end_time, 3U);
  EXPECT_EQ(reader.summary().statistics->message_start_time, 2U);
  EXPECT_EQ(reader.summary().statistics->message_end_time, 9U);
  std::vector<std::uint64_t> times;
  Message message;
  while (reader.next(message)) times.push_back(message.log_time);
  EXPECT_EQ(times, (std::vector<std::uint64_t>{2, 3, 5, 7, 9}));
}

INSTANTIATE_TEST_SUITE_P(Files, McapCompressed,
                         ::testing::Values("multi-zstd", "multi-lz4", "multi-none", "multi-none-unchunked"),
                         [](const auto& file) {
                           std::string name = file.param;
                           std::erase(name, '-');
                           return name;
                         });

}  // namespace
}  // namespace vestige::mcap
