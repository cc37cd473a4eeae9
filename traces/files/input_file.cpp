#include "traces/files/input_file.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "traces/base/descriptor.hpp"
#include "traces/base/error.hpp"

namespace vestige {

namespace {

template <typename Container>
Container read_all(const std::filesystem::path& path, std::uint64_t limit_bytes) {
  InputDescriptor input(path);
  constexpr std::size_t kStep = 1 << 16;
  Container content;
  const std::uint64_t expected = input.size_bytes();
  std::size_t used = 0;
  for (;;) {
    if (std::max<std::uint64_t>(used, expected) > limit_bytes)
      throw Error(input.name(), fmt::format("is larger than {} bytes", limit_bytes), "check that it is the right file");
    if (used == content.size()) content.resize(std::max<std::size_t>(expected + 1, used + std::max(used, kStep)));
    const std::size_t count = input.read(std::as_writable_bytes(std::span(content).subspan(used)));
    if (count == 0) break;
    used += count;
  }
  content.resize(used);
  return content;
}

}  // namespace

std::vector<std::byte> read_file(const std::filesystem::path& path, std::uint64_t limit_bytes) {
  return read_all<std::vector<std::byte>>(path, limit_bytes);
}

std::string read_text_file(const std::filesystem::path& path, std::uint64_t limit_bytes) {
  return read_all<std::string>(path, limit_bytes);
}

}  // namespace vestige
