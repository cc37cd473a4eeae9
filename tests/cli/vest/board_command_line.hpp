#pragma once

#include <string>

#include "tests/support/command_line.hpp"

namespace vestige::test {

/// Streams traces to a simulated board, as a user does.
class BoardCommandLine : public CommandLineTest {
 protected:
  void record(const std::string& flags) const {
    ASSERT_EQ(run("vestige record -q -o trace.mcap " + flags).exit_code, 0);
  }

  /// Runs `command` beside a board whose pty is called 'vest' and whose outputs end up in pins.csv. `chips` is the
  /// number of PCA9685 that drive its motors; 0: pins do.
  Outcome run_with_board(const std::string& command, const std::string& firmware = "vest-atmega1280",
                         const int chips = 0) const {
    return run(board(firmware, "", chips) + command + "\ncode=$?; kill -INT $board; wait $board; exit $code");
  }

  /// The same beside a second board, 'vest2', whose pins end up in pins2.csv.
  Outcome run_with_two_boards(const std::string& command) const {
    return run(board("vest-atmega1280", "2", 0) + board("vest-atmega1280", "", 0) + command +
               "\ncode=$?; kill -INT $board $board2; wait $board $board2; exit $code");
  }

 private:
  static std::string board(const std::string& firmware, const std::string& number, const int chips) {
    return "simulated_board '" VESTIGE_FIRMWARE_DIR "/" + firmware + ".elf' --chips " + std::to_string(chips) +
           " --link vest" + number + " --duties pins" + number + ".csv >board" + number + ".txt 2>&1 & board" + number +
           "=$!\n" + "for i in $(seq 200); do [ -e vest" + number + " ] && break; sleep 0.05; done\n";
  }
};

}  // namespace vestige::test
