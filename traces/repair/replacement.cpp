#include "traces/repair/replacement.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <span>

#include "traces/base/error.hpp"
#include "traces/base/sha256.hpp"
#include "traces/trace_file/trace_format.hpp"
#include "traces/trace_file/trace_nodes.hpp"

namespace vestige {

namespace {

using trace_format::AttachmentKind;

constexpr std::array kAvatarParts = {AttachmentKind::kAvatar};
constexpr std::array kMapParts = {AttachmentKind::kMapImage, AttachmentKind::kMapText};

class Planner {
 public:
  Planner(std::string_view file, const AttachmentFacts& facts, const Substitutes& substitutes)
      : file_(file), facts_(facts), refusal_(substitutes.refusal) {}

  void take(const Substitute& substitute, std::span<const AttachmentKind> parts);
  ReplacementPlan take_plan() { return std::move(plan_); }

 private:
  bool needs_replacement(const std::string& name) const;
  void require_recorded(const Substitute& substitute, const std::string& name, const std::string& refusal) const;
  void require_person(std::size_t person) const;
  void require_nodes(const Substitute& substitute) const;

  std::string_view file_;
  const AttachmentFacts& facts_;
  const std::optional<std::string>& refusal_;
  ReplacementPlan plan_;
};

bool Planner::needs_replacement(const std::string& name) const {
  if (facts_.claims.replaced.contains(name)) return true;
  const auto intact = facts_.sha256.find(name);
  if (intact != facts_.sha256.end()) return !is_recorded(facts_.claims, name, intact->second).value_or(true);
  return facts_.damaged.contains(name) || !recorded_sha256(facts_.claims, name).empty();
}

/// Throws `Error` if the substitute for an attachment is not the recorded one.
void Planner::require_recorded(const Substitute& substitute, const std::string& name,
                               const std::string& refusal) const {
  const std::set<std::string> recorded = recorded_sha256(facts_.claims, name);
  const auto file = substitute.files.find(name);
  if (file == substitute.files.end())
    throw Error(substitute.from,
                fmt::format("{} needs a new {}, but there is no sidecar .json beside this map", file_, name),
                "put the sidecar beside it");
  if (recorded.empty())
    throw Error(substitute.from,
                fmt::format("{} does not say which SHA-256 its {} had, so nothing can check this one", file_, name),
                fmt::format("if it is the right one, {}", refusal));
  const std::string sha256 = sha256_hex(file->second);
  if (!recorded.contains(sha256))
    throw Error(substitute.from,
                fmt::format("is not the {} that {} was recorded with: its SHA-256 is {}, the recorded one is {}", name,
                            file_, sha256, *recorded.begin()),
                fmt::format("name the one of the recording; to take this one anyway, {}", refusal));
}

void Planner::require_nodes(const Substitute& substitute) const {
  const auto avatar = substitute.files.find(trace_format::attachment_name(AttachmentKind::kAvatar, substitute.person));
  const auto pose_nodes = facts_.pose_nodes.find(substitute.person);
  if (avatar == substitute.files.end() || pose_nodes == facts_.pose_nodes.end()) return;
  const auto nodes = glb_node_count(avatar->second);
  if (!nodes || *nodes == pose_nodes->second) return;
  throw Error(substitute.from,
              fmt::format("has {} nodes, but the poses of the trace have {}", *nodes, pose_nodes->second),
              "name the avatar of the recording");
}

/// Throws `Error` unless the file has poses or an attachment of the person, or the SHA-256 of one.
void Planner::require_person(std::size_t person) const {
  if (facts_.pose_nodes.empty())
    throw Error(file_, "is not a trace of vestige, so it needs no avatar and no actuator map",
                "leave out --avatar and --map");
  const auto is_known = [&](AttachmentKind part) {
    const std::string name = trace_format::attachment_name(part, person);
    return facts_.sha256.contains(name) || facts_.damaged.contains(name) ||
           !recorded_sha256(facts_.claims, name).empty();
  };
  if (person == 0 || facts_.pose_nodes.contains(person) ||
      std::ranges::any_of(trace_format::kAttachmentKinds, is_known))
    return;
  throw Error(file_, fmt::format("holds no person {}", person + 1), "`vestige inspect` shows who is in it");
}

void Planner::take(const Substitute& substitute, std::span<const AttachmentKind> parts) {
  require_person(substitute.person);
  std::vector<std::string> names;
  for (const AttachmentKind part : parts) names.push_back(trace_format::attachment_name(part, substitute.person));
  std::vector<std::string> needed;
  std::ranges::copy_if(names, std::back_inserter(needed), [&](const auto& name) { return needs_replacement(name); });
  const bool has_any = std::ranges::any_of(names, [&](const auto& name) { return facts_.sha256.contains(name); });
  // Without a session, nobody knows what is missing.
  const bool may_lack_all = needed.empty() && !has_any;
  const std::string avatar = trace_format::attachment_name(AttachmentKind::kAvatar, substitute.person);
  if (may_lack_all && names.front() != avatar && !recorded_sha256(facts_.claims, avatar).empty())
    throw Error(file_, "was recorded without an actuator map, so there is none to replace", "leave out --map");
  if (may_lack_all) needed = {names.front()};
  if (needed.empty()) {
    plan_.unused.push_back(substitute.from);
    return;
  }
  const bool are_recorded = std::ranges::all_of(needed, [&](const std::string& name) {
    const auto file = substitute.files.find(name);
    return file != substitute.files.end() && is_recorded(facts_.claims, name, sha256_hex(file->second)).value_or(false);
  });
  if (are_recorded) {
    for (const std::string& name : needed)
      plan_.attachments[name] = {.from = substitute.from, .data = &substitute.files.at(name), .is_recorded = true};
    return;
  }
  if (refusal_)
    for (const std::string& name : needed) require_recorded(substitute, name, *refusal_);
  require_nodes(substitute);
  for (const std::string& name : names) {
    const auto file = substitute.files.find(name);
    if (file != substitute.files.end())
      plan_.attachments[name] = {.from = substitute.from, .data = &file->second};
    else if (facts_.sha256.contains(name) || needs_replacement(name))
      plan_.attachments[name] = {.from = substitute.from};
  }
}

}  // namespace

ReplacementPlan plan_replacements(std::string_view file, const AttachmentFacts& facts, const Substitutes& substitutes) {
  Planner planner(file, facts, substitutes);
  for (const Substitute& avatar : substitutes.avatars) planner.take(avatar, kAvatarParts);
  for (const Substitute& map : substitutes.maps) planner.take(map, kMapParts);
  return planner.take_plan();
}

}  // namespace vestige
