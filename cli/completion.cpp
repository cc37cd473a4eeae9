#include "cli/help/completion.hpp"

#include <fmt/format.h>

#include <memory>

#include "cli/help/command_table.hpp"
#include "cli/verbs.hpp"

namespace vestige::cli {

void add_completion(CLI::App& program, Invocation&) {
  auto shell = std::make_shared<std::string>();
  CLI::App* verb =
      add_verb(program, "completion", "Print the script that lets a shell complete verbs, flags and values",
               "  vestige completion bash > vestige.bash\n"
               "  vestige completion fish > vestige.fish\n");
  verb->group(kShellVerbs);
  verb->add_option("SHELL", *shell, "The shell; the script's first lines say how to load it")
      ->required()
      ->check(CLI::IsMember({"bash", "zsh", "fish"}));
  verb->callback([shell] { fmt::print("{}", help::completion_script(*shell)); });
}

int complete(const CLI::App& program, const std::vector<std::string>& words) {
  if (words.size() > 1 && words.front() == "plot") {
    std::vector<std::string> arguments(words);
    arguments.front() = "complete";
    return run_plot(arguments);
  }
  fmt::print("{}", help::completions(help::command_table(program), words));
  return kDone;
}

}  // namespace vestige::cli
