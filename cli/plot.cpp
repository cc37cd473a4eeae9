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
#include "traces/base/error.hpp"

namespace vestige::cli {

namespace {

/// Beside this very program, or else wherever PATH leads.
std::string plot_program() {
  std::error_code ignored;
  const auto self = std::filesystem::read_symlink("/proc/self/exe", ignored);
  const auto beside = self.parent_path() / "vestige-plot";
  return std::filesystem::exists(beside, ignored) ? beside.string() : "vestige-plot";
}

/// The program and its arguments, as exec takes them.
class PlotCommand {
 public:
  explicit PlotCommand(const std::vector<std::string>& arguments) : words_{plot_program()} {
    words_.insert(words_.end(), arguments.begin(), arguments.end());
    argv_.reserve(words_.size() + 1);
    for (std::string& word : words_) argv_.push_back(word.data());
    argv_.push_back(nullptr);
  }
  char* const* argv() const { return argv_.data(); }

 private:
  std::vector<std::string> words_;
  std::vector<char*> argv_;
};

Error cannot_run(int failure) {
  return Error(
      "vestige-plot", fmt::format("cannot be run: {}", std::strerror(failure)),
      "it draws with VTK: install the package vestige-plot, or libvtk9-dev and build again, or put vestige-plot on "
      "the PATH");
}

/// Instead of this program, so that a signal reaches the one that draws.
[[noreturn]] void become_plot(const std::vector<std::string>& arguments) {
  const PlotCommand command(arguments);
  std::fflush(stdout);
  ::execvp(command.argv()[0], command.argv());
  throw cannot_run(errno);
}

}  // namespace

int run_plot(const std::vector<std::string>& arguments) {
  const PlotCommand command(arguments);
  pid_t child = 0;
  const int failure = ::posix_spawnp(&child, command.argv()[0], nullptr, nullptr, command.argv(), environ);
  if (failure != 0) throw cannot_run(failure);
  int status = 0;
  while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  return WIFEXITED(status) ? WEXITSTATUS(status) : kFailed;
}

void draw_or_remove_figure(const std::string& kind, const std::string& name, const std::string& folder, bool wanted,
                           const CommonOptions& options) {
  if (!wanted) {
    // What --force has replaced must not stand beside a figure of what was there before.
    std::error_code ignored;
    for (const char* extension : {".png", ".svg"})
      std::filesystem::remove(std::filesystem::path(folder) / (name + extension), ignored);
    return;
  }
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

void add_plot(CLI::App& program, Invocation&) {
  CLI::App* verb = program.add_subcommand(
      "plot", "Draw results, traces and avatars as figures (runs vestige-plot, which links VTK)");
  verb->group("Verbs");
  // Everything behind the verb, --help included, is vestige-plot's business.
  verb->set_help_flag();
  verb->prefix_command();
  verb->callback([verb] { become_plot(verb->remaining()); });
}

}  // namespace vestige::cli
