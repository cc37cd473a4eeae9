#include "transport/sinks/off_watchdog.hpp"

#include <poll.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <limits>
#include <utility>

#include "traces/base/system_error.hpp"

namespace vestige {

namespace {

constexpr const char* kName = "the process that switches everything off at the end";

// The child of a program with several threads may call only functions that are safe in signal handlers
// (signal-safety(7)): nothing below allocates.

void send_all(const DatagramRoute& route, const std::vector<std::vector<std::byte>>& datagrams) {
  const auto* const host = reinterpret_cast<const sockaddr*>(&route.host);
  constexpr timespec kPause = {.tv_sec = 0, .tv_nsec = std::chrono::nanoseconds(kBetweenFinalTries).count()};
  for (int i = 0; i < kFinalTries; ++i) {
    if (i != 0) ::nanosleep(&kPause, nullptr);
    for (const std::vector<std::byte>& datagram : datagrams)
      ::sendto(route.socket, datagram.data(), datagram.size(), MSG_NOSIGNAL, host, route.host_bytes);
  }
}

/// Closes the descriptors from `first` on that are below `end`.
void close_all(unsigned first, unsigned end) {
  if (first == end || ::close_range(first, end - 1, 0) == 0) return;
  rlimit limit = {};  // a kernel before 5.9, or a container that forbids the call
  ::getrlimit(RLIMIT_NOFILE, &limit);
  for (unsigned i = first; i < end && i < limit.rlim_cur; ++i) ::close(static_cast<int>(i));
}

void close_all_but(int one, int other) {
  const auto low = static_cast<unsigned>(std::min(one, other));
  const auto high = static_cast<unsigned>(std::max(one, other));
  close_all(0, low);
  close_all(low + 1, high);
  close_all(high + 1, std::numeric_limits<unsigned>::max());
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
  ::shutdown(signs_.value(), SHUT_WR);  // if there was no room for that
  while (::waitpid(child_, nullptr, 0) < 0 && errno == EINTR) {
  }
}

void OffWatchdog::tell(Sign sign) const {
  // Fails if the child is gone, which is no reason to stop, or so busy that earlier signs wait for it.
  [[maybe_unused]] const ssize_t sent = ::send(signs_.value(), &sign, sizeof sign, MSG_NOSIGNAL | MSG_DONTWAIT);
}

void OffWatchdog::watch(int signs, const DatagramRoute& route, const std::vector<std::vector<std::byte>>& off,
                        std::chrono::milliseconds silence) {
  for (const int ignored : {SIGINT, SIGTERM, SIGHUP}) ::signal(ignored, SIG_IGN);
  ::setsid();
  ::prctl(PR_SET_NAME, "off-watchdog");  // so that pkill by the program's name does not take both
  close_all_but(signs, route.socket);
  bool is_on = false;
  bool is_done = false;
  while (!is_done) {
    pollfd place = {.fd = signs, .events = POLLIN, .revents = 0};
    const int ready = ::poll(&place, 1, is_on ? static_cast<int>(silence.count()) : -1);
    if (ready == 0) {
      send_all(route, off);
      is_on = false;
    }
    if (ready <= 0) continue;
    std::array<Sign, 64> told = {};
    const ssize_t count = ::read(signs, told.data(), sizeof told);
    if (count < 0) continue;
    for (ssize_t i = 0; i < count && !is_done; ++i) {
      const Sign sign = told[static_cast<std::size_t>(i)];
      is_done = sign == Sign::kDone;
      if (!is_done) is_on = sign == Sign::kOn;
    }
    if (count == 0) is_on = is_done = true;  // the program is gone
  }
  if (is_on) send_all(route, off);
  ::_exit(0);
}

}  // namespace vestige
