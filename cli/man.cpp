#include <fmt/format.h>

#include <filesystem>
#include <memory>

#include "cli/help/command_table.hpp"
#include "cli/help/manual.hpp"
#include "cli/help/markdown.hpp"
#include "cli/verbs.hpp"
#include "traces/base/error.hpp"
#include "traces/files/output_file.hpp"
#include "version.hpp"

namespace vestige::cli {

namespace {

struct ManOptions {
  std::string verb;
  std::string man_folder;
  std::string markdown_folder;
  bool force = false;
};

std::string page(const help::CommandTable& command) {
  return help::manual_page(command, help::VerbPages::kOwn, kVersion, kCommitDate);
}

void write_page(const std::string& folder, const std::string& name, const std::string& text, Overwrite overwrite) {
  OutputFile file(std::filesystem::path(folder) / name, overwrite);
  file.write(text);
  file.commit();
}

/// Every page but that of `plot`, which vestige-plot prints.
void write_pages(const help::CommandTable& program, const ManOptions& options) {
  const bool is_markdown = !options.markdown_folder.empty();
  const std::string& folder = is_markdown ? options.markdown_folder : options.man_folder;
  const Overwrite overwrite = options.force ? Overwrite::kAllow : Overwrite::kRefuse;
  make_output_folder(folder);
  if (is_markdown)
    write_page(folder, "README.md", help::markdown_index(program), overwrite);
  else
    write_page(folder, help::page_name(program) + ".1", page(program), overwrite);
  for (const help::CommandTable& verb : program.verbs) {
    if (verb.verb == "plot") continue;
    if (is_markdown)
      write_page(folder, help::markdown_name(verb), help::markdown_page(verb), overwrite);
    else
      write_page(folder, help::page_name(verb) + ".1", page(verb), overwrite);
  }
}

}  // namespace

void add_man(CLI::App& program, Invocation& invocation) {
  auto options = std::make_shared<ManOptions>();
  CLI::App* verb = add_verb(program, "man", "Print a man page, or write all of them",
                            "  vestige man replay | man -l -\n"
                            "  vestige man --pages man1\n");
  verb->group(kShellVerbs);
  verb->add_option("VERB", options->verb, "The verb [default: the page of vestige itself]");
  verb->add_option(
          "--pages", options->man_folder,
          "Write vestige.1 and a page for every verb except plot into this folder; 'vestige man plot' prints plot's "
          "page")
      ->type_name("DIR");
  verb->add_option(
          "--markdown", options->markdown_folder,
          "Write README.md and a page for every verb except plot, as Markdown, into this folder; 'vestige-plot man "
          "--markdown' prints plot.md")
      ->type_name("DIR");
  verb->add_flag("--force", options->force, "With --pages or --markdown: overwrite existing files");
  verb->get_option("--pages")->excludes(verb->get_option("VERB"));
  verb->get_option("--markdown")->excludes(verb->get_option("VERB"))->excludes(verb->get_option("--pages"));
  verb->callback([options, &program, &invocation] {
    const help::CommandTable table = help::command_table(program);
    if (!options->man_folder.empty() || !options->markdown_folder.empty()) return write_pages(table, *options);
    if (options->force) throw UsageError("--force", "there is nothing to overwrite", "add --pages or --markdown");
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
