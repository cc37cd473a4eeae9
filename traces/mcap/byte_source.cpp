#include "traces/mcap/byte_source.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <utility>

#include "traces/base/descriptor.hpp"
#include "traces/base/error.hpp"
#include "traces/base/system_error.hpp"
#include "traces/files/output_file.hpp"
#include "traces/files/scratch_file.hpp"
#include "traces/mcap/record.hpp"

namespace vestige::mcap {

namespace {

constexpr std::size_t kWindowBytes = 1 << 12;
constexpr std::size_t kSpoolBlockBytes = 1 << 16;

int nameless_file() {
  const std::filesystem::path folder = temporary_folder();
  int descriptor = ::open(folder.c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, 0600);
  if (descriptor >= 0) return descriptor;
  // Not every file system knows O_TMPFILE.
  std::string name = (folder / "vestige-XXXXXX").string();
  descriptor = ::mkostemp(name.data(), O_CLOEXEC);
  if (descriptor < 0) throw system_error(folder, "could not make a temporary file", errno);
  ::unlink(name.c_str());
  return descriptor;
}

int spool(InputDescriptor& input) {
  Descriptor copy(nameless_file());
  const std::filesystem::path folder = temporary_folder();
  std::vector<std::byte> block(kSpoolBlockBytes);
  bool first = true;
  while (const std::size_t count = input.read(block)) {
    // A pipe may bring a file whose beginning is damaged; a device that brings anything else might never end.
    if (std::exchange(first, false) && input.is_device() &&
        (count < kMagicBytes || !is_magic(std::span(block).first(kMagicBytes))))
      throw Error(input.name(), "is a device, and its data is not an MCAP file", "name a file, or a pipe");
    write_all(copy.value(), std::span(block).first(count), folder);
  }
  return copy.release();
}

}  // namespace

FileSource::FileSource(const std::filesystem::path& path) : path_(path) {
  InputDescriptor input(path_);
  const bool can_be_read_anywhere = input.is_regular() && path_ != "-";
  descriptor_ = can_be_read_anywhere ? input.release() : spool(input);
  size_ = can_be_read_anywhere ? input.size_bytes() : static_cast<std::uint64_t>(::lseek(descriptor_, 0, SEEK_END));
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
