#pragma once

#include <fcntl.h>
#include <sys/types.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace vestige::test {

/// A program that runs beside the test, from the built programs or from another folder. The destructor kills the
/// program if it still runs.
class BackgroundProcess {
 public:
  /// Starts the program. Its standard error goes to the file `standard_error`.
  BackgroundProcess(std::vector<std::string> arguments, const std::filesystem::path& standard_error,
                    const std::filesystem::path& programs = VESTIGE_BIN_DIR) {
    arguments[0] = (programs / arguments[0]).string();
    std::vector<char*> argv;
    argv.reserve(arguments.size() + 1);
    for (std::string& argument : arguments) argv.push_back(argument.data());
    argv.push_back(nullptr);
    int output[2];
    if (::pipe2(output, O_CLOEXEC) != 0) throw std::runtime_error("pipe2 failed");
    process_ = ::fork();
    if (process_ == 0) {
      const int error = ::open(standard_error.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
      ::dup2(output[1], STDOUT_FILENO);
      ::dup2(error, STDERR_FILENO);
      ::execv(argv[0], argv.data());
      ::_exit(127);
    }
    ::close(output[1]);
    output_ = output[0];
  }
  ~BackgroundProcess() {
    if (process_ > 0) {
      signal(SIGKILL);
      wait();
    }
    ::close(output_);
  }
  BackgroundProcess(const BackgroundProcess&) = delete;
  BackgroundProcess& operator=(const BackgroundProcess&) = delete;

  /// Waits for the next line of the program's standard output. Returns it without the newline, or empty at the end.
  std::string line() {
    std::string text;
    for (char letter = 0; ::read(output_, &letter, 1) == 1 && letter != '\n';) text += letter;
    return text;
  }
  void signal(const int number) const { ::kill(process_, number); }
  /// Waits for the program's end. Returns its exit code, or 128 plus the number of the signal that killed it.
  int wait() {
    int status = 0;
    ::waitpid(std::exchange(process_, -1), &status, 0);
    return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  }

 private:
  pid_t process_ = -1;
  int output_ = -1;
};

}  // namespace vestige::test
