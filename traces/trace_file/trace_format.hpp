#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "traces/mcap/record.hpp"
#include "traces/scene/trace.hpp"

/// The trace file's own layer above MCAP; format versions 1 to 3, whose meaning never changes. A trace of version 1
/// has colliders without a size; in version 2 each has a radius. A trace of version 3 holds several people, or
/// colliders that belong to a person.
///
///     Header      profile "vestige", library "vestige VERSION"
///     Metadata    "session": format_version, facing, sha256 of each attachment, and what the recorder adds
///     Attachments avatar.glb, then actuator_map.png and actuator_map.json where there is a map
///     Schemas, Channels   outside chunks, so that a damaged chunk does not lose them; the metadata of /pose repeat the
///                 SHA-256s, so that the summary has them too
///     Chunks      a frame's messages stand together in one chunk: [events], /pose, /pose/2, …, /colliders
///     Summary     with everything that MCAP offers
///
/// The head, up to Channels, is synced before any frame.
///
/// Messages are FlatBuffers (schemas/*.fbs). log_time is the frame's time in nanoseconds from 0, sequence its index,
/// publish_time equals log_time. /events exists only if something happened.
///
/// People are numbered from 1 in files and texts, and from 0 in code (`person`). What belongs to the first has a plain
/// name; with a later one, its number stands in the name: /pose/2, avatar.2.glb, actuator_map.2.png, facing.2.
namespace vestige::trace_format {

inline constexpr std::string_view kProfile = "vestige";
inline constexpr int kPointsVersion = 1;
inline constexpr int kSpheresVersion = 2;
inline constexpr int kPeopleVersion = 3;
inline constexpr int kNewestVersion = kPeopleVersion;
inline constexpr std::size_t kMostPeople = 100;
inline constexpr std::string_view kVersionKey = "format_version";
inline constexpr std::string_view kSessionName = "session";
inline constexpr std::string_view kRecoveredName = "recovered";  // what `recover` could not save
inline constexpr std::string_view kReplacedName = "replaced";    // attachments that `recover` put in, not as recorded
inline constexpr std::string_view kLeftOut = "none";             // in `replaced`: nothing stands in its place
inline constexpr std::string_view kFacingKey = "facing";         ///< of the session: which way the avatar looks at rest
inline constexpr std::string_view kNameKey = "name";             ///< of the session: a person's name
inline constexpr std::string_view kSha256Prefix = "sha256:";
inline constexpr std::string_view kAvatarName = "avatar.glb";
inline constexpr std::string_view kMapImageName = "actuator_map.png";
inline constexpr std::string_view kMapTextName = "actuator_map.json";
inline constexpr std::string_view kEncoding = "flatbuffer";  ///< of schemas and of messages
inline constexpr std::string_view kNodesKey = "nodes";       ///< of /pose's metadata: a JSON array of node names

inline constexpr double kFarthest_m = 1e9;  ///< a position beyond this distance counts as a mistake

inline constexpr std::string_view kTeleportKind = "teleport";
inline constexpr std::string_view kDroppedKind = "dropped";
inline constexpr std::string_view kSupersededKind = "superseded";
inline constexpr std::string_view kMarkerKind = "marker";

enum class Stream : std::uint8_t { kPose, kColliders, kEvents, kForeign };

/// One of Vestige's own channels. Its schema and its channel have the same id.
struct StreamFormat {
  Stream stream;
  std::uint16_t id;  ///< in files that Vestige writes; readers go by topic and schema
  std::string_view topic;
  std::string_view schema;
};

inline constexpr std::array<StreamFormat, 3> kStreams = {{
    {Stream::kPose, 1, "/pose", "vestige.trace.PoseFrame"},
    {Stream::kColliders, 2, "/colliders", "vestige.trace.ColliderFrame"},
    {Stream::kEvents, 3, "/events", "vestige.trace.Event"},
}};

/// Returns the format version of a trace of one person whose colliders have this shape and belong to nobody.
constexpr int version_with(ColliderShape shape) {
  return shape == ColliderShape::kPoints ? kPointsVersion : kSpheresVersion;
}

/// Returns the name of what belongs to a person: "avatar.glb" for the first, "avatar.2.glb" for the second; "facing"
/// and "facing.2"; "/pose" and "/pose/2".
std::string numbered(std::string_view name, std::size_t person);

/// The attachments of a person.
enum class AttachmentKind : std::uint8_t { kAvatar, kMapImage, kMapText };
inline constexpr std::array kAttachmentKinds = {AttachmentKind::kAvatar, AttachmentKind::kMapImage,
                                                AttachmentKind::kMapText};
std::string attachment_name(AttachmentKind kind, std::size_t person = 0);

struct AttachmentId {
  AttachmentKind kind;
  std::size_t person;
};
/// Returns which of Vestige's own attachments has this name; nothing for any other.
std::optional<AttachmentId> attachment_id(std::string_view name);

/// Returns a `format_version`; nothing if the text is no whole number above 0.
std::optional<int> parse_version(std::string_view text);

/// Returns "sha256:NAME", the key of an attachment's SHA-256.
std::string sha256_key(std::string_view attachment);

/// Returns one of Vestige's own attachments, with its media type.
mcap::Attachment attachment_of(std::string_view name, mcap::Bytes data);

/// Returns the schema record of a stream in this format version, with its compiled FlatBuffers schema.
mcap::Schema schema_of(Stream stream, int version = kPointsVersion);
/// Returns the channel record of a stream in this format version; of /pose, that of a person. The writer adds the node
/// names to /pose.
mcap::Channel channel_of(Stream stream, int version = kPointsVersion, std::size_t person = 0);
/// Returns the id of the channel /pose of a person, in files that Vestige writes.
std::uint16_t pose_channel_id(std::size_t person);

bool is_ours(const mcap::Schema& schema);

/// What a channel carries.
struct StreamId {
  Stream stream = Stream::kForeign;
  std::size_t person = 0;  ///< whose pose, for kPose
  bool operator<(const StreamId& other) const {
    return stream != other.stream ? stream < other.stream : person < other.person;
  }
};

/// Returns the stream that a channel carries, or kForeign if it carries none of ours. `schema` may be null.
StreamId recognise(const mcap::Channel& channel, const mcap::Schema* schema);

}  // namespace vestige::trace_format
