#include <memory>

#include "cli/files/range_choice.hpp"
#include "cli/files/rewriting.hpp"
#include "cli/verbs.hpp"
#include "traces/base/error.hpp"

namespace vestige::cli {

namespace {

struct TrimOptions {
  CommonOptions common;
  std::string file;
  std::string output;
  RangeChoice range;
};

void run_trim(const TrimOptions& options, Invocation& invocation) {
  if (!options.range.from_s && !options.range.to_s)
    throw UsageError("trim", "the time range to keep is missing", "give --from, --to or both");
  run_rewrite(options.file, options.output, {.range = range_of(options.range)}, "Trimming", options.common, invocation);
}

}  // namespace

void add_trim(CLI::App& program, Invocation& invocation) {
  auto options = std::make_shared<TrimOptions>();
  CLI::App* verb = add_verb(program, "trim", "Keep a time range of a trace",
                            "  vestige trim man.mcap --from 0.5 --to 1.5 -o middle.mcap\n"
                            "  vestige trim man.mcap --to 1 -o beginning.mcap\n");
  verb->add_option("FILE", options->file, "The trace, or any MCAP file, or '-' for standard input")->required();
  add_range_options(
      *verb, options->range, "Keep",
      "The first kept frame has no contacts, because no frame comes before it. Frames keep their numbers and times");
  verb->add_option("-o,--output", options->output, "The file to write, or '-' for standard output")
      ->required()
      ->type_name("OUT.mcap|-");
  add_common_options(*verb, options->common);
  verb->callback([options, &invocation] { run_trim(*options, invocation); });
}

}  // namespace vestige::cli
