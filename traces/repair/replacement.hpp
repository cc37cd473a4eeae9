#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "traces/trace_file/session_check.hpp"

namespace vestige {

/// A person's avatar, or map with its sidecar, that takes the place of damaged or missing attachments.
struct Substitute {
  std::size_t person = 0;
  std::string from;                                     ///< as the user named it, for errors
  std::map<std::string, std::vector<std::byte>> files;  ///< by the attachment's name
};

struct Substitutes {
  std::vector<Substitute> avatars;  ///< at most one for each person
  std::vector<Substitute> maps;     ///< likewise
  /// The remedy of the error that refuses a substitute whose SHA-256 is not the recorded one. Nothing: such a
  /// substitute is accepted.
  std::optional<std::string> refusal = "";

  bool empty() const { return avatars.empty() && maps.empty(); }
};

/// What a damaged file still has, and says about its attachments.
struct AttachmentFacts {
  AttachmentClaims claims;
  std::map<std::string, std::string> sha256;      ///< of Vestige's own attachments that are undamaged, by name
  std::set<std::string> damaged;                  ///< names of those that are damaged
  std::map<std::size_t, std::size_t> pose_nodes;  ///< nodes of each pose, by person; empty: not a Vestige trace
};

/// What takes the place of an attachment.
struct Replacement {
  std::string from;
  const std::vector<std::byte>* data = nullptr;  ///< null: nothing; the attachment is left out
  bool is_recorded = false;                      ///< its SHA-256 is the recorded one
};

struct ReplacementPlan {
  std::map<std::string, Replacement> attachments;  ///< by name
  std::vector<std::string> unused;                 ///< `from` of substitutes that nothing needs
};

/// Decides which attachments to replace: those that are damaged, missing or not the recorded ones. Image and sidecar of
/// a map are replaced one by one if each has the recorded SHA-256, otherwise both together. The plan refers to
/// `substitutes`.
///
/// Throws `Error` with file and remedy if `file` is not a trace; if an avatar has another number of nodes than the
/// poses; if the trace was recorded without a map; and, unless accepted, if a substitute is not the recorded one or the
/// file does not say which one that is; if there is no such person.
ReplacementPlan plan_replacements(std::string_view file, const AttachmentFacts& facts, const Substitutes& substitutes);

}  // namespace vestige
