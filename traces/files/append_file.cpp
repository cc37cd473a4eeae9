#include "traces/files/append_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <utility>

#include "traces/base/descriptor.hpp"
#include "traces/base/error.hpp"
#include "traces/base/system_error.hpp"

namespace vestige {

namespace {

bool is_no_regular_file(const std::filesystem::path& path) {
  std::error_code ignored;
  return std::filesystem::exists(path, ignored) && !std::filesystem::is_regular_file(path, ignored);
}

}  // namespace

AppendFile::AppendFile(std::filesystem::path path, Overwrite overwrite, Unfinished unfinished)
    : path_(std::move(path)), overwrite_(overwrite), unfinished_(unfinished) {
  if (path_ == "-") {
    descriptor_ = STDOUT_FILENO;
    return;
  }
  path_ = where_it_leads(path_);
  refuse_overwrite(path_, overwrite);
  if (is_no_regular_file(path_)) {
    descriptor_ = open_device_for_writing(path_);
    return;
  }
  const bool appears_at_once = unfinished == Unfinished::kKept;
  if (appears_at_once) descriptor_ = ::open(path_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
  if (descriptor_ >= 0) {
    current_path_ = path_;
  } else if (!appears_at_once || (errno == EEXIST && overwrite == Overwrite::kAllow)) {
    std::string name = (path_.parent_path() / fmt::format(".{}.XXXXXX", path_.filename().string())).string();
    descriptor_ = ::mkostemp(name.data(), O_CLOEXEC);
    if (descriptor_ < 0) throw system_error(path_, "could not create", errno);
    current_path_ = name;
    ::fchmod(descriptor_, new_file_mode());
  } else {
    throw system_error(path_, "could not create", errno);
  }
}

AppendFile::~AppendFile() {
  if (descriptor_ < 0) return;
  if (descriptor_ != STDOUT_FILENO) ::close(descriptor_);
  if (is_file() && !worth_keeping_) ::unlink(current_path_.c_str());
}

void AppendFile::write(std::span<const std::byte> bytes) {
  const std::size_t all = bytes.size();
  while (!bytes.empty()) {
    const ssize_t count = ::write(descriptor_, bytes.data(), bytes.size());
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) fail("could not write", errno);
    bytes = bytes.subspan(static_cast<std::size_t>(count));
  }
  bytes_ += all;
}

void AppendFile::sync() {
  // Pipes, some devices and some network disks cannot be synced; that is not an error.
  if (::fsync(descriptor_) != 0 && errno != EINVAL && errno != ENOTSUP && errno != EROFS)
    fail("could not write it to disk", errno);
}

void AppendFile::keep() {
  if (unfinished_ == Unfinished::kRemoved) return;
  if (!worth_keeping_) take_name();
  worth_keeping_ = true;
}

void AppendFile::take_name() {
  if (!is_file() || current_path_ == path_) return;
  sync();
  give_name(current_path_, path_, overwrite_);
  current_path_ = path_;
}

void AppendFile::close() {
  sync();
  take_name();
  const int descriptor = std::exchange(descriptor_, -1);
  if (descriptor != STDOUT_FILENO && ::close(descriptor) != 0) throw system_error(path_, "could not write", errno);
}

/// Renames the file to the first free name of NAME.partial, NAME.partial-2, …. If all names are taken, the file keeps
/// its name.
std::filesystem::path AppendFile::set_aside() {
  constexpr int kMostNames = 100;
  for (int number = 1; number < kMostNames; ++number) {
    std::filesystem::path aside = path_;
    aside += number == 1 ? ".partial" : fmt::format(".partial-{}", number);
    // link() refuses an existing name, whereas rename() would replace the existing file.
    if (::link(current_path_.c_str(), aside.c_str()) == 0) {
      ::unlink(current_path_.c_str());
      return aside;
    }
    if (errno == EEXIST) continue;
    // Some file systems have no hard links.
    std::error_code failed;
    if (!std::filesystem::exists(aside, failed)) std::filesystem::rename(current_path_, aside, failed);
    return failed ? current_path_ : aside;
  }
  return current_path_;
}

void AppendFile::fail(std::string_view doing, int error_number) {
  const int descriptor = std::exchange(descriptor_, -1);
  if (is_file() && worth_keeping_) {
    // The beginning of a chunk is useless, and its space may be needed. If the truncation fails, no harm is done.
    static_cast<void>(!::ftruncate(descriptor, static_cast<off_t>(bytes_)));
  }
  if (descriptor != STDOUT_FILENO) ::close(descriptor);
  if (!is_file() || !worth_keeping_) {
    if (is_file()) ::unlink(current_path_.c_str());
    throw system_error(path_, doing, error_number);
  }
  throw Error(path_.string(),
              fmt::format("{}: {}; the part that was written before is kept and readable as {}", doing,
                          std::strerror(error_number), set_aside().string()),
              "free some space, or write to another disk");
}

}  // namespace vestige
