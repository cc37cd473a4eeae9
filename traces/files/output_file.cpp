#include "traces/files/output_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <utility>

#include "traces/base/descriptor.hpp"
#include "traces/base/system_error.hpp"

namespace vestige {

namespace {

constexpr std::size_t kBufferBytes = 1 << 16;

bool is_standard_output(const std::filesystem::path& path) {
  return path == "-";
}

/// Makes the rename durable. A folder that cannot be synced (on some network disks) is not an error.
void sync_folder(const std::filesystem::path& path) {
  const auto parent = path.has_parent_path() ? path.parent_path() : std::filesystem::path(".");
  const int folder = ::open(parent.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (folder < 0) return;
  ::fsync(folder);
  ::close(folder);
}

}  // namespace

void write_all(int descriptor, std::span<const std::byte> bytes, const std::filesystem::path& path) {
  while (!bytes.empty()) {
    const ssize_t written = ::write(descriptor, bytes.data(), bytes.size());
    if (written < 0) {
      if (errno == EINTR) continue;
      if (errno == EPIPE) throw PipeClosed(shown_name(path), "the program that read it has stopped", "");
      throw system_error(path, "could not write", errno);
    }
    bytes = bytes.subspan(static_cast<std::size_t>(written));
  }
}

std::filesystem::path where_it_leads(std::filesystem::path path) {
  constexpr int kMostLinks = 40;  // the kernel's own limit
  std::error_code failed;
  // The target of /dev/stdout has a name only if it is a file.
  const auto end = std::filesystem::status(path, failed);
  if (std::filesystem::exists(end) && !std::filesystem::is_regular_file(end)) return path;
  std::filesystem::path led = path;
  for (int i = 0; std::filesystem::is_symlink(led, failed); ++i) {
    if (i == kMostLinks) throw system_error(path, "could not open", ELOOP);
    led = led.parent_path() / std::filesystem::read_symlink(led, failed);
  }
  // /proc gives the name the file had when it was opened, which may no longer exist.
  if (std::filesystem::exists(end) && !std::filesystem::equivalent(path, led, failed))
    throw Error(path.string(), "is open, but no longer has a name", "write to '-', or name a file");
  return led;
}

mode_t new_file_mode() {
  // The umask can only be read by setting it, and two threads must not do that at the same time.
  static const mode_t mask = [] {
    const mode_t found = ::umask(0);
    ::umask(found);
    return found;
  }();
  return 0666 & ~mask;
}

void make_folder(const std::filesystem::path& folder) {
  std::error_code failure;
  if (std::filesystem::exists(folder, failure) && !std::filesystem::is_directory(folder, failure))
    throw Error(folder.string(), "is a file, but must be a folder", "choose another name");
  std::filesystem::create_directories(folder, failure);
  if (failure) throw system_error(folder, "the folder cannot be made", failure.value());
}

void refuse_overwrite(const std::filesystem::path& path, Overwrite overwrite) {
  if (is_standard_output(path)) return;
  const auto parent = where_it_leads(path).parent_path();
  std::error_code ignored;
  const auto status = std::filesystem::status(path, ignored);
  if (!std::filesystem::exists(status)) {
    if (!parent.empty() && !std::filesystem::is_directory(parent, ignored))
      throw Error(path.string(), fmt::format("there is no folder '{}'", parent.string()), "create it first");
    if (::faccessat(AT_FDCWD, parent.empty() ? "." : parent.c_str(), W_OK | X_OK, AT_EACCESS) != 0)
      throw system_error(path, "could not be written", errno);
    return;
  }
  if (std::filesystem::is_directory(status)) throw Error(path.string(), "is a folder", "name a file");
  if (overwrite == Overwrite::kRefuse && std::filesystem::is_regular_file(status))
    throw Error(path.string(), "already exists", "choose another name, or add --force to overwrite it");
}

void refuse_terminal(std::string_view flag) {
  if (::isatty(STDOUT_FILENO) != 0)
    throw UsageError(flag, "the output is binary, but standard output is a terminal", "redirect it, or name a file");
}

OutputFile::OutputFile(std::filesystem::path path, Overwrite overwrite)
    : path_(std::move(path)), overwrite_(overwrite) {
  if (is_standard_output(path_)) {
    descriptor_ = STDOUT_FILENO;
    return;
  }
  path_ = where_it_leads(path_);
  refuse_overwrite(path_, overwrite_);
  std::error_code ignored;
  if (std::filesystem::exists(path_, ignored) && !std::filesystem::is_regular_file(path_, ignored)) {
    // A device or a pipe cannot be complete or absent, so bytes go to it directly.
    descriptor_ = open_device_for_writing(path_);
    return;
  }
  std::string name = (path_.parent_path() / fmt::format(".{}.XXXXXX", path_.filename().string())).string();
  descriptor_ = ::mkostemp(name.data(), O_CLOEXEC);
  if (descriptor_ < 0) throw system_error(path_, "could not create", errno);
  temporary_path_ = name;
  ::fchmod(descriptor_, new_file_mode());
}

OutputFile::~OutputFile() {
  if (descriptor_ >= 0 && descriptor_ != STDOUT_FILENO) ::close(descriptor_);
  if (!temporary_path_.empty()) ::unlink(temporary_path_.c_str());
}

void OutputFile::write(std::span<const std::byte> bytes) {
  write(std::string_view(reinterpret_cast<const char*>(bytes.data()), bytes.size()));
}

void OutputFile::write(std::string_view text) {
  buffer_.append(text);
  if (buffer_.size() >= kBufferBytes) flush();
}

void OutputFile::flush() {
  write_all(descriptor_, std::as_bytes(std::span(buffer_)), path_);
  buffer_.clear();
}

void OutputFile::commit() {
  flush();
  if (temporary_path_.empty()) return;
  if (::fsync(descriptor_) != 0) throw system_error(path_, "could not write", errno);
  if (::close(std::exchange(descriptor_, -1)) != 0) throw system_error(path_, "could not write", errno);
  give_name(temporary_path_, path_, overwrite_);
  temporary_path_.clear();
}

void give_name(const std::filesystem::path& temporary_path, const std::filesystem::path& path, Overwrite overwrite) {
  if (overwrite == Overwrite::kRefuse) {
    // link() refuses an existing name, whereas rename() would replace a file created in the meantime.
    if (::link(temporary_path.c_str(), path.c_str()) == 0) {
      ::unlink(temporary_path.c_str());
    } else if (errno == EEXIST) {
      throw Error(path.string(), "another program has just made this file", "choose another name, or add --force");
    } else if (::rename(temporary_path.c_str(), path.c_str()) != 0) {
      throw system_error(path, "could not give the finished file its name", errno);
    }
  } else if (::rename(temporary_path.c_str(), path.c_str()) != 0) {
    throw system_error(path, "could not give the finished file its name", errno);
  }
  sync_folder(path);
}

}  // namespace vestige
