#pragma once

#include <map>
#include <string>
#include <vector>

#include "traces/scene/trace.hpp"

namespace vestige {

struct SessionProblem {
  std::string what;
  std::string consequence;
};

/// Where a file contradicts its session: another format version than ours, or attachments whose SHA-256 is another than
/// when they were recorded. `sha256`: of the attachments that are there, by name.
std::vector<SessionProblem> check_session(const Session& session, const std::map<std::string, std::string>& sha256);

}  // namespace vestige
