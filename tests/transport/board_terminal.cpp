#include "tests/transport/board_terminal.hpp"

#include <fcntl.h>
#include <poll.h>
#include <termios.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <ctime>
#include <system_error>
#include <utility>

#include "traces/error.hpp"
#include "traces/output_file.hpp"

namespace vestige::test {

namespace {

timespec microseconds(const std::int64_t us) {
  return {us / 1'000'000, us % 1'000'000 * 1000};
}

}  // namespace

BoardTerminal::BoardTerminal(std::filesystem::path link) {
  descriptor_ = ::posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
  char name[64];
  termios settings{};
  if (descriptor_ < 0 || ::grantpt(descriptor_) != 0 || ::unlockpt(descriptor_) != 0 ||
      ::ptsname_r(descriptor_, name, sizeof name) != 0 || ::tcgetattr(descriptor_, &settings) != 0) {
    const int cause = errno;
    if (descriptor_ >= 0) ::close(descriptor_);
    throw system_error("/dev/ptmx", "making a pseudo terminal", cause);
  }
  name_ = name;
  // Both ends share their settings, and keep them from one client to the next.
  ::cfmakeraw(&settings);
  ::tcsetattr(descriptor_, TCSANOW, &settings);
  // Until the other end has been opened once, the system does not say that it is closed.
  ::close(::open(name, O_RDWR | O_NOCTTY | O_CLOEXEC));
  if (link.empty()) return;
  std::error_code failed;
  if (std::filesystem::is_symlink(link)) std::filesystem::remove(link, failed);
  std::filesystem::create_symlink(name_, link, failed);
  if (failed) {
    ::close(descriptor_);
    throw system_error(link, "making a link to the terminal", failed.value());
  }
  link_ = std::move(link);
}

BoardTerminal::~BoardTerminal() {
  std::error_code ignored;
  if (!link_.empty()) std::filesystem::remove(link_, ignored);
  ::close(descriptor_);
}

void BoardTerminal::wait(const std::int64_t at_most_us) {
  const timespec time = microseconds(at_most_us);
  pollfd terminal{descriptor_, POLLIN, 0};
  ::ppoll(&terminal, 1, &time, nullptr);
  const bool bytes_are_left = (terminal.revents & POLLIN) != 0;
  const bool client = (terminal.revents & POLLHUP) == 0;
  if (client_ && !client) ::tcflush(descriptor_, TCOFLUSH);  // the next client shall not read what this one has left
  client_ = client;
  if (!client && !bytes_are_left) ::nanosleep(&time, nullptr);
}

std::vector<std::uint8_t> BoardTerminal::read(const std::size_t count) {
  std::vector<std::uint8_t> bytes(count);
  const ssize_t got = ::read(descriptor_, bytes.data(), bytes.size());
  bytes.resize(got > 0 ? static_cast<std::size_t>(got) : 0);
  return bytes;
}

void BoardTerminal::write(const std::span<const std::uint8_t> bytes) {
  // A client that does not read loses what the terminal has no room for.
  if (client_ && !bytes.empty()) static_cast<void>(!::write(descriptor_, bytes.data(), bytes.size()));
}

}  // namespace vestige::test
