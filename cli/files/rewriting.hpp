#pragma once

#include <span>
#include <string>

#include "cli/options.hpp"
#include "traces/mcap/record_walker.hpp"
#include "traces/repair/rewrite.hpp"

namespace vestige::cli {

/// Warns of the parts of `file` that could not be read and are missing from the result, but not again of those in
/// `told`.
void warn_of_damage(const std::string& file, const mcap::DamageList& damages, Verbosity verbosity,
                    std::span<const std::string> told = {});

/// Rewrites `file` as `output`, completely or not at all, and prints a summary. `doing` is the label of the progress
/// bar.
void run_rewrite(const std::string& file, const std::string& output, const RewriteOptions& how,
                 const std::string& doing, const CommonOptions& common, Invocation& invocation);

}  // namespace vestige::cli
