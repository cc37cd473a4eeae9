#include "traces/trace_file/trace_format.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <limits>

#include "traces/base/embed.hpp"

VESTIGE_EMBED(vestige_schema_pose_frame, VESTIGE_SCHEMA_DIR "/pose_frame.bfbs");
VESTIGE_EMBED(vestige_schema_collider_frame, VESTIGE_SCHEMA_DIR "/collider_frame.bfbs");
VESTIGE_EMBED(vestige_schema_collider_frame_2, VESTIGE_SCHEMA_DIR "/collider_frame_2.bfbs");
VESTIGE_EMBED(vestige_schema_collider_frame_3, VESTIGE_SCHEMA_DIR "/collider_frame_3.bfbs");
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
      if (version == kPointsVersion) return VESTIGE_EMBEDDED(vestige_schema_collider_frame);
      if (version == kSpheresVersion) return VESTIGE_EMBEDDED(vestige_schema_collider_frame_2);
      return VESTIGE_EMBEDDED(vestige_schema_collider_frame_3);
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

/// Returns the number behind `before` in a name, if that is one of a later person: 1 for "avatar.2.glb". Returns 0 if
/// nothing stands between `before` and `behind`.
std::optional<std::size_t> person_between(std::string_view name, std::string_view before, std::string_view behind,
                                          char mark) {
  if (name.size() < before.size() + behind.size() || !name.starts_with(before) || !name.ends_with(behind)) return {};
  std::string_view number = name.substr(before.size(), name.size() - before.size() - behind.size());
  if (number.empty()) return 0;
  if (number.front() != mark) return {};
  number.remove_prefix(1);
  if (number.starts_with('0')) return {};
  std::size_t value = 0;
  const auto [end, failure] = std::from_chars(number.data(), number.data() + number.size(), value);
  const bool is_later = failure == std::errc() && end == number.data() + number.size() && value > 1;
  return is_later && value <= kMostPeople ? std::optional(value - 1) : std::nullopt;
}

std::string_view base_name(AttachmentKind kind) {
  return kind == AttachmentKind::kAvatar     ? kAvatarName
         : kind == AttachmentKind::kMapImage ? kMapImageName
                                             : kMapTextName;
}

}  // namespace

std::string numbered(std::string_view name, std::size_t person) {
  if (person == 0) return std::string(name);
  if (name.starts_with('/')) return fmt::format("{}/{}", name, person + 1);
  const std::size_t stem = std::min(name.find_last_of('.'), name.size());
  return fmt::format("{}.{}{}", name.substr(0, stem), person + 1, name.substr(stem));
}

std::string attachment_name(AttachmentKind kind, std::size_t person) {
  return numbered(base_name(kind), person);
}

std::optional<AttachmentId> attachment_id(std::string_view name) {
  for (const AttachmentKind kind : kAttachmentKinds) {
    const std::string_view base = base_name(kind);
    const std::size_t stem = base.find_last_of('.');
    if (const auto person = person_between(name, base.substr(0, stem), base.substr(stem), '.'))
      return AttachmentId{kind, *person};
  }
  return {};
}

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
  const char* media_type = name.ends_with(".glb")   ? "model/gltf-binary"
                           : name.ends_with(".png") ? "image/png"
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

std::uint16_t pose_channel_id(std::size_t person) {
  constexpr std::size_t kFirstLater = 100;
  return static_cast<std::uint16_t>(person == 0 ? format_of(Stream::kPose).id : kFirstLater + person + 1);
}

mcap::Channel channel_of(Stream stream, int version, std::size_t person) {
  const StreamFormat& format = format_of(stream);
  return {.id = stream == Stream::kPose ? pose_channel_id(person) : format.id,
          .schema_id = format.id,
          .topic = numbered(format.topic, person),
          .message_encoding = std::string(kEncoding),
          .metadata = units_of(stream, version)};
}

bool is_ours(const mcap::Schema& schema) {
  return std::any_of(kStreams.begin(), kStreams.end(),
                     [&](const StreamFormat& format) { return schema.name == format.schema; });
}

StreamId recognise(const mcap::Channel& channel, const mcap::Schema* schema) {
  if (schema == nullptr || channel.message_encoding != kEncoding) return {};
  for (const StreamFormat& format : kStreams) {
    if (schema->name != format.schema) continue;
    const auto person = person_between(channel.topic, format.topic, "", '/');
    if (person && (*person == 0 || format.stream == Stream::kPose)) return {format.stream, *person};
  }
  return {};
}

}  // namespace vestige::trace_format
