#include "cli/vest/stream_log.hpp"

#include <fmt/format.h>

#include <cstdint>

namespace vestige::cli {

StreamLog::StreamLog(const std::string& path, Overwrite overwrite, std::size_t actuator_count)
    : file_(path, overwrite) {
  std::string header = "time_s,state,written_us";
  for (std::size_t i = 1; i <= actuator_count; ++i) header += fmt::format(",actuator_{}", i);
  file_.write(header + "\n");
}

void StreamLog::write(const std::vector<SentState>& states) {
  for (const SentState& state : states) {
    const bool sent = state.fate == SentState::Fate::kSent;
    std::string line = fmt::format("{},{},{}", state.frame.time_s, sent ? "sent" : "superseded",
                                   sent ? fmt::format("{:.1f}", state.written_s * 1e6) : "");
    for (const std::uint8_t duty : state.frame.duty) line += fmt::format(",{}", duty);
    file_.write(line + "\n");
  }
}

}  // namespace vestige::cli
