#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>

#include "traces/mcap/time_range.hpp"

namespace vestige::cli {

/// --from and --to, as they were given.
struct RangeChoice {
  std::optional<double> from_s;
  std::optional<double> to_s;
};

/// Adds --from, which says what it does beyond the obvious, and --to; `verb` is "Keep" or "Print".
void add_range_options(CLI::App& command, RangeChoice& choice, const std::string& verb,
                       const std::string& from_remark = "");

/// Throws `UsageError`: no times of a trace, or --to not after --from.
mcap::TimeRange range_of(const RangeChoice& choice);

}  // namespace vestige::cli
