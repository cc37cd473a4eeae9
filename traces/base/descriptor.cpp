#include "traces/base/descriptor.hpp"

#include <fcntl.h>
#include <poll.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <utility>

#include "traces/base/error.hpp"
#include "traces/base/system_error.hpp"

namespace vestige {

namespace {

constexpr int kPatience_ms = 100;

bool (*is_stopped)() = nullptr;

void refuse_to_wait_when_stopped(const std::string& name) {
  if (is_stopped != nullptr && is_stopped()) throw Error(name, "waiting for it was stopped", "");
}

Error unreadable(const std::string& name, std::string_view doing, int error_number) {
  if (error_number == ENOENT) return {name, "there is no such file", "check the name"};
  if (error_number == EACCES)
    return {name, "you have no permission to read it", "ask its owner, or change its permissions"};
  return {name, std::string(doing) + ": " + std::strerror(error_number), ""};
}

/// Clears O_NONBLOCK: only opening a FIFO must not block, later reads and writes may.
void let_wait(int descriptor) {
  ::fcntl(descriptor, F_SETFL, ::fcntl(descriptor, F_GETFL) & ~O_NONBLOCK);
}

}  // namespace

Descriptor::~Descriptor() {
  if (value_ > STDERR_FILENO) ::close(value_);
}

int Descriptor::release() {
  return std::exchange(value_, -1);
}

InputDescriptor::InputDescriptor(const std::filesystem::path& path)
    : name_(path == "-" ? "standard input" : path.string()),
      descriptor_(path == "-" ? STDIN_FILENO : ::open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC)) {
  if (descriptor_.value() < 0) throw unreadable(name_, "could not open", errno);
  struct stat status = {};
  if (::fstat(descriptor_.value(), &status) != 0) throw unreadable(name_, "could not read", errno);
  if (S_ISDIR(status.st_mode)) throw Error(name_, "is a folder", "name a file");
  if (path != "-") let_wait(descriptor_.value());
  is_regular_ = S_ISREG(status.st_mode);
  is_device_ = S_ISCHR(status.st_mode);
  if (is_regular_) size_bytes_ = static_cast<std::uint64_t>(status.st_size);
}

std::size_t InputDescriptor::read(std::span<std::byte> out) {
  for (;;) {
    // After a signal, a blocking read would restart, but poll does not.
    pollfd waited{.fd = descriptor_.value(), .events = POLLIN, .revents = 0};
    if (!is_regular_ && ::poll(&waited, 1, kPatience_ms) <= 0) {
      refuse_to_wait_when_stopped(name_);
      continue;
    }
    const ssize_t count = ::read(descriptor_.value(), out.data(), out.size());
    if (count >= 0) return static_cast<std::size_t>(count);
    if (errno != EINTR && errno != EAGAIN) throw unreadable(name_, "could not read", errno);
  }
}

int open_device_for_writing(const std::filesystem::path& path) {
  for (;;) {
    const int descriptor = ::open(path.c_str(), O_WRONLY | O_NONBLOCK | O_CLOEXEC);
    if (descriptor >= 0) {
      let_wait(descriptor);
      return descriptor;
    }
    const bool has_no_reader = errno == ENXIO && std::filesystem::is_fifo(path);
    if (errno != EINTR && !has_no_reader) throw system_error(path, "could not open for writing", errno);
    refuse_to_wait_when_stopped(path.string());
    ::poll(nullptr, 0, kPatience_ms);
  }
}

void stop_waiting_when(bool (*stopped)()) {
  is_stopped = stopped;
}

}  // namespace vestige
