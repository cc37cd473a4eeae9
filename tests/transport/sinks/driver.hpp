#pragma once

#include <optional>

namespace vestige::test {

/// How the driver of the serial line behaves while this lives, where the one of a pseudo-terminal is too easy-going.
/// The linker puts it in the way of the system's calls.
struct Driver {
  Driver();
  ~Driver();
  Driver(const Driver&) = delete;
  Driver& operator=(const Driver&) = delete;

  bool only_9600_baud = false;
  bool has_serial_flags = false;
  int serial_flags = 0;              ///< as last set
  std::optional<int> pending_bytes;  ///< what TIOCOUTQ says
};

}  // namespace vestige::test
