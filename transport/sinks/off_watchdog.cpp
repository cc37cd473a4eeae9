#include "transport/sinks/off_watchdog.hpp"

#include <poll.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <limits>
#include <utility>

#include "traces/base/system_error.hpp"

namespace vestige {

namespace {

constexpr const char* kName = "the process that switches everything off at the end";

// The child of a program with several threads may call only functions that are safe in signal handlers
// (signal-safety(7)): nothing below allocates.

void send_thrice(const DatagramRoute& route, const std::vector<std::vector<std::byte>>& datagrams) {
  const auto* const host = reinterpret_cast<const sockaddr*>(&route.host);
  constexpr timespec kPause = {.tv_sec = 0, .tv_nsec = 20'000'000};
  for (int i = 0; i < 3; ++i) {
    if (i != 0) ::nanosleep(&kPause, nullptr);
    for (const std::vector<std::byte>& datagram : datagrams)
      ::sendto(route.socket, datagram.data(), datagram.size(), MSG_NOSIGNAL, host, route.host_bytes);
  }
}

void close_all_but(int one, int other) {
  const auto low = static_cast<unsigned>(std::min(one, other));
  const auto high = static_cast<unsigned>(std::max(one, other));
  if (low > 0) ::close_range(0, low - 1, 0);
  if (high - low > 1) ::close_range(low + 1, high - 1, 0);
  ::close_range(high + 1, std::numeric_limits<unsigned>::max(), 0);
}

std::pair<int, int> connected_pair() {
  std::array<int, 2> ends = {-1, -1};
  if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()) != 0)
    throw system_error(kName, "could not be started", errno);
  return {ends[0], ends[1]};
}

}  // namespace

OffWatchdog::OffWatchdog(const DatagramRoute& route, const std::vector<std::vector<std::byte>>& off,
                         std::chrono::milliseconds silence)
    : OffWatchdog(connected_pair(), route, off, silence) {}

OffWatchdog::OffWatchdog(const std::pair<int, int>& ends, const DatagramRoute& route,
                         const std::vector<std::vector<std::byte>>& off, std::chrono::milliseconds silence)
    : signs_(ends.first) {
  const Descriptor of_child(ends.second);
  child_ = ::fork();
  if (child_ < 0) throw system_error(kName, "could not be started", errno);
  if (child_ == 0) watch(ends.second, route, off, silence);
}

OffWatchdog::~OffWatchdog() {
  tell(Sign::kDone);
  while (::waitpid(child_, nullptr, 0) < 0 && errno == EINTR) {
  }
}

void OffWatchdog::tell(Sign sign) const {
  // Fails if the child is gone, which is no reason to stop, or so busy that earlier signs wait for it.
  [[maybe_unused]] const ssize_t sent = ::send(signs_.value(), &sign, sizeof sign, MSG_NOSIGNAL | MSG_DONTWAIT);
}

void OffWatchdog::watch(int signs, const DatagramRoute& route, const std::vector<std::vector<std::byte>>& off,
                        std::chrono::milliseconds silence) {
  ::setsid();
  ::prctl(PR_SET_NAME, "off-watchdog");  // so that pkill by the program's name does not take both
  close_all_but(signs, route.socket);
  bool is_on = false;
  while (true) {
    pollfd place = {.fd = signs, .events = POLLIN, .revents = 0};
    const int ready = ::poll(&place, 1, is_on ? static_cast<int>(silence.count()) : -1);
    if (ready < 0) continue;
    if (ready == 0) {
      send_thrice(route, off);
      is_on = false;
      continue;
    }
    std::array<Sign, 64> told = {};
    const ssize_t count = ::read(signs, told.data(), sizeof told);
    if (count < 0) continue;
    if (count == 0) break;
    const Sign latest = told[static_cast<std::size_t>(count) - 1];
    if (latest == Sign::kDone) ::_exit(0);
    is_on = latest == Sign::kOn;
  }
  send_thrice(route, off);
  ::_exit(0);
}

}  // namespace vestige
