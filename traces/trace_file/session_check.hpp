#pragma once

#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "traces/mcap/record.hpp"
#include "traces/scene/trace.hpp"
#include "traces/trace_file/message_stream.hpp"

namespace vestige {

/// What a file says about its attachments. A record that the file does not have is empty.
struct AttachmentClaims {
  Session session;
  mcap::StringMap pose;      ///< metadata of the channels /pose, which repeat the SHA-256s of the session
  mcap::StringMap replaced;  ///< metadata record `replaced`
  std::optional<int> version_of_schemas = {};  ///< the format version whose schemas the file has, if they are of one
};

/// Returns the metadata of the channels /pose, of each key the first person's; empty if the table has no such channel.
mcap::StringMap pose_metadata(const StreamTable& streams);

/// Returns what a session records of a person under this key: facing, name; empty if it records nothing.
std::string recorded_of(const Session& session, std::string_view key, std::size_t person);

/// Returns how many people a trace has, whose channels and attachments (by name) are these: of the last person there is
/// a channel, or an attachment, or channel metadata with the SHA-256 of one. Returns 1 for a trace of an earlier
/// version than that of people.
std::size_t people_of(const AttachmentClaims& claims, const StreamTable& streams,
                      const std::map<std::string, std::string>& sha256);

/// Returns the format version: that of the schemas, otherwise what the session says; nothing if neither is known.
std::optional<int> version_of(const AttachmentClaims& claims);

/// Returns what a file records as the SHA-256 of an attachment: nothing, one value, or two if either session or channel
/// /pose is damaged.
std::set<std::string> recorded_sha256(const AttachmentClaims& claims, std::string_view attachment);

/// Returns whether `sha256` is recorded for an attachment; nothing if the file records none for it.
std::optional<bool> is_recorded(const AttachmentClaims& claims, std::string_view attachment, const std::string& sha256);

struct SessionProblem {
  std::string what;
  std::string consequence;
};

/// Returns the contradictions between a file and what it says: an unknown format version, attachments that are not the
/// recorded ones or are missing, and a facing that is no axis. `sha256` holds the hashes of the undamaged attachments,
/// by name. `file` is the file's name, for the commands that the problems name.
std::vector<SessionProblem> check_session(std::string_view file, const AttachmentClaims& claims,
                                          const std::map<std::string, std::string>& sha256);

/// Returns "its format version is 9, and this vestige reads versions up to 3".
std::string unknown_version(std::string_view version, int newest = trace_format::kNewestVersion);

/// Throws `Error` if a later version of vestige wrote the file: its `format_version` is greater than the newest known.
void refuse_later_version(std::string_view file, const Session& session);

/// Returns the command that puts an intact attachment into a file: "`vestige recover a.mcap --avatar FILE.glb -o
/// mended.mcap`". It says `builtin` in place of FILE if that is the recorded one.
std::string replacing_command(std::string_view file, const AttachmentClaims& claims, std::string_view attachment);

}  // namespace vestige
