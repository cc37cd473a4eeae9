#include <fmt/format.h>

#include <cmath>
#include <memory>
#include <optional>

#include "cli/rewriting.hpp"
#include "cli/verbs.hpp"
#include "traces/error.hpp"

namespace vestige::cli {

namespace {

constexpr double kMost_s = 1.8e10;  ///< 2^64 nanoseconds, and some

struct TrimOptions {
  CommonOptions common;
  std::string file;
  std::string output;
  std::optional<double> from_s;
  std::optional<double> to_s;
};

std::uint64_t nanoseconds(double seconds, const std::string& flag) {
  if (!(seconds >= 0 && seconds < kMost_s))
    throw UsageError(flag, fmt::format("{} s is no time in a trace", seconds), "give seconds from the trace's start");
  return static_cast<std::uint64_t>(std::round(seconds * 1e9));
}

void run_trim(const TrimOptions& options, Invocation& invocation) {
  if (!options.from_s && !options.to_s)
    throw UsageError("trim", "nothing says what to keep", "give --from, --to or both");
  RewriteOptions how;
  if (options.from_s) how.range.from_ns = nanoseconds(*options.from_s, "--from");
  if (options.to_s) how.range.to_ns = nanoseconds(*options.to_s, "--to");
  if (how.range.from_ns >= how.range.to_ns)
    throw UsageError("--to", "is not after --from", "the first time to leave out comes after the first to keep");
  run_rewrite(options.file, options.output, how, "Trimming", options.common, invocation);
}

}  // namespace

void add_trim(CLI::App& program, Invocation& invocation) {
  auto options = std::make_shared<TrimOptions>();
  CLI::App* verb = add_verb(program, "trim", "Keep some of a trace's time",
                            "  vestige trim man.mcap --from 0.5 --to 1.5 -o middle.mcap\n"
                            "  vestige trim man.mcap --to 1 -o beginning.mcap\n");
  verb->add_option("FILE", options->file, "The trace, or any MCAP file, or '-' for standard input")->required();
  verb->add_option("--from", options->from_s,
                   "Keep what is at this time or later, in seconds of the trace. The first frame kept has no contacts, "
                   "since no frame leads to it; numbers and times of frames stay as they were [default: its start]")
      ->type_name("S");
  verb->add_option("--to", options->to_s, "Keep what is before this time, in seconds of the trace [default: its end]")
      ->type_name("S");
  verb->add_option("-o,--output", options->output, "The file to write, or '-' for standard output")
      ->required()
      ->type_name("OUT.mcap|-");
  add_common_options(*verb, options->common);
  verb->callback([options, &invocation] { run_trim(*options, invocation); });
}

}  // namespace vestige::cli
