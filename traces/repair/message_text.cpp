#include "traces/repair/message_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <nlohmann/json.hpp>
#include <string_view>
#include <utility>

#include "traces/base/number_text.hpp"
#include "traces/files/input_file.hpp"
#include "traces/scene/frame_json.hpp"

namespace vestige {

namespace {

using trace_format::Stream;

std::string json_text(std::string_view text) {
  return nlohmann::json(text).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

/// Copies JSON without the white space between its tokens. Numbers and duplicate names stay as they are.
void append_compact(std::string& out, std::string_view json) {
  if (json.starts_with("\xEF\xBB\xBF")) json.remove_prefix(3);  // a byte order mark
  bool is_string = false;
  for (std::size_t i = 0; i < json.size(); ++i) {
    const char character = json[i];
    if (character == '"') is_string = !is_string;
    if (is_string && character == '\\') out += json[i++];
    if (is_string || std::string_view(" \t\r\n").find(character) == std::string_view::npos) out += json[i];
  }
}

/// Appends `bytes` as base64 (RFC 4648, section 4).
void append_base64(std::string& out, mcap::Bytes bytes) {
  constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t count = std::min<std::size_t>(3, bytes.size() - i);
    std::uint32_t group = 0;
    for (std::size_t k = 0; k < 3; ++k)
      group = group << 8U | (k < count ? std::to_integer<std::uint32_t>(bytes[i + k]) : 0U);
    for (std::size_t k = 0; k < 4; ++k) out += k <= count ? kDigits[group >> (18 - 6 * k) & 63U] : '=';
  }
}

}  // namespace

std::string MessageText::line(const mcap::Message& message, const mcap::Channel& channel, Stream stream) {
  text_ = fmt::format(R"({{"topic":{},"sequence":{},"log_time":{},"publish_time":{},)", json_text(channel.topic),
                      message.sequence, message.log_time, message.publish_time);
  append_data(message, channel, stream);
  text_ += '}';
  return std::move(text_);
}

void MessageText::append_data(const mcap::Message& message, const mcap::Channel& channel, Stream stream) {
  switch (stream) {
    case Stream::kPose:
      append_pose(message.data);
      break;
    case Stream::kColliders:
      append_colliders(message.data);
      break;
    case Stream::kEvents:
      append_event(message.data);
      break;
    case Stream::kForeign:
      append_foreign(message.data, channel);
      break;
  }
}

void MessageText::append_pose(mcap::Bytes data) {
  decoder_.pose(data, pose_);
  text_ += R"("data":)";
  append_json(text_, pose_);
}

void MessageText::append_colliders(mcap::Bytes data) {
  decoder_.colliders(data, colliders_);
  text_ += R"("data":)";
  append_json(text_, colliders_);
}

void MessageText::append_event(mcap::Bytes data) {
  const TraceEvent event = decoder_.event(data);
  fmt::format_to(std::back_inserter(text_), R"("data":{{"kind":{},"collider":{},"count":{},"text":{}}})",
                 json_text(event.kind), event.collider, event.count, json_text(event.text));
}

void MessageText::append_foreign(mcap::Bytes data, const mcap::Channel& channel) {
  if (channel.message_encoding == "json") {
    if (const std::string_view json = text_of(data); nlohmann::json::accept(json)) {
      text_ += "\"data\":";
      append_compact(text_, json);
      return;
    }
  }
  text_ += "\"data_base64\":\"";
  append_base64(text_, data);
  text_ += '"';
}

}  // namespace vestige
