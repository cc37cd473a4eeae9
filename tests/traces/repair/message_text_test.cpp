// What `vestige cat` prints: JSON that reads back to the same bits.

#include "traces/repair/message_text.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <nlohmann/json.hpp>

#include "tests/traces/trace_file/trace_fixture.hpp"

namespace vestige {
namespace {

using trace_format::Stream;

std::string line_of(Stream stream, mcap::Bytes data, const std::string& encoding) {
  MessageText text;
  mcap::Channel channel;
  channel.topic = "/a \"b\"";
  channel.message_encoding = encoding;
  const std::string line =
      text.line({.channel_id = 1, .sequence = 7, .log_time = 8, .publish_time = 9, .data = data}, channel, stream);
  EXPECT_EQ(line.find('\n'), std::string::npos);
  return line;
}

nlohmann::json printed(Stream stream, mcap::Bytes data, const std::string& encoding = "flatbuffer") {
  const auto json = nlohmann::json::parse(line_of(stream, data, encoding));
  EXPECT_EQ(json["topic"], "/a \"b\"");
  EXPECT_EQ(json["sequence"], 7);
  EXPECT_EQ(json["log_time"], 8);
  EXPECT_EQ(json["publish_time"], 9);
  return json;
}

TEST(MessageText, PosesReadBackToTheSameBits) {
  MessageEncoder encoder;
  TraceFrame frame = test::frame(3, test::kNodes, 0);
  frame.poses.front().nodes[0].translation = {-0.0F, std::numeric_limits<float>::denorm_min(), 16777216.0F};
  const auto data = printed(Stream::kPose, encoder.pose(0, frame.poses.front()))["data"];
  TraceFrame read = frame;
  read.poses.front() = {};
  read.poses.front().origin_m = {data["origin"][0], data["origin"][1], data["origin"][2]};
  for (const auto& node : data["nodes"])
    read.poses.front().nodes.push_back(
        {.translation = {node[0].get<float>(), node[1].get<float>(), node[2].get<float>()},
         .rotation = glm::quat(node[6].get<float>(), node[3].get<float>(), node[4].get<float>(), node[5].get<float>()),
         .scale = {node[7].get<float>(), node[8].get<float>(), node[9].get<float>()}});
  EXPECT_TRUE(test::same_bits(read, frame));
}

TEST(MessageText, CollidersReadBackToTheSameBitsAndWhatIsNoNumberIsText) {
  MessageEncoder encoder;
  const double tiny = std::numeric_limits<double>::denorm_min();
  const double infinity = std::numeric_limits<double>::infinity();
  const auto data = printed(
      Stream::kColliders, encoder.colliders(0, {{.id = 4, .position_m = {-0.0, tiny, 0.1}},
                                                {.id = 9, .position_m = {infinity, -infinity, std::nan("")}}}))["data"];
  EXPECT_EQ(data[0]["id"], 4);
  const auto& position = data[0]["position"];
  EXPECT_TRUE(test::same_bits({position[0], position[1], position[2]}, {-0.0, tiny, 0.1}));
  EXPECT_EQ(data[1]["position"], nlohmann::json::array({"inf", "-inf", "nan"}));
}

TEST(MessageText, EventsAndMessagesOfOthersAreThere) {
  MessageEncoder encoder;
  const auto event =
      printed(Stream::kEvents, encoder.event({.kind = "marker", .collider = 1, .count = 2, .text = "a\nb"}));
  EXPECT_EQ(event["data"]["kind"], "marker");
  EXPECT_EQ(event["data"]["text"], "a\nb");
  const std::string json = "{\n \"x\": [1, 2]}";
  EXPECT_EQ(printed(Stream::kForeign, std::as_bytes(std::span(json)), "json")["data"]["x"][1], 2);
  for (const auto& [raw, coded] : {std::pair("", ""), std::pair("f", "Zg=="), std::pair("fo", "Zm8="),
                                   std::pair("foo", "Zm9v"), std::pair("foob", "Zm9vYg==")}) {
    const std::string bytes = raw;
    EXPECT_EQ(printed(Stream::kForeign, std::as_bytes(std::span(bytes)), "cdr")["data_base64"], coded);
  }
}

TEST(MessageText, JsonOfOthersStaysAsItIsButForSpace) {
  const auto shown = [](const std::string& json) {
    const std::string line = line_of(Stream::kForeign, std::as_bytes(std::span(json)), "json");
    return line.substr(line.find("\"data\":"));
  };
  EXPECT_EQ(shown("{\"b\" : 18446744073709551617,\r\n\t\"a\":\"\\\\ \",\"a\":\"\\\" }\"}"),
            "\"data\":{\"b\":18446744073709551617,\"a\":\"\\\\ \",\"a\":\"\\\" }\"}}");
  const std::string deep = std::string(100000, '[') + std::string(100000, ']');
  EXPECT_EQ(shown(deep), "\"data\":" + deep + "}");
}

}  // namespace
}  // namespace vestige
