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

/// Returns the contradictions between a file and its session: an unknown format version, or attachments whose SHA-256
/// differs from the recorded one. `sha256` holds the hashes of the attachments present, by name.
std::vector<SessionProblem> check_session(const Session& session, const std::map<std::string, std::string>& sha256);

}  // namespace vestige
