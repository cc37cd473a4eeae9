#include "traces/trace_file/session_check.hpp"

#include <fmt/format.h>

#include <span>
#include <utility>

#include "traces/base/error.hpp"
#include "traces/base/sha256.hpp"
#include "traces/scene/builtin_avatar.hpp"
#include "traces/scene/facing.hpp"
#include "traces/trace_file/trace_format.hpp"

namespace vestige {

namespace {

using trace_format::sha256_key;

std::string sha256_of_builtin(std::string_view attachment) {
  if (attachment == trace_format::kAvatarName) return sha256_hex(builtin_avatar_glb());
  if (attachment == trace_format::kMapImageName) return sha256_hex(builtin_actuator_map_png());
  const std::string json = builtin_actuator_map_json();
  return sha256_hex(std::as_bytes(std::span(json)));
}

/// Returns the SHA-256 that a record has for an attachment; empty if it has none.
std::string claimed_by(const mcap::StringMap& record, std::string_view attachment) {
  const auto found = record.find(sha256_key(attachment));
  return found == record.end() ? std::string() : found->second;
}

class AttachmentCheck {
 public:
  AttachmentCheck(std::string_view file, const AttachmentClaims& claims) : file_(file), claims_(claims) {}

  void missing(std::string_view name);
  void present(std::string_view name, const std::string& sha256);
  std::vector<SessionProblem> take_problems() { return std::move(problems_); }

 private:
  std::string_view file_;
  const AttachmentClaims& claims_;
  std::vector<SessionProblem> problems_;
};

void AttachmentCheck::missing(std::string_view name) {
  if (recorded_sha256(claims_, name).empty()) return;
  const auto replaced = claims_.replaced.find(std::string(name));
  if (replaced != claims_.replaced.end() && replaced->second == trace_format::kLeftOut) {
    problems_.push_back({fmt::format("the attachment {}, whose SHA-256 is recorded, is not there", name),
                         "`vestige recover --force` put another actuator map in without it"});
    return;
  }
  problems_.push_back(
      {fmt::format("the attachment {}, whose SHA-256 is recorded, is missing or damaged", name),
       fmt::format("{}; {} puts an intact one in its place",
                   name == trace_format::kAvatarName ? "`vestige replay` has no body to move, and refuses the file"
                                                     : "the trace has no actuator map as it was recorded",
                   replacing_command(file_, claims_, name))});
}

void AttachmentCheck::present(std::string_view name, const std::string& sha256) {
  const std::set<std::string> recorded = recorded_sha256(claims_, name);
  const auto replaced = claims_.replaced.find(std::string(name));
  const bool was_put_in = replaced != claims_.replaced.end() && replaced->second == sha256;
  if (recorded.empty() && was_put_in) {
    problems_.push_back({fmt::format("`vestige recover --force` put in the attachment {}, but the file does not record "
                                     "the SHA-256 of the original",
                                     name),
                         "nobody knows whether the frames fit it"});
  } else if (!recorded.empty() && !recorded.contains(sha256)) {
    problems_.push_back(
        {fmt::format("the attachment {} is not the recorded one: its SHA-256 differs{}", name,
                     was_put_in ? ", because `vestige recover --force` put another one in its place" : ""),
         "the frames may not fit it"});
  } else if (recorded.size() > 1) {
    problems_.push_back({fmt::format("session and channel /pose record different SHA-256s of the attachment {}", name),
                         fmt::format("that of {} is damaged, because the attachment has the other one",
                                     claimed_by(claims_.session, name) == sha256 ? "the channel" : "the session")});
  }
}

std::optional<SessionProblem> check_version(const AttachmentClaims& claims) {
  const Session& session = claims.session;
  const auto text = session.find(std::string(trace_format::kVersionKey));
  if (text == session.end()) return {};
  const std::optional<int> version = trace_format::parse_version(text->second);
  if (!version)
    return SessionProblem{fmt::format("its format version is '{}', which is no version", text->second),
                          "its frames are read as far as they fit; `vestige recover` mends the number"};
  if (*version > trace_format::kNewestVersion)
    return SessionProblem{unknown_version(text->second), "`vestige replay` refuses the file"};
  if (claims.version_of_schemas && *version != *claims.version_of_schemas)
    return SessionProblem{fmt::format("its format version is {}, but its schemas are those of version {}", *version,
                                      *claims.version_of_schemas),
                          "the schemas count; `vestige recover` mends the number"};
  return {};
}

}  // namespace

std::string unknown_version(std::string_view version) {
  return fmt::format("its format version is {}, and this vestige reads versions up to {}", version,
                     trace_format::kNewestVersion);
}

void refuse_later_version(std::string_view file, const Session& session) {
  const auto text = session.find(std::string(trace_format::kVersionKey));
  if (text == session.end()) return;
  const std::optional<int> version = trace_format::parse_version(text->second);
  if (!version || *version <= trace_format::kNewestVersion) return;
  throw Error(std::string(file), unknown_version(text->second),
              "use the later version of vestige that wrote it; if the file is damaged, `vestige recover` may mend it");
}

mcap::StringMap pose_metadata(const StreamTable& streams) {
  const mcap::Channel* pose = streams.find(trace_format::Stream::kPose);
  return pose == nullptr ? mcap::StringMap() : pose->metadata;
}

std::set<std::string> recorded_sha256(const AttachmentClaims& claims, std::string_view attachment) {
  std::set<std::string> recorded;
  for (const mcap::StringMap* map : {&claims.session, &claims.pose})
    if (std::string claimed = claimed_by(*map, attachment); !claimed.empty()) recorded.insert(std::move(claimed));
  return recorded;
}

std::optional<bool> is_recorded(const AttachmentClaims& claims, std::string_view attachment,
                                const std::string& sha256) {
  const std::set<std::string> recorded = recorded_sha256(claims, attachment);
  if (recorded.empty()) return {};
  return recorded.contains(sha256);
}

std::vector<SessionProblem> check_session(std::string_view file, const AttachmentClaims& claims,
                                          const std::map<std::string, std::string>& sha256) {
  AttachmentCheck check(file, claims);
  for (const auto& [name, hash] : sha256) check.present(name, hash);
  for (const std::string_view name : trace_format::kAttachmentNames)
    if (!sha256.contains(std::string(name))) check.missing(name);
  std::vector<SessionProblem> problems = check.take_problems();
  if (auto problem = check_version(claims)) problems.insert(problems.begin(), *std::move(problem));
  const auto facing = claims.session.find(std::string(trace_format::kFacingKey));
  if (facing != claims.session.end() && !facing_named(facing->second))
    problems.push_back({fmt::format("the session records the facing '{}', which is no axis", facing->second),
                        "the avatar faces where its own file tells; `vestige recover` leaves it out"});
  return problems;
}

std::string replacing_command(std::string_view file, const AttachmentClaims& claims, std::string_view attachment) {
  const bool is_avatar = attachment == trace_format::kAvatarName;
  const bool is_builtin = recorded_sha256(claims, attachment).contains(sha256_of_builtin(attachment));
  return fmt::format("`vestige recover {} {} {} -o mended.mcap`", file, is_avatar ? "--avatar" : "--map",
                     is_builtin  ? "builtin"
                     : is_avatar ? "FILE.glb"
                                 : "FILE.png");
}

}  // namespace vestige
