#include "analysis/claims/claims.hpp"

#include <algorithm>

namespace vestige {

std::vector<Claim> claims_of(const std::vector<Result>& run) {
  std::vector<Claim> claims;
  for (const auto answer : {claims_how_fast, claims_how_right, claims_where_it_breaks, claims_how_it_scales})
    for (Claim& claim : answer(run)) claims.push_back(std::move(claim));
  for (const Result& result : run) {
    if (!result.json.is_object() || result.json.value("complete", true)) continue;
    for (Claim& claim : claims)
      if (std::ranges::find(claim.files, result.file) != claim.files.end() && !claim.text.ends_with(")**"))
        claim.text += " **(not complete: stopped before its end, or from a damaged trace)**";
  }
  return claims;
}

}  // namespace vestige
