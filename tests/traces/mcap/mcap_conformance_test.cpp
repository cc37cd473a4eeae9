// MCAP's own conformance set: what the reference writers of foxglove/mcap produce, with every combination of optional
// features. The expected JSON lists every record; layout in the data folder's README.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>

#include "tests/support/test_data.hpp"
#include "traces/files/input_file.hpp"
#include "traces/mcap/indexed_reader.hpp"
#include "traces/mcap/stream_reader.hpp"
#include "traces/mcap/writer.hpp"

namespace vestige::mcap {
namespace {

using Json = nlohmann::json;

std::filesystem::path folder() {
  return test::data("mcap/conformance");
}

std::vector<std::filesystem::path> cases() {
  std::vector<std::filesystem::path> all;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder())) {
    if (entry.path().extension() == ".mcap") all.push_back(entry.path());
  }
  std::sort(all.begin(), all.end());
  return all;
}

Json expected_of(const std::filesystem::path& file) {
  return Json::parse(std::ifstream(std::filesystem::path(file).replace_extension(".json")));
}

std::set<std::string> features_of(const Json& expected) {
  return expected["meta"]["variant"]["features"].get<std::set<std::string>>();
}

// Our records in the form of the expected JSON.

template <typename Number>
Json decimal(Number number) {
  return std::to_string(number);
}

Json byte_list(Bytes bytes) {
  Json list = Json::array();
  for (const std::byte byte : bytes) list.push_back(std::to_string(std::to_integer<int>(byte)));
  return list;
}

Json number_map(const std::map<std::uint16_t, std::uint64_t>& map) {
  Json object = Json::object();
  for (const auto& [key, value] : map) object[std::to_string(key)] = std::to_string(value);
  return object;
}

Json record_json(const char* type, const std::map<std::string, Json>& fields) {
  Json list = Json::array();
  for (const auto& [name, value] : fields) list.push_back({name, value});
  return {{"type", type}, {"fields", list}};
}

Json to_json(const Schema& schema) {
  return record_json("Schema", {{"id", decimal(schema.id)},
                                {"name", schema.name},
                                {"encoding", schema.encoding},
                                {"data", byte_list(schema.data)}});
}

Json to_json(const Channel& channel) {
  return record_json("Channel", {{"id", decimal(channel.id)},
                                 {"schema_id", decimal(channel.schema_id)},
                                 {"topic", channel.topic},
                                 {"message_encoding", channel.message_encoding},
                                 {"metadata", channel.metadata}});
}

Json to_json(const Message& message) {
  return record_json("Message", {{"channel_id", decimal(message.channel_id)},
                                 {"sequence", decimal(message.sequence)},
                                 {"log_time", decimal(message.log_time)},
                                 {"publish_time", decimal(message.publish_time)},
                                 {"data", byte_list(message.data)}});
}

Json to_json(const Statistics& statistics) {
  return record_json("Statistics", {{"message_count", decimal(statistics.message_count)},
                                    {"schema_count", decimal(statistics.schema_count)},
                                    {"channel_count", decimal(statistics.channel_count)},
                                    {"attachment_count", decimal(statistics.attachment_count)},
                                    {"metadata_count", decimal(statistics.metadata_count)},
                                    {"chunk_count", decimal(statistics.chunk_count)},
                                    {"message_start_time", decimal(statistics.message_start_time)},
                                    {"message_end_time", decimal(statistics.message_end_time)},
                                    {"channel_message_counts", number_map(statistics.channel_message_counts)}});
}

Json to_json(const ChunkIndex& index) {
  return record_json("ChunkIndex", {{"message_start_time", decimal(index.message_start_time)},
                                    {"message_end_time", decimal(index.message_end_time)},
                                    {"chunk_start_offset", decimal(index.chunk_start_offset)},
                                    {"chunk_length", decimal(index.chunk_length)},
                                    {"message_index_offsets", number_map(index.message_index_offsets)},
                                    {"message_index_length", decimal(index.message_index_length)},
                                    {"compression", index.compression},
                                    {"compressed_size", decimal(index.compressed_size)},
                                    {"uncompressed_size", decimal(index.uncompressed_size)}});
}

Json to_json(const Attachment& attachment) {
  return record_json("Attachment", {{"log_time", decimal(attachment.log_time)},
                                    {"create_time", decimal(attachment.create_time)},
                                    {"name", attachment.name},
                                    {"media_type", attachment.media_type},
                                    {"data", byte_list(attachment.data)}});
}

Json to_json(const AttachmentIndex& index) {
  return record_json("AttachmentIndex", {{"offset", decimal(index.offset)},
                                         {"length", decimal(index.length)},
                                         {"log_time", decimal(index.log_time)},
                                         {"create_time", decimal(index.create_time)},
                                         {"data_size", decimal(index.data_size)},
                                         {"name", index.name},
                                         {"media_type", index.media_type}});
}

