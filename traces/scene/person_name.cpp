#include "traces/scene/person_name.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "traces/base/utf8.hpp"

namespace vestige {

std::string name_fault(std::string_view name) {
  if (std::ranges::any_of(name, is_control)) return "has a control character";
  if (valid_utf8(name) != name) return "is not UTF-8";
  if (name.size() > kMostNameBytes) return fmt::format("is longer than {} bytes", kMostNameBytes);
  return {};
}

std::string readable_name(std::string_view name) {
  const std::string line = in_one_line(name);
  std::size_t end = 0;
  while (end < line.size()) {
    const std::size_t next = end + utf8_length(std::string_view(line).substr(end));
    if (next > kMostNameBytes) break;
    end = next;
  }
  return line.substr(0, end);
}

}  // namespace vestige
