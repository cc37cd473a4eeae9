#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>

#include "traces/mcap/time_range.hpp"

namespace vestige::cli {

/// The values of --from and --to.
struct RangeChoice {
  std::optional<double> from_s;
  std::optional<double> to_s;
};

/// Adds --from and --to. `from_remark` is more sentences about --from, without a last full stop. `verb` is "Keep" or
/// "Print".
void add_range_options(CLI::App& command, RangeChoice& choice, const std::string& verb,
                       const std::string& from_remark = "");

/// Throws `UsageError` if a value is not a time of a trace, or if --to is not after --from.
mcap::TimeRange range_of(const RangeChoice& choice);

}  // namespace vestige::cli
