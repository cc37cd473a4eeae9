#pragma once

#include <chrono>
#include <functional>
#include <string>
#include <string_view>

namespace vestige::cli {

/// Exit codes, which scripts may rely on.
enum ExitCode {
  kDone = 0,
  kFailed = 1,
  kWrongUsage = 2,
  kDataLost = 3,     ///< done, but data was lost, repaired or dropped
  kCheckFailed = 4,  ///< --verify found a difference
};

/// The body of a program's `main`: returns the result of `run`. If `run` throws, prints the message to standard error
/// and returns kWrongUsage (for `UsageError`) or kFailed.
int run_program(int (*run)(int argc, char** argv), int argc, char** argv);

enum class Verbosity { kQuiet, kNormal, kVerbose };

/// Prints "vestige: warning: …" to standard error; with kQuiet, prints nothing.
void warn(std::string_view text, Verbosity verbosity);

/// Progress on standard error, with the remaining time: a bar on a terminal, otherwise, for logs, a line each
/// `line_every`. With kQuiet, nothing is shown. Colour follows NO_COLOR (https://no-color.org).
class Progress {
 public:
  Progress(std::string label, Verbosity verbosity, std::chrono::milliseconds line_every = std::chrono::seconds(30));
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// Takes the finished share, 0 … 1. Returns false if the user pressed Ctrl-C, so that the function can serve as a
  /// callback.
  bool update(double share);

 private:
  std::string label_;
  bool shown_;
  bool on_terminal_;
  bool colour_;
  std::chrono::milliseconds every_;  ///< between two that are shown
  std::chrono::steady_clock::time_point start_;
  std::chrono::steady_clock::time_point last_;
};

/// From now on, SIGINT, SIGTERM and SIGHUP only set a flag, so that files are finished properly. A second signal, 0.5 s
/// later or more, kills the program. A SIGHUP that is ignored, as under nohup, stays ignored.
void catch_interrupts();
bool interrupted();

/// The cause of an error about an output that an interrupt kept from being written.
inline constexpr std::string_view kStopped = "stopped by Ctrl-C; nothing was written";
/// The remedy for it.
inline constexpr std::string_view kStartAgain = "start it again";

}  // namespace vestige::cli
