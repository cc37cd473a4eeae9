#include "cli/terminal.hpp"

#include <fcntl.h>
#include <fmt/color.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <new>
#include <utility>

#include "traces/base/descriptor.hpp"
#include "traces/base/error.hpp"

namespace vestige::cli {

namespace {

constexpr int kBarCells = 30;

/// One Ctrl-C can arrive twice: timeout(1), for one, signals its child and the group that the child is in.
constexpr double kSameInterrupt_s = 0.5;

volatile std::sig_atomic_t interrupt_seen = 0;
timespec interrupted_at = {};

void on_interrupt(int signal_number) {
  if (interrupt_seen == 0) {
    ::clock_gettime(CLOCK_MONOTONIC, &interrupted_at);
    interrupt_seen = 1;
    return;
  }
  timespec now = {};
  ::clock_gettime(CLOCK_MONOTONIC, &now);
  const double since_s = static_cast<double>(now.tv_sec - interrupted_at.tv_sec) +
                         1e-9 * static_cast<double>(now.tv_nsec - interrupted_at.tv_nsec);
  if (since_s < kSameInterrupt_s) return;
  std::signal(signal_number, SIG_DFL);
  std::raise(signal_number);  // comes as soon as this returns
}

/// Where a standard stream was closed, the first file that is opened would take its place, and messages would end up in
/// it. What takes it here refuses to be read or written, as one that is closed does.
void fill_closed_streams() {
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    if (::fcntl(stream, F_GETFD) >= 0 || errno != EBADF) continue;
    [[maybe_unused]] const int taken = ::open("/dev/null", stream == STDIN_FILENO ? O_WRONLY : O_RDONLY);
  }
}

}  // namespace

void warn(std::string_view text, Verbosity verbosity) {
  if (verbosity != Verbosity::kQuiet) print_message(fmt::format("vestige: warning: {}\n", printable(text)));
}

Progress::Progress(std::string label, Verbosity verbosity, std::chrono::milliseconds line_every)
    : label_(std::move(label)),
      shown_(verbosity != Verbosity::kQuiet),
      on_terminal_(::isatty(STDERR_FILENO) != 0),
      colour_(std::getenv("NO_COLOR") == nullptr),
      every_(on_terminal_ ? std::chrono::milliseconds(100) : line_every),
      start_(std::chrono::steady_clock::now()),
      last_(start_) {}

Progress::~Progress() {
  if (shown_ && on_terminal_) std::fputs("\r\033[K", stderr);  // does not throw when the terminal has gone
}

bool Progress::update(double share) {
  const auto now = std::chrono::steady_clock::now();
  if (shown_ && now - last_ >= every_) {
    last_ = now;
    const double spent_s = std::chrono::duration<double>(now - start_).count();
    const double left_s = share > 0 ? spent_s * (1 - share) / share : 0;
    if (!on_terminal_) {
      const std::string left = share > 0 ? fmt::format(", about {:.0f} s left", left_s) : "";
      print_message(fmt::format("vestige: {}: {:.0f} %{}\n", label_, 100 * share, left));
      return !interrupted();
    }
    const int full = std::clamp(static_cast<int>(share * kBarCells), 0, kBarCells);
    const std::string bar = std::string(static_cast<std::size_t>(full), '#');
    const std::string rest = std::string(static_cast<std::size_t>(kBarCells - full), '.');
    const std::string drawn = colour_ ? fmt::format(fmt::fg(fmt::terminal_color::green), "{}", bar) : bar;
    print_message(fmt::format("\r\033[K{} [{}{}] {:3.0f} %, {:.0f} s left", label_, drawn, rest, 100 * share, left_s));
    std::fflush(stderr);
  }
  return !interrupted();
}

int run_program(int (*run)(int argc, char** argv), int argc, char** argv) {
  fill_closed_streams();
  // A closed pipe is an error of write(), not a silent death that leaves temporary files behind.
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGXFSZ, SIG_IGN);  // so is a file that ulimit -f does not allow
  try {
    return run(argc, argv);
  } catch (const UsageError& error) {
    print_message(fmt::format("vestige: error: {}\n", error.what()));
    return kWrongUsage;
  } catch (const std::bad_alloc&) {
    print_message("vestige: error: out of memory\n");
    return kFailed;
  } catch (const std::exception& error) {
    print_message(fmt::format("vestige: error: {}\n", error.what()));
    return kFailed;
  }
}

void catch_interrupts() {
  stop_waiting_when(interrupted);
  std::signal(SIGINT, on_interrupt);
  std::signal(SIGTERM, on_interrupt);
  // Where it is ignored, as nohup does, the run is to outlive its terminal.
  struct sigaction hangup = {};
  ::sigaction(SIGHUP, nullptr, &hangup);
  if (hangup.sa_handler != SIG_IGN) std::signal(SIGHUP, on_interrupt);
}

bool interrupted() {
  return interrupt_seen != 0;
}

}  // namespace vestige::cli
