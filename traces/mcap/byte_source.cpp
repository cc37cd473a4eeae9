#include "traces/mcap/byte_source.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <utility>

#include "traces/error.hpp"
#include "traces/input_file.hpp"
#include "traces/output_file.hpp"

namespace vestige::mcap {

namespace {

constexpr std::size_t kWindowBytes = 1 << 12;
constexpr std::size_t kSpoolBlockBytes = 1 << 16;

/// Closes what it holds unless it was released.
class Descriptor {
 public:
  explicit Descriptor(int value) : value_(value) {}
  ~Descriptor() {
    if (value_ > STDERR_FILENO) ::close(value_);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  int value() const { return value_; }
  int release() { return std::exchange(value_, -1); }

 private:
  int value_;
};

int open_for_reading(const std::filesystem::path& path) {
  if (path == "-") return STDIN_FILENO;
  const int descriptor = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor >= 0) return descriptor;
  throw unreadable(path, errno);
}

int nameless_file() {
  const std::filesystem::path folder = std::filesystem::temp_directory_path();
  int descriptor = ::open(folder.c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, 0600);
  if (descriptor >= 0) return descriptor;
  // Not every file system knows O_TMPFILE.
  std::string name = (folder / "vestige-XXXXXX").string();
  descriptor = ::mkostemp(name.data(), O_CLOEXEC);
  if (descriptor < 0) throw system_error(folder, "could not make a temporary file", errno);
  ::unlink(name.c_str());
  return descriptor;
}

int spool(int from, const std::filesystem::path& path) {
  Descriptor copy(nameless_file());
  std::vector<std::byte> block(kSpoolBlockBytes);
  for (;;) {
    const ssize_t count = ::read(from, block.data(), block.size());
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) throw system_error(path, "could not read", errno);
    if (count == 0) return copy.release();
    write_all(copy.value(), std::span(block).first(static_cast<std::size_t>(count)),
              std::filesystem::temp_directory_path());
  }
}

struct stat status_of(int descriptor, const std::filesystem::path& path) {
  struct stat status = {};
  if (::fstat(descriptor, &status) != 0) throw system_error(path, "could not read", errno);
  return status;
}

}  // namespace

FileSource::FileSource(const std::filesystem::path& path) : path_(path) {
  Descriptor opened(open_for_reading(path_));
  struct stat status = status_of(opened.value(), path_);
  if (S_ISDIR(status.st_mode)) throw Error(path_.string(), "is a folder", "name a file");
  if (!S_ISREG(status.st_mode) || path_ == "-") {
    Descriptor copy(spool(opened.value(), path_));
    status = status_of(copy.value(), path_);
    descriptor_ = copy.release();
  } else {
    descriptor_ = opened.release();
  }
  size_ = static_cast<std::uint64_t>(status.st_size);
}

FileSource::~FileSource() {
  ::close(descriptor_);
}

void FileSource::read_at(std::uint64_t offset, std::span<std::byte> out) const {
  while (!out.empty()) {
    const ssize_t count = ::pread(descriptor_, out.data(), out.size(), static_cast<off_t>(offset));
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) throw system_error(path_, "could not read", errno);
    if (count == 0) throw Error(path_.string(), "became shorter while it was read", "let its writer finish first");
    out = out.subspan(static_cast<std::size_t>(count));
    offset += static_cast<std::uint64_t>(count);
  }
}

void MemorySource::read_at(std::uint64_t offset, std::span<std::byte> out) const {
  if (!out.empty()) std::memcpy(out.data(), bytes_.data() + offset, out.size());
}

std::span<const std::byte> ReadWindow::at(std::uint64_t offset, std::size_t count) {
  if (offset < start_ || offset + count > start_ + window_.size()) {
    const std::uint64_t wanted = std::max<std::uint64_t>(count, kWindowBytes);
    window_.resize(static_cast<std::size_t>(std::min(wanted, source_.size() - offset)));
    source_.read_at(offset, window_);
    start_ = offset;
  }
  return std::span(window_).subspan(static_cast<std::size_t>(offset - start_), count);
}

}  // namespace vestige::mcap
