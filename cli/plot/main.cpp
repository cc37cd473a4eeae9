#include <fmt/format.h>
#include <malloc.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "cli/command_line.hpp"
#include "cli/help/command_table.hpp"
#include "cli/help/completion.hpp"
#include "cli/help/help_text.hpp"
#include "cli/help/manual.hpp"
#include "cli/help/markdown.hpp"
#include "cli/plot/verbs.hpp"
#include "cli/terminal.hpp"
#include "traces/base/error.hpp"
#include "traces/base/system_error.hpp"
#include "version.hpp"

namespace {

using vestige::plot::Options;
namespace help = vestige::help;

/// What `vestige` and the reference ask of this program: completion, and pages of `vestige plot`.
void answer(const std::string& word, const CLI::App& app, const std::vector<std::string>& words) {
  const help::CommandTable table = help::command_table(app);
  if (word == "complete")
    fmt::print("{}", help::completions(table, words));
  else if (words == std::vector<std::string>{"--markdown"})
    fmt::print("{}", help::markdown_page(table));
  else
    fmt::print("{}", help::manual_page(table, help::VerbPages::kNone, vestige::kVersion, vestige::kCommitDate));
  if (std::fflush(stdout) != 0) throw vestige::system_error("standard output", "could not write", errno);
}

int run(int argc, char** argv) {
  Options options;
  CLI::App app("Draw results, traces and avatars as figures, SVG and PNG (300 dots per inch), and traces as films",
               "vestige plot");
  app.option_defaults()->disable_flag_override();
  app.formatter(
      std::make_shared<help::HelpFormatter>("  vestige plot sweep results/sweep\n"
                                            "  vestige plot body man.mcap --contacts contacts.csv\n"));
  app.set_version_flag("--version", fmt::format("vestige-plot {} ({}{})", vestige::kVersion, vestige::kCommit,
                                                vestige::kDirty ? ", modified" : ""));
  app.get_option("--version")->description("Print version and commit");
  app.require_subcommand(1);
  const std::vector<vestige::plot::Verb> verbs = vestige::plot::add_verbs(app, options);
  app.set_help_flag("-h,--help", "Print this help");
  const std::string word = argc > 1 ? argv[1] : "";
  if (word == "complete" || word == "man") {
    answer(word, app, {argv + 2, argv + argc});
    return vestige::cli::kDone;
  }
  if (const auto exit_code = vestige::cli::parse_command_line(app, "figure", argc, argv)) return *exit_code;
  if (options.output == "-")
    throw vestige::UsageError("-o -", "figures are not written to standard output", "name a file: -o FILE");
  return std::ranges::find_if(verbs, [](const auto& verb) { return verb.command->parsed(); })->draw(options);
}

}  // namespace

int main(int argc, char** argv) {
  // Pictures are large, and one follows the other: memory that is kept costs half the time of memory asked for anew.
  mallopt(M_MMAP_THRESHOLD, 1 << 30);
  mallopt(M_TRIM_THRESHOLD, 1 << 30);
  mallopt(M_TOP_PAD, 1 << 26);
  return vestige::cli::run_program(run, argc, argv);
}
