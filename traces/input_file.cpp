#include "traces/input_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

#include "traces/output_file.hpp"

namespace vestige {

namespace {

class Descriptor {
 public:
  explicit Descriptor(const std::filesystem::path& path)
      : value_(path == "-" ? STDIN_FILENO : ::open(path.c_str(), O_RDONLY | O_CLOEXEC)) {}
  ~Descriptor() {
    if (value_ > STDERR_FILENO) ::close(value_);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  int value() const { return value_; }

 private:
  int value_;
};

template <typename Container>
Container read_all(const std::filesystem::path& path, std::uint64_t limit_bytes) {
  const Descriptor descriptor(path);
  if (descriptor.value() < 0) throw unreadable(path, errno);
  struct stat status = {};
  if (::fstat(descriptor.value(), &status) != 0) throw system_error(path, "could not read", errno);
  if (S_ISDIR(status.st_mode)) throw Error(path.string(), "is a folder", "name a file");
  constexpr std::size_t kStep = 1 << 16;
  Container content;
  const auto expected = S_ISREG(status.st_mode) ? static_cast<std::uint64_t>(status.st_size) : 0;
  std::size_t used = 0;
  for (;;) {
    if (std::max<std::uint64_t>(used, expected) > limit_bytes)
      throw Error(path.string(), fmt::format("is larger than {} bytes", limit_bytes), "is it the file you meant?");
    if (used == content.size()) content.resize(std::max<std::size_t>(expected + 1, used + std::max(used, kStep)));
    const ssize_t count = ::read(descriptor.value(), content.data() + used, content.size() - used);
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) throw system_error(path, "could not read", errno);
    if (count == 0) break;
    used += static_cast<std::size_t>(count);
  }
  content.resize(used);
  return content;
}

}  // namespace

Error unreadable(const std::filesystem::path& path, int error_number) {
  if (error_number == ENOENT) return {path.string(), "there is no such file", "check the name"};
  if (error_number == EACCES) return {path.string(), "may not be read", "ask its owner, or change its permissions"};
  return system_error(path, "could not open", error_number);
}

std::vector<std::byte> read_file(const std::filesystem::path& path, std::uint64_t limit_bytes) {
  return read_all<std::vector<std::byte>>(path, limit_bytes);
}

std::string read_text_file(const std::filesystem::path& path, std::uint64_t limit_bytes) {
  return read_all<std::string>(path, limit_bytes);
}

}  // namespace vestige
