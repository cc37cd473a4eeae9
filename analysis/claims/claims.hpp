#pragma once

#include <string>
#include <vector>

#include "analysis/claims/result.hpp"

namespace vestige {

enum class Question { kHowFast, kHowRight, kWhereItBreaks, kHowItScales };

/// One answer: a sentence, and the result files that show it.
struct Claim {
  Question question;
  std::string topic;  ///< what the sentences of one file have in common; empty if it has one sentence
  std::string text;
  std::vector<std::string> files;  ///< as `Result::file`; the most telling ones first
  std::size_t links = 8;           ///< how many of the files the page links
};

/// Returns the claims that the results of one run show, by question. A recording, replay, sweep, growth, query,
/// accuracy, stress, agreement or decision benchmark shows some; any other JSON shows none. Throws `Error` if one of
/// those lacks a field.
std::vector<Claim> claims_of(const std::vector<Result>& run);

/// The claims to one question each.
std::vector<Claim> claims_how_fast(const std::vector<Result>& run);
std::vector<Claim> claims_how_right(const std::vector<Result>& run);
std::vector<Claim> claims_where_it_breaks(const std::vector<Result>& run);
std::vector<Claim> claims_how_it_scales(const std::vector<Result>& run);

}  // namespace vestige
