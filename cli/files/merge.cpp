#include "traces/repair/merge.hpp"

#include <fmt/format.h>

#include <memory>

#include "analysis/base/provenance.hpp"
#include "cli/files/export_formats.hpp"
#include "cli/files/rewriting.hpp"
#include "cli/verbs.hpp"
#include "traces/base/number_text.hpp"

namespace vestige::cli {

namespace {

struct MergeOptions {
  CommonOptions common;
  std::vector<std::string> files;
  std::string output;
};

void run_merge(const MergeOptions& options, Invocation& invocation) {
  const Verbosity verbosity = options.common.verbosity();
  check_outputs({options.output, options.common.json}, options.files, options.common);
  check_trace_name(options.output);
  if (options.output == "-") refuse_terminal("-o -");
  check_inputs(options.files);
  std::vector<std::unique_ptr<mcap::ByteSource>> sources;
  sources.reserve(options.files.size());
  for (const std::string& file : options.files) sources.push_back(std::make_unique<mcap::FileSource>(file));
  catch_interrupts();
  OutputFile written(options.output, options.common.overwrite());
  Merged merged;
  {
    Progress progress("Merging", verbosity);
    merged = merge_traces(
        sources, [&](mcap::Bytes bytes) { written.write(bytes); },
        [&](double share) { return progress.update(share); });
  }
  written.commit();
  for (const auto& [file, damages] : merged.damages) warn_of_damage(file, damages, verbosity);
  for (const Merged::OtherSession& other : merged.other_sessions)
    warn(fmt::format(
             "{}: seems to be from another recording than {}: their sessions differ in {}\n  Merge only parts of "
             "one recording.",
             other.file, options.files.front(), fmt::join(other.keys, ", ")),
         verbosity);
  if (merged.missing_frames > 0)
    warn(fmt::format("{}: lacks {} between its first and its last frame; no input file fills the gap", options.output,
                     counted(merged.missing_frames, "frame")),
         verbosity);
  write_json(options.common.json,
             with_provenance(invocation.argv, {{"files", options.files},
                                               {"output", options.output},
                                               {"messages", merged.messages},
                                               {"frames", merged.frames},
                                               {"duplicates", merged.duplicates},
                                               {"missing_frames", merged.missing_frames},
                                               {"complete", merged.damages.empty()}}),
             options.common);
  print_summary(fmt::format("{}: {} of {}\n", options.output, counted(merged.frames, "frame"),
                            counted(options.files.size(), "file")),
                {options.output, options.common.json}, options.common);
  if (!merged.damages.empty()) invocation.exit_code = kDataLost;
}

}  // namespace

void add_merge(CLI::App& program, Invocation& invocation) {
  auto options = std::make_shared<MergeOptions>();
  CLI::App* verb = add_verb(program, "merge", "Put parts of one recording together, in order of time",
                            "  vestige merge beginning.mcap end.mcap -o man.mcap\n"
                            "  vestige merge part-*.mcap -o man.mcap --json merge.json\n");
  verb->add_option("FILE", options->files,
                   "The parts, in any order. A frame that several parts contain must be the same in all of them")
      ->required();
  verb->add_option("-o,--output", options->output, "The trace to write, or '-' for standard output")
      ->required()
      ->type_name("OUT.mcap|-");
  add_common_options(*verb, options->common);
  verb->callback([options, &invocation] { run_merge(*options, invocation); });
}

}  // namespace vestige::cli
