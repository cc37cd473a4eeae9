#include <fmt/format.h>

#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <utility>

#include "cli/command_line.hpp"
#include "cli/help/help_text.hpp"
#include "cli/help/manual.hpp"
#include "cli/verbs.hpp"
#include "traces/base/system_error.hpp"
#include "version.hpp"

namespace vestige::cli {

CLI::App* add_verb(CLI::App& program, const std::string& name, const std::string& summary,
                   const std::string& examples) {
  CLI::App* verb = program.add_subcommand(name, summary);
  verb->formatter(std::make_shared<help::HelpFormatter>(examples));
  verb->set_help_flag("-h,--help", "Print this help");
  verb->group("Verbs");
  return verb;
}

namespace {

std::string footer() {
  std::string text = "'vestige VERB --help' explains each verb. Exit codes:";
  for (const auto& [code, meaning] : help::kExitCodes) text += fmt::format(" {} {};", code, meaning);
  text.back() = '.';
  return text;
}

int run(int argc, char** argv) {
  CLI::App program(
      "Record traces of an animated avatar and the colliders around it, replay them through a geometry-shader "
      "collision "
      "detector, measure that detector, and turn contacts into a haptic vest's vibration",
      "vestige");
  program.option_defaults()->disable_flag_override();  // --loop=3 is no three rounds
  program.formatter(std::make_shared<help::HelpFormatter>(
      "  vestige record -o man.mcap\n"
      "  vestige replay man.mcap --contacts contacts.csv --timeline timeline.csv\n"));
  program.set_version_flag("--version",
                           fmt::format("vestige {} ({}{})", kVersion, kCommit, kDirty ? ", modified" : ""));
  program.require_subcommand(1);
  Invocation invocation;
  invocation.argv.assign(argv, argv + argc);
  add_record(program, invocation);
  add_replay(program, invocation);
  add_view(program, invocation);
  add_viz(program, invocation);
  add_stream(program, invocation);
  add_live(program, invocation);
  add_vest(program, invocation);
  add_sweep(program, invocation);
  add_growth(program, invocation);
  add_compare(program, invocation);
  add_query(program, invocation);
  add_stress(program, invocation);
  add_accuracy(program, invocation);
  add_batch(program, invocation);
  add_inspect(program, invocation);
  add_doctor(program, invocation);
  add_recover(program, invocation);
  add_recompress(program, invocation);
  add_trim(program, invocation);
  add_merge(program, invocation);
  add_cat(program, invocation);
  add_export(program, invocation);
  add_import(program, invocation);
  add_explain(program, invocation);
  add_avatar(program, invocation);
  add_map(program, invocation);
  add_devices(program, invocation);
  add_plot(program, invocation);
  add_claims(program, invocation);
  add_completion(program, invocation);
  add_man(program, invocation);
  program.get_option("--version")->description("Print version and commit");
  program.set_help_flag("-h,--help", "Print this help");
  // After the verbs, which would take it over.
  program.footer(footer());
  if (argc > 1 && std::string_view(argv[1]) == "complete") return complete(program, {argv + 2, argv + argc});
  if (const auto exit_code = parse_command_line(program, "verb", argc, argv)) return *exit_code;
  if (std::fflush(stdout) != 0) throw system_error("standard output", "could not write", errno);
  return invocation.exit_code;
}

}  // namespace
}  // namespace vestige::cli

int main(int argc, char** argv) {
  // A detector's frequency is that of one thread. llvmpipe's own pool adds nothing to it, and takes 18 us to start on a
  // frame of `compute`. Whoever sets the variable has a reason.
  ::setenv("LP_NUM_THREADS", "0", 0);
  return vestige::cli::run_program(vestige::cli::run, argc, argv);
}
