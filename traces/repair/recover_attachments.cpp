#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "traces/base/sha256.hpp"
#include "traces/mcap/decode.hpp"
#include "traces/repair/recoverer.hpp"
#include "traces/scene/facing.hpp"

namespace vestige {

namespace {

using mcap::Bytes;
using trace_format::Stream;

constexpr std::string_view kDamagedSuffix = ".damaged";

}  // namespace

void Recoverer::take_metadata(mcap::Metadata metadata) {
  if (metadata.name == trace_format::kReplacedName) {
    facts_.claims.replaced = std::move(metadata.metadata);  // written at the end, as it is then
    return;
  }
  if (metadata.name == trace_format::kSessionName) {
    facts_.claims.session = metadata.metadata;
    for (std::size_t person = 0; person < trace_format::kMostPeople; ++person) drop_facing(metadata.metadata, person);
    mend_version(metadata.metadata);
  }
  output_.write(metadata);
  ++result_.metadata;
}

/// Drops the facing of a person in a session if it is no axis, or if another avatar takes the place of the recorded
/// one: it faces where its own file tells.
void Recoverer::drop_facing(mcap::StringMap& session, std::size_t person) {
  const std::string key = trace_format::numbered(trace_format::kFacingKey, person);
  const auto facing = session.find(key);
  if (facing == session.end()) return;
  const auto avatar =
      plan_.attachments.find(trace_format::attachment_name(trace_format::AttachmentKind::kAvatar, person));
  const bool is_other = avatar != plan_.attachments.end() && !avatar->second.is_recorded;
  const bool is_axis = facing_named(facing->second).has_value();
  if (!is_axis) repaired(fmt::format("the session's {} '{}', which is no axis, was left out", key, facing->second));
  if (!is_axis || is_other) session.erase(facing);
}

/// Mends a format version that is not the one whose schemas the file has: then a bit of it was damaged.
void Recoverer::mend_version(mcap::StringMap& session) {
  const auto text = session.find(std::string(trace_format::kVersionKey));
  const std::optional<int> version = streams_of(output_.definitions()).version_of_schemas();
  if (text == session.end() || !version || text->second == fmt::format("{}", *version)) return;
  repaired(
      fmt::format("the session's format version '{}' became {}, whose schemas the file has", text->second, *version));
  text->second = fmt::format("{}", *version);
}

AttachmentFacts Recoverer::facts() const {
  AttachmentFacts facts = facts_;
  facts.claims.pose = pose_metadata(output_.streams());
  for (const auto& [person, channel] : output_.streams().pose_channels())
    if (const auto names = parse_node_names(*channel)) facts.pose_nodes[person] = names->size();
  return facts;
}

void Recoverer::note_attachment(const mcap::Attachment& attachment, std::string_view name, bool is_whole) {
  if (!trace_format::attachment_id(name)) return;
  if (is_whole && attachment.name == name)
    facts_.sha256[attachment.name] = sha256_hex(attachment.data);
  else
    facts_.damaged.emplace(name);
}

void Recoverer::take_attachment(Bytes content) {
  mcap::Attachment attachment = mcap::decode_attachment(content);
  const bool is_whole = mcap::attachment_crc_holds(content, attachment);
  const bool was_damaged = attachment.name.ends_with(kDamagedSuffix);
  const std::string name =
      attachment.name.substr(0, attachment.name.size() - (was_damaged ? kDamagedSuffix.size() : 0));
  note_attachment(attachment, name, is_whole);
  if (const auto planned = plan_.attachments.find(name); planned != plan_.attachments.end()) {
    replace(name, planned->second);
    // A damaged original stays beside a substitute that is not the recorded one.
    if (planned->second.is_recorded || (is_whole && !was_damaged)) return;
  }
  if (is_whole) {
    ++result_.attachments;
  } else {
    // Keep it, but under a name that nobody mistakes for the undamaged attachment.
    result_.damaged_attachments.push_back(attachment.name);
    attachment.name += kDamagedSuffix;
  }
  output_.write(attachment);
}

/// Writes what takes the place of an attachment, once.
void Recoverer::replace(const std::string& name, const Replacement& replacement) {
  if (!replaced_.insert(name).second) return;
  result_.replaced.push_back({.name = name,
                              .from = replacement.from,
                              .is_recorded = replacement.is_recorded,
                              .is_left_out = replacement.data == nullptr});
  if (replacement.is_recorded)
    repaired(fmt::format("{} takes the place of the attachment {}; its SHA-256 is the recorded one", replacement.from,
                         name));
  if (replacement.data == nullptr) return;
  output_.write(trace_format::attachment_of(name, *replacement.data));
  ++result_.attachments;
}

/// Writes the metadata record `replaced`, if something in the new file is not as recorded.
void Recoverer::write_replaced() {
  mcap::StringMap replaced = facts_.claims.replaced;
  for (const auto& [name, replacement] : plan_.attachments) {
    replaced.erase(name);
    if (!replacement.is_recorded)
      replaced[name] =
          replacement.data == nullptr ? std::string(trace_format::kLeftOut) : sha256_hex(*replacement.data);
  }
  if (replaced.empty()) return;
  output_.write(mcap::Metadata{.name = std::string(trace_format::kReplacedName), .metadata = std::move(replaced)});
  ++result_.metadata;
}

}  // namespace vestige