Json to_json(const StreamRecord& record) {
  const Bytes content = record.content;
  switch (record.opcode) {
    case Opcode::kHeader: {
      const Header header = decode_header(content);
      return record_json("Header", {{"profile", header.profile}, {"library", header.library}});
    }
    case Opcode::kFooter: {
      const Footer footer = decode_footer(content);
      return record_json("Footer", {{"summary_start", decimal(footer.summary_start)},
                                    {"summary_offset_start", decimal(footer.summary_offset_start)},
                                    {"summary_crc", decimal(footer.summary_crc)}});
    }
    case Opcode::kMetadata: {
      const Metadata metadata = decode_metadata(content);
      return record_json("Metadata", {{"name", metadata.name}, {"metadata", metadata.metadata}});
    }
    case Opcode::kMetadataIndex: {
      const MetadataIndex index = decode_metadata_index(content);
      return record_json("MetadataIndex",
                         {{"offset", decimal(index.offset)}, {"length", decimal(index.length)}, {"name", index.name}});
    }
    case Opcode::kSummaryOffset: {
      const SummaryOffset offset = decode_summary_offset(content);
      return record_json("SummaryOffset", {{"group_opcode", decimal(static_cast<int>(offset.group_opcode))},
                                           {"group_start", decimal(offset.group_start)},
                                           {"group_length", decimal(offset.group_length)}});
    }
    case Opcode::kDataEnd:
      return record_json("DataEnd", {{"data_section_crc", decimal(decode_data_end(content).data_section_crc)}});
    case Opcode::kSchema:
      return to_json(decode_schema(content));
    case Opcode::kChannel:
      return to_json(decode_channel(content));
    case Opcode::kMessage:
      return to_json(decode_message(content));
    case Opcode::kChunkIndex:
      return to_json(decode_chunk_index(content));
    case Opcode::kAttachment:
      return to_json(decode_attachment(content));
    case Opcode::kAttachmentIndex:
      return to_json(decode_attachment_index(content));
    case Opcode::kStatistics:
      return to_json(decode_statistics(content));
    case Opcode::kChunk:
    case Opcode::kMessageIndex:
      break;
  }
  return {{"type", "unexpected"}};
}

TEST(McapConformance, TheStreamReaderReadsEveryCase) {
  VESTIGE_REQUIRE_DATA(folder());
  int count = 0;
  for (const auto& file : cases()) {
    const auto bytes = read_file(file);
    const MemorySource source(bytes);
    StreamReader reader(source);
    Json records = Json::array();
    StreamRecord record;
    while (reader.next(record)) {
      if (record.opcode != Opcode::kMessageIndex) records.push_back(to_json(record));
    }
    EXPECT_EQ(records, expected_of(file)["records"]) << file;
    EXPECT_TRUE(reader.damages().empty()) << file << ": " << reader.damages().kept().front().what;
    EXPECT_TRUE(reader.footer_seen()) << file;
    ++count;
  }
  EXPECT_EQ(count, 416);
}

TEST(McapConformance, TheIndexedReaderReadsEveryCaseThatHasAnIndex) {
  VESTIGE_REQUIRE_DATA(folder());
  int count = 0;
  for (const auto& file : cases()) {
    const Json expected = expected_of(file);
    const auto features = features_of(expected);
    const auto& records = expected["records"];
    const bool has_messages =
        std::any_of(records.begin(), records.end(), [](const Json& record) { return record["type"] == "Message"; });
    constexpr std::array kNeeded = {"ch", "chx", "mx", "rch", "rsh"};
    const bool indexed =
        std::all_of(kNeeded.begin(), kNeeded.end(), [&](const char* feature) { return features.contains(feature); });
    if (!has_messages || !indexed) continue;

    std::map<std::string, std::vector<Json>> wanted;
    for (const Json& record : records) wanted[record["type"]].push_back(record);
    const auto time_of = [](const Json& message) {
      for (const Json& field : message["fields"]) {
        if (field[0] == "log_time") return std::stoull(field[1].get<std::string>());
      }
      return 0ULL;
    };
    std::stable_sort(wanted["Message"].begin(), wanted["Message"].end(),
                     [&](const Json& a, const Json& b) { return time_of(a) < time_of(b); });

    const auto bytes = read_file(file);
    const MemorySource source(bytes);
    IndexedReader reader(source);
    std::vector<Json> messages;
    Message message;
    while (reader.next(message)) messages.push_back(to_json(message));
    EXPECT_EQ(messages, wanted["Message"]) << file;
    EXPECT_TRUE(reader.damages().empty()) << file;
    // In the file schemas and channels stand twice: in the data and in the summary.
    ASSERT_EQ(reader.summary().schemas.size() * 2, wanted["Schema"].size()) << file;
    ASSERT_EQ(reader.summary().channels.size() * 2, wanted["Channel"].size()) << file;
    for (std::size_t i = 0; i < reader.summary().schemas.size(); ++i)
      EXPECT_EQ(to_json(reader.summary().schemas[i]), wanted["Schema"][i]) << file;
    for (std::size_t i = 0; i < reader.summary().channels.size(); ++i)
      EXPECT_EQ(to_json(reader.summary().channels[i]), wanted["Channel"][i]) << file;
    ASSERT_EQ(reader.summary().statistics.has_value(), features.contains("st")) << file;
    if (features.contains("st")) {
      EXPECT_EQ(to_json(*reader.summary().statistics), wanted["Statistics"][0]) << file;
    }
    ++count;
  }
  EXPECT_EQ(count, 16);
}

