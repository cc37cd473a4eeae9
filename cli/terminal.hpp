#pragma once

#include <chrono>
#include <functional>
#include <string>
#include <string_view>

namespace vestige::cli {

/// Exit codes: what a script may rely on.
enum ExitCode {
  kDone = 0,
  kFailed = 1,
  kWrongUsage = 2,
  kDataLost = 3,     ///< done, but data was lost, repaired or dropped
  kCheckFailed = 4,  ///< --verify found a difference
};

/// A program's `main`: what `run` returns; where it throws, the message goes to standard error, and kWrongUsage
/// (`UsageError`) or kFailed is returned.
int run_program(int (*run)(int argc, char** argv), int argc, char** argv);

enum class Verbosity { kQuiet, kNormal, kVerbose };

/// "vestige: warning: …" on standard error; with kQuiet, nothing.
void warn(std::string_view text, Verbosity verbosity);

/// A progress bar with time left on standard error: only where that is a terminal, and never with kQuiet. Colour
/// follows NO_COLOR (https://no-color.org).
class Progress {
 public:
  Progress(std::string label, Verbosity verbosity);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// Share done, 0 … 1. Returns false when the user pressed Ctrl-C, so that it can be handed on as a callback.
  bool update(double share);

 private:
  std::string label_;
  bool shown_;
  bool colour_;
  std::chrono::steady_clock::time_point start_;
  std::chrono::steady_clock::time_point last_;
};

/// From now on SIGINT, SIGTERM and SIGHUP only set a flag, so that files are finished properly. A second one kills.
/// A SIGHUP that is ignored, as under nohup, stays so.
void catch_interrupts();
bool interrupted();

}  // namespace vestige::cli
