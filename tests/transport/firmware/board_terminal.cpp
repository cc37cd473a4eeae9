#include "tests/transport/firmware/board_terminal.hpp"

#include <fcntl.h>
#include <poll.h>
#include <sys/inotify.h>
#include <sys/ioctl.h>
#include <termios.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <ctime>
#include <system_error>
#include <utility>

#include "traces/base/error.hpp"
#include "traces/base/system_error.hpp"
#include "traces/files/output_file.hpp"

namespace vestige::test {

BoardTerminal::BoardTerminal(std::filesystem::path link) {
  try {
    open();
    if (link.empty()) return;
    std::error_code failed;
    if (std::filesystem::is_symlink(link)) std::filesystem::remove(link, failed);
    std::filesystem::create_symlink(name_, link, failed);
    if (failed) throw system_error(link, "making a link to the terminal", failed.value());
    link_ = std::move(link);
  } catch (...) {
    close();
    throw;
  }
}

BoardTerminal::~BoardTerminal() {
  std::error_code ignored;
  if (!link_.empty()) std::filesystem::remove(link_, ignored);
  close();
}

void BoardTerminal::open() {
  const auto check = [](const bool succeeded) {
    if (!succeeded) throw system_error("/dev/ptmx", "making a pseudo terminal", errno);
  };
  board_end_ = ::posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
  check(board_end_ >= 0 && ::grantpt(board_end_) == 0 && ::unlockpt(board_end_) == 0);
  char name[64];
  check(::ptsname_r(board_end_, name, sizeof name) == 0);
  name_ = name;
  client_end_ = ::open(name, O_RDWR | O_NOCTTY | O_CLOEXEC);
  termios settings{};
  check(client_end_ >= 0 && ::tcgetattr(client_end_, &settings) == 0);
  ::cfmakeraw(&settings);
  check(::tcsetattr(client_end_, TCSANOW, &settings) == 0);
  watch_ = ::inotify_init1(IN_NONBLOCK | IN_CLOEXEC);
  check(watch_ >= 0 && ::inotify_add_watch(watch_, name, IN_OPEN | IN_CLOSE) >= 0);
}

void BoardTerminal::close() {
  for (const int descriptor : {board_end_, client_end_, watch_}) {
    if (descriptor >= 0) ::close(descriptor);
  }
}

void BoardTerminal::note_clients() {
  alignas(inotify_event) char events[16 * sizeof(inotify_event)];
  ssize_t size = 0;
  while ((size = ::read(watch_, events, sizeof events)) > 0) {
    for (ssize_t at = 0; at < size; at += static_cast<ssize_t>(sizeof(inotify_event))) {  // a file's have no name
      const bool opened = (reinterpret_cast<const inotify_event*>(events + at)->mask & IN_OPEN) != 0;
      clients_ = std::max(clients_ + (opened ? 1 : -1), 0);
      if (clients_ == (opened ? 1 : 0)) ::tcflush(client_end_, TCIFLUSH);
    }
    if (clients_ == 0) ::ioctl(client_end_, TIOCNXCL);
  }
}

void BoardTerminal::wait(const std::int64_t at_most_us) {
  const timespec time = {at_most_us / 1'000'000, at_most_us % 1'000'000 * 1000};
  pollfd ends[] = {{board_end_, POLLIN, 0}, {watch_, POLLIN, 0}};
  ::ppoll(ends, 2, &time, nullptr);
  note_clients();
}

std::vector<std::uint8_t> BoardTerminal::read(const std::size_t count) {
  std::vector<std::uint8_t> bytes(count);
  const ssize_t got = ::read(board_end_, bytes.data(), bytes.size());
  bytes.resize(got > 0 ? static_cast<std::size_t>(got) : 0);
  return bytes;
}

void BoardTerminal::write(const std::span<const std::uint8_t> bytes) {
  // A client that does not read loses what the terminal has no room for.
  if (!bytes.empty()) static_cast<void>(!::write(board_end_, bytes.data(), bytes.size()));
}

}  // namespace vestige::test
