#include "traces/files/scratch_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <vector>

#include "traces/base/error.hpp"
#include "traces/base/system_error.hpp"

namespace vestige {

std::filesystem::path temporary_folder() {
  std::error_code failure;
  std::filesystem::path folder = std::filesystem::temp_directory_path(failure);
  if (failure)
    throw Error("the folder for temporary files", failure.message(), "set TMPDIR to a folder that you may write to");
  return folder;
}

ScratchFile::ScratchFile(const std::filesystem::path& beside, ScratchName keep) : beside_(beside) {
  std::error_code ignored;
  const bool is_stream =
      beside == "-" || (std::filesystem::exists(beside, ignored) && !std::filesystem::is_regular_file(beside, ignored));
  const auto folder = is_stream                  ? temporary_folder()
                      : beside.has_parent_path() ? beside.parent_path()
                                                 : std::filesystem::path(".");
  std::string name = (folder / ".vestige.XXXXXX").string();
  descriptor_ = ::mkostemp(name.data(), O_CLOEXEC);
  if (descriptor_ < 0) throw system_error(beside, "could not create a temporary file beside it", errno);
  if (keep == ScratchName::kNone)
    ::unlink(name.c_str());
  else
    path_ = name;
}

ScratchFile::~ScratchFile() {
  ::close(descriptor_);
  if (!path_.empty()) ::unlink(path_.c_str());
}

void ScratchFile::append(std::span<const std::byte> bytes) {
  write_all(descriptor_, bytes, beside_);
}

void ScratchFile::read(std::uint64_t offset, std::span<std::byte> into) const {
  while (!into.empty()) {
    const ssize_t count = ::pread(descriptor_, into.data(), into.size(), static_cast<off_t>(offset));
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) throw system_error(beside_, "could not read its temporary file", count < 0 ? errno : EIO);
    offset += static_cast<std::uint64_t>(count);
    into = into.subspan(static_cast<std::size_t>(count));
  }
}

void ScratchFile::copy_to(OutputFile& file) const {
  struct stat status = {};
  if (::fstat(descriptor_, &status) != 0) throw system_error(beside_, "could not read its temporary file", errno);
  const auto size = static_cast<std::uint64_t>(status.st_size);
  std::vector<std::byte> block(std::size_t{1} << 20);
  for (std::uint64_t offset = 0; offset < size; offset += block.size()) {
    const auto count = static_cast<std::size_t>(std::min<std::uint64_t>(block.size(), size - offset));
    read(offset, std::span(block).first(count));
    file.write(std::span<const std::byte>(block).first(count));
  }
}

}  // namespace vestige
