#include "traces/trace_file/session_check.hpp"

#include <fmt/format.h>

#include "traces/trace_file/trace_format.hpp"

namespace vestige {

std::vector<SessionProblem> check_session(const Session& session, const std::map<std::string, std::string>& sha256) {
  std::vector<SessionProblem> problems;
  for (const auto& [key, value] : session) {
    if (key == trace_format::kVersionKey && value != trace_format::kVersion)
      problems.push_back({fmt::format("its format version is '{}', not {}", value, trace_format::kVersion),
                          "a later version of vestige wrote it; this version does not understand the new parts"});
    if (!key.starts_with(trace_format::kSha256Prefix)) continue;
    const std::string name = key.substr(trace_format::kSha256Prefix.size());
    const auto attached = sha256.find(name);
    if (attached != sha256.end() && attached->second != value)
      problems.push_back({fmt::format("the attachment {} is not the recorded one: its SHA-256 differs", name),
                          "the frames may not fit it"});
  }
  return problems;
}

}  // namespace vestige