// What the writer is given: the records of the data section, from the expected JSON.

class Fields {
 public:
  explicit Fields(const Json& record) {
    for (const Json& field : record["fields"]) fields_[field[0]] = field[1];
  }
  std::string text(const char* name) const { return fields_.at(name).get<std::string>(); }
  template <typename Number>
  Number number(const char* name) const {
    return static_cast<Number>(std::stoull(text(name)));
  }
  StringMap map(const char* name) const { return fields_.at(name).get<StringMap>(); }
  std::vector<std::byte> bytes(const char* name) const {
    std::vector<std::byte> result;
    for (const Json& value : fields_.at(name))
      result.push_back(static_cast<std::byte>(std::stoi(value.get<std::string>())));
    return result;
  }

 private:
  std::map<std::string, Json> fields_;
};

void write_record(Writer& writer, const std::string& type, const Fields& fields) {
  if (type == "Schema") {
    writer.write(Schema{.id = fields.number<std::uint16_t>("id"),
                        .name = fields.text("name"),
                        .encoding = fields.text("encoding"),
                        .data = fields.bytes("data")});
  } else if (type == "Channel") {
    writer.write(Channel{.id = fields.number<std::uint16_t>("id"),
                         .schema_id = fields.number<std::uint16_t>("schema_id"),
                         .topic = fields.text("topic"),
                         .message_encoding = fields.text("message_encoding"),
                         .metadata = fields.map("metadata")});
  } else if (type == "Message") {
    const auto data = fields.bytes("data");
    writer.write(Message{.channel_id = fields.number<std::uint16_t>("channel_id"),
                         .sequence = fields.number<std::uint32_t>("sequence"),
                         .log_time = fields.number<std::uint64_t>("log_time"),
                         .publish_time = fields.number<std::uint64_t>("publish_time"),
                         .data = data});
  } else if (type == "Attachment") {
    const auto data = fields.bytes("data");
    writer.write(Attachment{.log_time = fields.number<std::uint64_t>("log_time"),
                            .create_time = fields.number<std::uint64_t>("create_time"),
                            .name = fields.text("name"),
                            .media_type = fields.text("media_type"),
                            .data = data});
  } else if (type == "Metadata") {
    writer.write(Metadata{.name = fields.text("name"), .metadata = fields.map("metadata")});
  }
}

TEST(McapConformance, TheWriterWritesTheSameBytes) {
  VESTIGE_REQUIRE_DATA(folder());
  int count = 0;
  for (const auto& file : cases()) {
    const Json expected = expected_of(file);
    const auto features = features_of(expected);
    if (features.contains("pad")) continue;
    const WriterOptions options = {.chunking = features.contains("ch") ? Chunking::kChunks : Chunking::kNone,
                                   .message_index = features.contains("mx"),
                                   .statistics = features.contains("st"),
                                   .repeat_schemas = features.contains("rsh"),
                                   .repeat_channels = features.contains("rch"),
                                   .chunk_index = features.contains("chx"),
                                   .attachment_index = features.contains("ax"),
                                   .metadata_index = features.contains("mdx"),
                                   .summary_offsets = features.contains("sum")};
    std::vector<std::byte> written;
    const Fields header(expected["records"][0]);
    Writer writer([&](Bytes bytes) { written.insert(written.end(), bytes.begin(), bytes.end()); },
                  {.profile = header.text("profile"), .library = header.text("library")}, options);
    for (const Json& record : expected["records"]) {
      if (record["type"] == "DataEnd") break;
      write_record(writer, record["type"], Fields(record));
    }
    writer.finish();
    EXPECT_EQ(writer.bytes_written(), written.size());
    EXPECT_EQ(written, read_file(file)) << file;
    ++count;
  }
  EXPECT_EQ(count, 208);
}

}  // namespace
}  // namespace vestige::mcap
