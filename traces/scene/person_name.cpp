#include "traces/scene/person_name.hpp"

#include <fmt/format.h>

#include <set>

#include "traces/base/utf8.hpp"
#include "traces/scene/people.hpp"

namespace vestige {

std::string name_fault(std::string_view name) {
  if (valid_utf8(name) != name) return "is not UTF-8";
  if (in_one_line(name) != name) return "has a control character";
  if (!name.empty() && name.find_first_not_of(' ') == std::string_view::npos) return "is blank";
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

std::vector<std::string> names_of_people(const std::vector<std::string>& recorded) {
  std::vector<std::string> names;
  names.reserve(recorded.size());
  for (const std::string& name : recorded) names.push_back(readable_name(name));
  if (names.size() == 1) return names;
  std::set<std::string> taken(names.begin(), names.end());
  std::set<std::string> seen = {""};
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (seen.insert(names[i]).second) continue;
    std::string name = in_words(static_cast<std::uint16_t>(i + 1));
    while (!taken.insert(name).second) name += '*';
    names[i] = name;
  }
  return names;
}

}  // namespace vestige
