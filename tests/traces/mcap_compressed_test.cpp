// Files of 600 messages, not in order of time, in six channels: uncompressed, lz4, zstd, and without chunks.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "tests/support/test_data.hpp"
#include "traces/mcap/indexed_reader.hpp"
#include "traces/mcap/stream_reader.hpp"
#include "traces/sha256.hpp"

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

INSTANTIATE_TEST_SUITE_P(Files, McapCompressed,
                         ::testing::Values("multi-zstd", "multi-lz4", "multi-none", "multi-none-unchunked"),
                         [](const auto& file) {
                           std::string name = file.param;
                           std::erase(name, '-');
                           return name;
                         });

}  // namespace
}  // namespace vestige::mcap
