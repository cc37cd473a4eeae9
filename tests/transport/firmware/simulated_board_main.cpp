// The vest's board without the board: runs the firmware in step with the clock, behind a pseudo terminal that a client
// opens as it would /dev/ttyUSB0, and measures at its outputs what the motors would get.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <string>

#include "tests/transport/firmware/board_terminal.hpp"
#include "tests/transport/firmware/simulated_board.hpp"
#include "traces/base/error.hpp"
#include "traces/files/output_file.hpp"

namespace {

volatile std::sig_atomic_t stop = 0;
volatile std::sig_atomic_t power_cycle = 0;

void catch_signals() {
  struct sigaction action {};
  action.sa_handler = [](int) { stop = 1; };
  ::sigaction(SIGINT, &action, nullptr);
  ::sigaction(SIGTERM, &action, nullptr);
  action.sa_handler = [](int) { power_cycle = 1; };
  ::sigaction(SIGUSR1, &action, nullptr);
}

struct Options {
  std::string firmware, microcontroller, link, duties;
  std::uint32_t baud = 57600;
  std::size_t chips = 0;
  double duration_s = 0;
  bool force = false;
};

void check_chips(vestige::test::SimulatedBoard& board, const Options& options) {
  if (board.chips().is_used() == (options.chips > 0)) return;
  if (options.chips == 0)
    throw vestige::Error(options.firmware, "this firmware drives motors through PCA9685 chips, and the board has none",
                         "say how many it has: --chips N");
  throw vestige::Error(options.firmware, "this firmware drives motors on pins, and the board has chips",
                       "leave --chips out, or give a firmware for chips: vest-atmega1280-16.elf");
}

void simulate(const Options& options) {
  using Clock = std::chrono::steady_clock;
  // What a USB adapter would hold: the rest waits in the terminal, where a client sees it.
  constexpr std::size_t kAdapterBytes = 64;
  constexpr std::int64_t kStep_us = 500;
  constexpr double kCatchUp_s = 1e-3;
  constexpr double kCycles_s = 1e-6;  // what rounding to whole ones may leave

  if (!options.duties.empty())
    vestige::refuse_overwrite(options.duties, options.force ? vestige::Overwrite::kAllow : vestige::Overwrite::kRefuse);
  vestige::test::SimulatedBoard board(options.firmware, options.microcontroller, options.baud, options.chips);
  vestige::test::BoardTerminal terminal(options.link);
  catch_signals();
  board.run_for(0.05);  // whoever reads the name finds the board started, and its chips
  check_chips(board, options);
  fmt::print("{}\n", terminal.name());
  std::fflush(stdout);

  std::size_t bytes_in = 0;
  std::size_t bytes_out = 0;
  const double start_s = board.time_s();
  const Clock::time_point start = Clock::now();
  while (stop == 0 && (options.duration_s <= 0 || board.time_s() < options.duration_s)) {
    terminal.wait(kStep_us);
    if (power_cycle != 0) {
      power_cycle = 0;
      board.power_cycle();
    }
    // In steps, since a machine that is busy elsewhere leaves much to catch up with.
    const double now_s = start_s + std::chrono::duration<double>(Clock::now() - start).count();
    do {
      board.run_until(std::min(now_s, board.time_s() + kCatchUp_s));
      if (board.waiting() < kAdapterBytes) {
        const auto bytes = terminal.read(kAdapterBytes - board.waiting());
        bytes_in += bytes.size();
        board.send(bytes);
      }
      const auto bytes = board.take_received();
      bytes_out += bytes.size();
      terminal.write(bytes);
    } while (board.time_s() < now_s - kCycles_s);
  }
  if (!options.duties.empty()) board.write_duties(options.duties);
  fmt::print(stderr, "simulated_board: {:.3f} s, {} bytes received, {} bytes sent, {} start{}\n", board.time_s(),
             bytes_in, bytes_out, board.starts(), board.starts() == 1 ? "" : "s");
  const auto& answers = board.answer_times();
  if (answers.count != 0)
    fmt::print(stderr,
               "simulated_board: {} answers, each {:.1f} us of virtual time after its frame, {:.1f} us at most\n",
               answers.count, answers.total_s / static_cast<double>(answers.count) * 1e6, answers.longest_s * 1e6);
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  CLI::App app(
      "Runs the vest's firmware on a simulated microcontroller. The first line printed is the terminal to connect to.\n"
      "SIGUSR1 interrupts the board's power; SIGINT and SIGTERM end the simulation.\n",
      "simulated_board");
  app.add_option("firmware", options.firmware, "The firmware: build/release/firmware/vest-atmega1280.elf")->required();
  app.add_option("--mcu", options.microcontroller, "atmega1280 or atmega2560; else what the firmware was linked for");
  app.add_option("--link", options.link, "Make a symbolic link of this name to the terminal");
  app.add_option("--duties", options.duties, "At the end, write the duties measured at the outputs to this CSV file");
  app.add_flag("--force", options.force, "Overwrite that file");
  app.add_option("--baud", options.baud, "Speed of the line")->capture_default_str()->check(CLI::Range(300, 2'000'000));
  app.add_option("--chips", options.chips, "Number of PCA9685 chips on the board; 0: motors on pins")
      ->capture_default_str()
      ->check(CLI::Range(0, 4));
  app.add_option("--duration", options.duration_s, "Seconds until the end; else until a signal")
      ->check(CLI::NonNegativeNumber);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  }
  try {
    simulate(options);
  } catch (const std::exception& error) {
    fmt::print(stderr, "simulated_board: {}\n", error.what());
    return 1;
  }
  return 0;
}
