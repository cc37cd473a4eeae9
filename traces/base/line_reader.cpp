#include "traces/base/line_reader.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "traces/base/error.hpp"

namespace vestige {

namespace {

constexpr std::size_t kBlockBytes = std::size_t{1} << 16;
constexpr std::size_t kMostLineBytes = std::size_t{1} << 26;

}  // namespace

bool LineReader::next(std::string_view& line) {
  std::size_t searched = begin_;
  std::size_t end = std::string::npos;
  while ((end = buffer_.find('\n', searched)) == std::string::npos) {
    searched = buffer_.size() - begin_;
    if (searched > kMostLineBytes)
      throw Error(fmt::format("{}, line {}", name(), line_ + 1), "is longer than 64 MiB",
                  "check that it is the right file");
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

/// Moves the unread part to the front of the buffer and appends another block.
bool LineReader::fill() {
  buffer_.erase(0, begin_);
  begin_ = 0;
  const std::size_t used = buffer_.size();
  buffer_.resize(used + kBlockBytes);
  const std::size_t count = input_.read(std::as_writable_bytes(std::span(buffer_).subspan(used)));
  buffer_.resize(used + count);
  bytes_read_ += count;
  return count > 0;
}

double LineReader::share() const {
  const std::uint64_t all = input_.size_bytes();
  return all == 0 ? 0 : std::min(1.0, static_cast<double>(bytes_read_) / static_cast<double>(all));
}

}  // namespace vestige
