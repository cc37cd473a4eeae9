#include "cli/files/range_choice.hpp"

#include <fmt/format.h>

#include <cmath>

#include "traces/base/error.hpp"

namespace vestige::cli {

namespace {

constexpr double kMost_s = 1.8e10;  ///< hardly less than 2^64 ns

std::uint64_t nanoseconds(double seconds, const std::string& flag) {
  if (!(seconds >= 0 && seconds < kMost_s))
    throw UsageError(flag, fmt::format("{} s is not a time in a trace", seconds),
                     "give seconds from the trace's start");
  return static_cast<std::uint64_t>(std::round(seconds * 1e9));
}

}  // namespace

void add_range_options(CLI::App& command, RangeChoice& choice, const std::string& verb,
                       const std::string& from_remark) {
  command
      .add_option("--from", choice.from_s,
                  fmt::format("{} messages at this time and later, in seconds of the trace{} [default: its start]",
                              verb, from_remark.empty() ? "" : ". " + from_remark))
      ->type_name("S");
  command
      .add_option(
          "--to", choice.to_s,
          fmt::format("{} messages before this time, not at it, in seconds of the trace [default: its end]", verb))
      ->type_name("S");
}

mcap::TimeRange range_of(const RangeChoice& choice) {
  mcap::TimeRange range;
  if (choice.from_s) range.from_ns = nanoseconds(*choice.from_s, "--from");
  if (choice.to_s) range.to_ns = nanoseconds(*choice.to_s, "--to");
  if (range.to_ns && range.from_ns >= *range.to_ns)
    throw UsageError("--to", "is not after --from", "make --to later than --from");
  return range;
}

}  // namespace vestige::cli
