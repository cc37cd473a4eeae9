#pragma once

#include <fcntl.h>
#include <poll.h>
#include <stdlib.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdint>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace vestige::test {

/// A serial line without hardware: the product opens `path()`, the test holds the other end.
class PseudoTerminal {
 public:
  PseudoTerminal() : master_(::posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC)) {
    std::array<char, 128> name{};
    if (master_ < 0 || ::grantpt(master_) != 0 || ::unlockpt(master_) != 0 ||
        ::ptsname_r(master_, name.data(), name.size()) != 0)
      throw std::runtime_error("no pseudo-terminal");
    path_ = name.data();
  }
  ~PseudoTerminal() { unplug(); }
  PseudoTerminal(const PseudoTerminal&) = delete;
  PseudoTerminal& operator=(const PseudoTerminal&) = delete;

  const std::string& path() const { return path_; }

  /// The device is gone.
  void unplug() {
    if (master_ >= 0) ::close(std::exchange(master_, -1));
  }

  /// What has come, after waiting for something for so long; empty when nothing came, or nobody has the path open.
  std::vector<std::uint8_t> read(int longest_ms = 0) const {
    pollfd end{.fd = master_, .events = POLLIN, .revents = 0};
    ::poll(&end, 1, longest_ms);
    if ((end.revents & POLLIN) == 0) {
      if ((end.revents & POLLHUP) != 0) ::poll(nullptr, 0, 1);  // it stays ready as long as nobody opens the path
      return {};
    }
    std::vector<std::uint8_t> bytes(65536);
    const ssize_t count = ::read(master_, bytes.data(), bytes.size());
    bytes.resize(count > 0 ? static_cast<std::size_t>(count) : 0);
    return bytes;
  }

  /// Waits until that many bytes have come, or nothing has for five seconds.
  std::vector<std::uint8_t> read_exactly(std::size_t count) const {
    std::vector<std::uint8_t> bytes;
    while (bytes.size() < count) {
      const std::vector<std::uint8_t> more = read(5000);
      if (more.empty()) break;
      bytes.insert(bytes.end(), more.begin(), more.end());
    }
    return bytes;
  }

  void write(std::span<const std::uint8_t> bytes) const {
    while (!bytes.empty()) {
      const ssize_t count = ::write(master_, bytes.data(), bytes.size());
      if (count > 0) {
        bytes = bytes.subspan(static_cast<std::size_t>(count));
      } else {
        if (errno != EAGAIN && errno != EINTR) throw std::runtime_error("the pseudo-terminal takes nothing");
        ::poll(nullptr, 0, 1);
      }
    }
  }

 private:
  int master_;
  std::string path_;
};

}  // namespace vestige::test
