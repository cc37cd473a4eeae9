#pragma once

#include <string>
#include <vector>

#include "analysis/claims/claims.hpp"

namespace vestige {

/// The results of one run, which lie in one folder.
struct Run {
  std::string folder;  ///< its name below the folder of results; empty if it is that folder
  std::vector<Result> results;
  std::vector<Claim> claims;
};

/// Returns the runs that these results make: one if a result lies directly in the folder of results, otherwise one for
/// each folder in it. What is no result is left out.
std::vector<Run> runs_of(const std::vector<Result>& results);

/// Returns "How fast?" and so on.
std::string heading_of(Question question);

/// Returns a page of Markdown: the claims by question, then the commands that made the results.
std::string claims_page(const std::vector<Run>& runs);

}  // namespace vestige
