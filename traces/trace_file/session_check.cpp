#include "traces/trace_file/session_check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <span>
#include <utility>

#include "traces/base/error.hpp"
#include "traces/base/sha256.hpp"
#include "traces/scene/builtin_avatar.hpp"
#include "traces/scene/facing.hpp"
#include "traces/trace_file/trace_format.hpp"

namespace vestige {

namespace {

using trace_format::AttachmentKind;
using trace_format::sha256_key;

bool is_avatar(std::string_view attachment) {
  const auto id = trace_format::attachment_id(attachment);
  return id && id->kind == AttachmentKind::kAvatar;
}

/// Returns 1 + the largest person whose attachment a map names, each key after this prefix; 0 if it names none.
std::size_t people_named(const mcap::StringMap& map, std::string_view prefix) {
  std::size_t people = 0;
  for (auto entry = map.lower_bound(std::string(prefix)); entry != map.end() && entry->first.starts_with(prefix);
       ++entry)
    if (const auto id = trace_format::attachment_id(std::string_view(entry->first).substr(prefix.size())))
      people = std::max(people, id->person + 1);
  return people;
}

/// Returns how many people have an attachment whose SHA-256 is recorded.
std::size_t people_claimed(const AttachmentClaims& claims) {
  if (const auto version = version_of(claims); version && *version < trace_format::kPeopleVersion) return 1;
  return std::max(people_named(claims.session, trace_format::kSha256Prefix),
                  people_named(claims.pose, trace_format::kSha256Prefix));
}

std::string sha256_of_builtin(std::string_view attachment) {
  const auto id = trace_format::attachment_id(attachment);
  if (id && id->kind == AttachmentKind::kAvatar) return sha256_hex(builtin_avatar_glb());
  if (id && id->kind == AttachmentKind::kMapImage) return sha256_hex(builtin_actuator_map_png());
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
  problems_.push_back({fmt::format("the attachment {}, whose SHA-256 is recorded, is missing or damaged", name),
                       fmt::format("{}; {} puts an intact one in its place",
                                   is_avatar(name) ? "`vestige replay` has no body to move, and refuses the file"
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

std::string unknown_version(std::string_view version, int newest) {
  return fmt::format("its format version is {}, and this vestige reads versions up to {}", version, newest);
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
  mcap::StringMap metadata;
  for (const auto& [person, channel] : streams.pose_channels())
    metadata.insert(channel->metadata.begin(), channel->metadata.end());
  return metadata;
}

std::string recorded_of(const Session& session, std::string_view key, std::size_t person) {
  const auto found = session.find(trace_format::numbered(key, person));
  return found == session.end() ? "" : found->second;
}

std::optional<int> version_of(const AttachmentClaims& claims) {
  if (claims.version_of_schemas) return claims.version_of_schemas;
  const auto text = claims.session.find(std::string(trace_format::kVersionKey));
  return text == claims.session.end() ? std::nullopt : trace_format::parse_version(text->second);
}

std::size_t people_of(const AttachmentClaims& claims, const StreamTable& streams,
                      const std::map<std::string, std::string>& sha256) {
  if (const auto version = version_of(claims); version && *version < trace_format::kPeopleVersion) return 1;
  // The session alone does not count: no CRC covers it.
  std::size_t people =
      std::max({std::size_t{1}, people_named(claims.pose, trace_format::kSha256Prefix), people_named(sha256, "")});
  for (const auto& [person, channel] : streams.pose_channels()) people = std::max(people, person + 1);
  return people;
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
  for (std::size_t person = 0; person < people_claimed(claims); ++person)
    for (const AttachmentKind kind : trace_format::kAttachmentKinds)
      if (const std::string name = trace_format::attachment_name(kind, person); !sha256.contains(name))
        check.missing(name);
  std::vector<SessionProblem> problems = check.take_problems();
  if (auto problem = check_version(claims)) problems.insert(problems.begin(), *std::move(problem));
  for (std::size_t person = 0; person < std::max<std::size_t>(1, people_claimed(claims)); ++person) {
    const std::string key = trace_format::numbered(trace_format::kFacingKey, person);
    const auto facing = claims.session.find(key);
    if (facing != claims.session.end() && !facing_named(facing->second))
      problems.push_back({fmt::format("the session records the {} '{}', which is no axis", key, facing->second),
                          "the avatar faces where its own file tells; `vestige recover` leaves it out"});
  }
  return problems;
}

std::string replacing_command(std::string_view file, const AttachmentClaims& claims, std::string_view attachment) {
  const bool wants_avatar = is_avatar(attachment);
  const bool is_builtin = recorded_sha256(claims, attachment).contains(sha256_of_builtin(attachment));
  const auto id = trace_format::attachment_id(attachment);
  const std::string person = id && id->person > 0 ? fmt::format("{}=", id->person + 1) : "";
  return fmt::format("`vestige recover {} {} {}{} -o mended.mcap`", file, wants_avatar ? "--avatar" : "--map", person,
                     is_builtin     ? "builtin"
                     : wants_avatar ? "FILE.glb"
                                    : "FILE.png");
}

}  // namespace vestige
