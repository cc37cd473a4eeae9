#include <fmt/format.h>

#include <filesystem>
#include <memory>

#include "cli/help/command_table.hpp"
#include "cli/help/manual.hpp"
#include "cli/verbs.hpp"
#include "traces/base/error.hpp"
#include "traces/files/output_file.hpp"
#include "version.hpp"

namespace vestige::cli {

namespace {

struct ManOptions {
  std::string verb;
  std::string folder;
  bool force = false;
};

std::string page(const help::CommandTable& command) {
  return help::manual_page(command, help::VerbPages::kOwn, kVersion, kCommitDate);
}

/// Every page but that of `plot`, which vestige-plot prints.
void write_pages(const help::CommandTable& program, const ManOptions& options) {
  make_output_folder(options.folder);
  const std::filesystem::path folder = options.folder;
  const auto write = [&](const help::CommandTable& command) {
    OutputFile file(folder / (help::page_name(command) + ".1"), options.force ? Overwrite::kAllow : Overwrite::kRefuse);
    file.write(page(command));
    file.commit();
  };
  write(program);
  for (const help::CommandTable& verb : program.verbs)
    if (verb.verb != "plot") write(verb);
}

}  // namespace

void add_man(CLI::App& program, Invocation& invocation) {
  auto options = std::make_shared<ManOptions>();
  CLI::App* verb = add_verb(program, "man", "Print a man page, or write all of them",
                            "  vestige man replay | man -l -\n"
                            "  vestige man --pages man1\n");
  verb->group(kShellVerbs);
  verb->add_option("VERB", options->verb, "The verb [default: the page of vestige itself]");
  verb->add_option("--pages", options->folder, "Write vestige.1 and the page of every verb into this folder")
      ->type_name("DIR");
  verb->add_flag("--force", options->force, "Overwrite existing files");
  verb->get_option("--pages")->excludes(verb->get_option("VERB"));
  verb->get_option("--force")->needs(verb->get_option("--pages"));
  verb->callback([options, &program, &invocation] {
    const help::CommandTable table = help::command_table(program);
    if (!options->folder.empty()) return write_pages(table, *options);
    if (options->verb.empty()) return fmt::print("{}", page(table));
    if (options->verb == "plot") {
      invocation.exit_code = run_plot({"man"});
      return;
    }
    for (const help::CommandTable& command : table.verbs)
      if (command.verb == options->verb) return fmt::print("{}", page(command));
    throw UsageError(options->verb, "there is no such verb", "'vestige --help' lists the verbs");
  });
}

}  // namespace vestige::cli
