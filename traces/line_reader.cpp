#include "traces/line_reader.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>

#include "traces/error.hpp"
#include "traces/input_file.hpp"
#include "traces/output_file.hpp"

namespace vestige {

namespace {

constexpr std::size_t kBlockBytes = std::size_t{1} << 16;
constexpr std::size_t kMostLineBytes = std::size_t{1} << 26;

}  // namespace

LineReader::LineReader(const std::filesystem::path& path)
    : path_(path), name_(path == "-" ? "standard input" : path.string()) {
  descriptor_ = path == "-" ? STDIN_FILENO : ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor_ < 0) throw unreadable(path, errno);
  struct stat status = {};
  if (::fstat(descriptor_, &status) == 0 && S_ISDIR(status.st_mode)) throw Error(name_, "is a folder", "name a file");
  if (S_ISREG(status.st_mode)) file_bytes_ = static_cast<std::size_t>(status.st_size);
}

LineReader::~LineReader() {
  if (descriptor_ > STDERR_FILENO) ::close(descriptor_);
}

bool LineReader::next(std::string_view& line) {
  std::size_t searched = begin_;
  std::size_t end = std::string::npos;
  while ((end = buffer_.find('\n', searched)) == std::string::npos) {
    searched = buffer_.size() - begin_;
    if (searched > kMostLineBytes)
      throw Error(fmt::format("{}, line {}", name_, line_ + 1), "is longer than 64 MiB", "is it the file you meant?");
    if (fill()) continue;
    if (begin_ == buffer_.size()) return false;
    end = buffer_.size();
    break;
  }
  line = std::string_view(buffer_).substr(begin_, end - begin_);
  if (line.ends_with('\r')) line.remove_suffix(1);
  begin_ = std::min(end + 1, buffer_.size());
  ++line_;
  return true;
}

/// Reads another block behind what is left, which it moves to the front.
bool LineReader::fill() {
  buffer_.erase(0, begin_);
  begin_ = 0;
  const std::size_t used = buffer_.size();
  buffer_.resize(used + kBlockBytes);
  ssize_t count = 0;
  do count = ::read(descriptor_, buffer_.data() + used, kBlockBytes);
  while (count < 0 && errno == EINTR);
  if (count < 0) throw system_error(path_, "could not read", errno);
  buffer_.resize(used + static_cast<std::size_t>(count));
  bytes_read_ += static_cast<std::size_t>(count);
  return count > 0;
}

double LineReader::share() const {
  return file_bytes_ == 0 ? 0 : std::min(1.0, static_cast<double>(bytes_read_) / static_cast<double>(file_bytes_));
}

}  // namespace vestige
