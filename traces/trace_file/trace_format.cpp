#include "traces/trace_file/trace_format.hpp"

#include <algorithm>
#include <charconv>
#include <limits>

#include "traces/base/embed.hpp"

VESTIGE_EMBED(vestige_schema_pose_frame, VESTIGE_SCHEMA_DIR "/pose_frame.bfbs");
VESTIGE_EMBED(vestige_schema_collider_frame, VESTIGE_SCHEMA_DIR "/collider_frame.bfbs");
VESTIGE_EMBED(vestige_schema_collider_frame_2, VESTIGE_SCHEMA_DIR "/collider_frame_2.bfbs");
VESTIGE_EMBED(vestige_schema_event, VESTIGE_SCHEMA_DIR "/event.bfbs");

namespace vestige::trace_format {

namespace {

const StreamFormat& format_of(Stream stream) {
  return kStreams.at(static_cast<std::size_t>(stream));
}

std::vector<std::byte> compiled_schema(Stream stream, int version) {
  switch (stream) {
    case Stream::kPose:
      return VESTIGE_EMBEDDED(vestige_schema_pose_frame);
    case Stream::kColliders:
      return version == kPointsVersion ? VESTIGE_EMBEDDED(vestige_schema_collider_frame)
                                       : VESTIGE_EMBEDDED(vestige_schema_collider_frame_2);
    case Stream::kEvents:
      return VESTIGE_EMBEDDED(vestige_schema_event);
    case Stream::kForeign:
      break;
  }
  return {};
}

mcap::StringMap units_of(Stream stream, int version) {
  constexpr const char* kAxes = "glTF: right-handed, +Y up, +Z forward";
  switch (stream) {
    case Stream::kPose:
      return {
          {"axes", kAxes},
          {"units", "origin and translation in metres; rotation a quaternion x y z w; relative to the parent node"}};
    case Stream::kColliders:
      return {
          {"axes", kAxes},
          {"units", version == kPointsVersion ? "world position in metres" : "world position and radius in metres"}};
    case Stream::kEvents:
    case Stream::kForeign:
      break;
  }
  return {};
}

}  // namespace

std::optional<int> parse_version(std::string_view text) {
  int version = 0;
  const auto [end, failure] = std::from_chars(text.data(), text.data() + text.size(), version);
  if (failure == std::errc::result_out_of_range) return std::numeric_limits<int>::max();
  const bool is_number = failure == std::errc() && end == text.data() + text.size();
  return is_number && version > 0 ? std::optional(version) : std::nullopt;
}

std::string sha256_key(std::string_view attachment) {
  return std::string(kSha256Prefix).append(attachment);
}

mcap::Attachment attachment_of(std::string_view name, mcap::Bytes data) {
  const char* media_type = name == kAvatarName     ? "model/gltf-binary"
                           : name == kMapImageName ? "image/png"
                                                   : "application/json";
  return {.name = std::string(name), .media_type = media_type, .data = data};
}

mcap::Schema schema_of(Stream stream, int version) {
  const StreamFormat& format = format_of(stream);
  return {.id = format.id,
          .name = std::string(format.schema),
          .encoding = std::string(kEncoding),
          .data = compiled_schema(stream, version)};
}

mcap::Channel channel_of(Stream stream, int version) {
  const StreamFormat& format = format_of(stream);
  return {.id = format.id,
          .schema_id = format.id,
          .topic = std::string(format.topic),
          .message_encoding = std::string(kEncoding),
          .metadata = units_of(stream, version)};
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
