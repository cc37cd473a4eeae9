#include "traces/base/child_process.hpp"

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <exception>

#include "traces/base/system_error.hpp"

namespace vestige {

namespace {

[[noreturn]] void run_child(const std::function<void()>& work, std::uint64_t most_s) {
  static_cast<void>(::prctl(PR_SET_PDEATHSIG, SIGKILL));  // when the parent dies, the child dies too
  const rlimit no_core = {0, 0};
  static_cast<void>(::setrlimit(RLIMIT_CORE, &no_core));
  const rlimit time = {most_s, RLIM_INFINITY};
  static_cast<void>(::setrlimit(RLIMIT_CPU, &time));
  for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGSEGV, SIGBUS, SIGABRT, SIGFPE, SIGILL, SIGXCPU})
    static_cast<void>(std::signal(signal, SIG_DFL));
  // Output of a failing library is not for the user, who gets our own error message.
  if (const int nowhere = ::open("/dev/null", O_WRONLY | O_CLOEXEC); nowhere >= 0) {
    static_cast<void>(::dup2(nowhere, STDOUT_FILENO));
    static_cast<void>(::dup2(nowhere, STDERR_FILENO));
  }
  try {
    work();
  } catch (const std::exception&) {
    ::_exit(0);
  }
  ::_exit(0);
}

}  // namespace

int signal_that_ends(const std::function<void()>& work, std::uint64_t most_s) {
  const pid_t child = ::fork();
  if (child < 0) throw system_error("fork", "could not make a process", errno);
  if (child == 0) run_child(work, most_s);
  int status = 0;
  while (::waitpid(child, &status, 0) < 0)
    if (errno != EINTR) throw system_error("waitpid", "could not wait for a process", errno);
  return WIFSIGNALED(status) ? WTERMSIG(status) : 0;
}

}  // namespace vestige
