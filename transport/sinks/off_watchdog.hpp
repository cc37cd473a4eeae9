#pragma once

#include <sys/types.h>

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "traces/base/descriptor.hpp"
#include "transport/sinks/datagram_sender.hpp"

namespace vestige {

/// Switches off by datagrams what this program left on: a child process, which outlives it. The child sends the
/// datagrams if this program ends without a word, even by SIGKILL, or shows no sign of life for the time `silence`.
/// Datagrams may be lost, so it sends them `kFinalTries` times.
///
/// The child takes no part in Ctrl-C or a hang-up of the terminal, ignores SIGTERM, and holds no other file of this
/// program open.
class OffWatchdog {
 public:
  /// Throws `Error` if the process cannot be started.
  OffWatchdog(const DatagramRoute& route, const std::vector<std::vector<std::byte>>& off,
              std::chrono::milliseconds silence);
  /// Ends the child, which first sends the datagrams if something was left on. Waits for that.
  ~OffWatchdog();
  OffWatchdog(const OffWatchdog&) = delete;
  OffWatchdog& operator=(const OffWatchdog&) = delete;

  /// Tells it that this program lives, and is about to leave something on. From here on, silence counts.
  void note_on() const { tell(Sign::kOn); }
  /// Tells it that everything was switched off. Silence no longer counts.
  void note_off() const { tell(Sign::kOff); }

 private:
  enum class Sign : std::uint8_t { kOn, kOff, kDone };
  OffWatchdog(const std::pair<int, int>& ends, const DatagramRoute& route,
              const std::vector<std::vector<std::byte>>& off, std::chrono::milliseconds silence);
  void tell(Sign sign) const;
  [[noreturn]] static void watch(int signs, const DatagramRoute& route, const std::vector<std::vector<std::byte>>& off,
                                 std::chrono::milliseconds silence);

  Descriptor signs_;  ///< to the child
  pid_t child_ = -1;
};

}  // namespace vestige
