#include "traces/trace_file/recovered.hpp"

#include <fmt/format.h>

#include <array>
#include <tuple>

namespace vestige {

std::string describe_recovered(const mcap::StringMap& metadata) {
  constexpr std::array kCounts = {std::tuple{"bytes_lost", "byte", "lost"}, std::tuple{"chunks_lost", "chunk", "lost"},
                                  std::tuple{"messages_lost", "message", "lost"},
                                  std::tuple{"messages_left_out", "message", "left out"},
                                  std::tuple{"messages_unverified", "message", "not verified by a CRC"}};
  std::string counts;
  for (const auto& [key, thing, fate] : kCounts) {
    const auto found = metadata.find(key);
    if (found == metadata.end() || found->second == "0") continue;
    const std::string number = found->second == "unknown" ? "an unknown number of" : found->second;
    counts += fmt::format("{}{} {}{} {}", counts.empty() ? ": " : ", ", number, thing, number == "1" ? "" : "s", fate);
  }
  return "was recovered from a damaged file" + counts;
}

}  // namespace vestige
