#pragma once

#include <sys/wait.h>

#include <cstdlib>
#include <filesystem>
#include <string>

#include "tests/support/test_data.hpp"
#include "traces/files/input_file.hpp"

namespace vestige::test {

struct Outcome {
  int exit_code = -1;
  std::string standard_output;
  std::string standard_error;
};

/// Runs a shell command line in a folder, with the built programs first on the PATH.
inline Outcome run(const std::string& command, const std::filesystem::path& folder) {
  const TemporaryFolder capture;
  const std::string line = "cd '" + folder.string() + "' && PATH='" VESTIGE_BIN_DIR "':\"$PATH\" && { " + command +
                           "\n} >'" + (capture / "out").string() + "' 2>'" + (capture / "err").string() +
                           "' </dev/null";
  const int status = std::system(line.c_str());
  Outcome outcome;
  outcome.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  outcome.standard_output = read_text_file(capture / "out");
  outcome.standard_error = read_text_file(capture / "err");
  return outcome;
}

/// Returns shell code that waits until the process $P catches SIGINT, whose bit is the second of the mask, sends it,
/// and waits for the end.
inline std::string interrupt() {
  return "until grep -qs '^SigCgt:.*[2367abef]$' /proc/$P/status || ! kill -0 $P; do sleep 0.01; done; kill -INT $P; "
         "wait $P";
}

}  // namespace vestige::test
