#pragma once

#include <string>

#include "cli/options.hpp"
#include "traces/mcap/record_walker.hpp"
#include "traces/repair/rewrite.hpp"

namespace vestige::cli {

/// Says, as warnings, what of `file` could not be read and is not in what was made of it.
void warn_of_damage(const std::string& file, const mcap::DamageList& damages, Verbosity verbosity);

/// Writes `file` anew as `output`, complete or not at all, and says so; `doing` is the progress bar's label.
void run_rewrite(const std::string& file, const std::string& output, const RewriteOptions& how,
                 const std::string& doing, const CommonOptions& common, Invocation& invocation);

}  // namespace vestige::cli
