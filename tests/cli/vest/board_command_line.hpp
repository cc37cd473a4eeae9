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

  /// Runs `command` beside a board whose pty is called 'vest' and whose pins end up in pins.csv.
  Outcome run_with_board(const std::string& command, const std::string& firmware = "vest-atmega1280") const {
    return run("simulated_board '" VESTIGE_FIRMWARE_DIR "/" + firmware +
               ".elf' --link vest --duties pins.csv >board.txt 2>&1 & board=$!\n"
               "for i in $(seq 200); do [ -e vest ] && break; sleep 0.05; done\n" +
               command + "\ncode=$?; kill -INT $board; wait $board; exit $code");
  }
};

}  // namespace vestige::test
