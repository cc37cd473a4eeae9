#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <memory>

#include "cli/verbs.hpp"
#include "traces/error.hpp"

namespace vestige::cli {

namespace {

/// Beside this very program, or else wherever PATH leads.
std::string plot_program() {
  std::error_code ignored;
  const auto self = std::filesystem::read_symlink("/proc/self/exe", ignored);
  const auto beside = self.parent_path() / "vestige-plot";
  return std::filesystem::exists(beside, ignored) ? beside.string() : "vestige-plot";
}

}  // namespace

int run_plot(const std::vector<std::string>& arguments) {
  std::vector<std::string> words = {plot_program()};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<char*> argv;
  argv.reserve(words.size() + 1);
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  pid_t child = 0;
  const int failure = ::posix_spawnp(&child, argv[0], nullptr, nullptr, argv.data(), environ);
  if (failure != 0)
    throw Error(
        "vestige-plot", fmt::format("cannot be run: {}", std::strerror(failure)),
        "it draws with VTK: install the package vestige-plot, or libvtk9-dev and build again, or put vestige-plot on "
        "the PATH");
  int status = 0;
  while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  return WIFEXITED(status) ? WEXITSTATUS(status) : kFailed;
}

void draw_figure(const std::string& kind, const std::string& folder, const CommonOptions& options) {
  std::vector<std::string> arguments = {kind, folder};
  if (options.force) arguments.emplace_back("--force");
  if (options.quiet) arguments.emplace_back("-q");
  std::fflush(stdout);  // before the child prints its own
  try {
    if (run_plot(arguments) != kDone) warn("the figure is not complete", options.verbosity());
  } catch (const Error& error) {
    warn(fmt::format("no figure was drawn: {}", error.what()), options.verbosity());
  }
}

void add_plot(CLI::App& program, Invocation& invocation) {
  CLI::App* verb = program.add_subcommand(
      "plot", "Draw results, traces and avatars as figures (runs vestige-plot, which links VTK)");
  verb->group("Verbs");
  // Everything behind the verb, --help included, is vestige-plot's business.
  verb->set_help_flag();
  verb->prefix_command();
  verb->callback([verb, &invocation] { invocation.exit_code = run_plot(verb->remaining()); });
}

}  // namespace vestige::cli
