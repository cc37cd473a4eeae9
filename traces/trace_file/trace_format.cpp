#include "traces/trace_file/trace_format.hpp"

#include <schemas/collider_frame_bfbs_generated.h>
#include <schemas/event_bfbs_generated.h>
#include <schemas/pose_frame_bfbs_generated.h>

#include <algorithm>

namespace vestige::trace_format {

namespace {

const StreamFormat& format_of(Stream stream) {
  return kStreams.at(static_cast<std::size_t>(stream));
}

template <typename BinarySchema>
std::vector<std::byte> compiled() {
  const auto bytes = std::as_bytes(std::span(BinarySchema::data(), BinarySchema::size()));
  return {bytes.begin(), bytes.end()};
}

std::vector<std::byte> compiled_schema(Stream stream) {
  switch (stream) {
    case Stream::kPose:
      return compiled<trace::PoseFrameBinarySchema>();
    case Stream::kColliders:
      return compiled<trace::ColliderFrameBinarySchema>();
    case Stream::kEvents:
      return compiled<trace::EventBinarySchema>();
    case Stream::kForeign:
      break;
  }
  return {};
}

mcap::StringMap units_of(Stream stream) {
  constexpr const char* kAxes = "glTF: right-handed, +Y up, +Z forward";
  switch (stream) {
    case Stream::kPose:
      return {
          {"axes", kAxes},
          {"units", "origin and translation in metres; rotation a quaternion x y z w; relative to the parent node"}};
    case Stream::kColliders:
      return {{"axes", kAxes}, {"units", "world position in metres"}};
    case Stream::kEvents:
    case Stream::kForeign:
      break;
  }
  return {};
}

}  // namespace

std::string sha256_key(std::string_view attachment) {
  return std::string(kSha256Prefix).append(attachment);
}

mcap::Attachment attachment_of(std::string_view name, mcap::Bytes data) {
  const char* media_type = name == kAvatarName     ? "model/gltf-binary"
                           : name == kMapImageName ? "image/png"
                                                   : "application/json";
  return {.name = std::string(name), .media_type = media_type, .data = data};
}

mcap::Schema schema_of(Stream stream) {
  const StreamFormat& format = format_of(stream);
  return {.id = format.id,
          .name = std::string(format.schema),
          .encoding = std::string(kEncoding),
          .data = compiled_schema(stream)};
}

mcap::Channel channel_of(Stream stream) {
  const StreamFormat& format = format_of(stream);
  return {.id = format.id,
          .schema_id = format.id,
          .topic = std::string(format.topic),
          .message_encoding = std::string(kEncoding),
          .metadata = units_of(stream)};
}

bool is_ours(const mcap::Schema& schema) {
  return std::any_of(kStreams.begin(), kStreams.end(),
                     [&](const StreamFormat& format) { return schema.name == format.schema; });
}

Stream recognise(const mcap::Channel& channel, const mcap::Schema* schema) {
  if (schema == nullptr || channel.message_encoding != kEncoding) return Stream::kForeign;
  for (const StreamFormat& format : kStreams) {
    if (channel.topic == format.topic && schema->name == format.schema) return format.stream;
  }
  return Stream::kForeign;
}

}  // namespace vestige::trace_format
