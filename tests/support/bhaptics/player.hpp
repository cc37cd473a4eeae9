#pragma once

#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "tests/support/background_process.hpp"

namespace vestige::test {

/// What stands in for bHaptics' Player: tests/support/bhaptics/player.py, which says what it takes and prints.
class BhapticsPlayer {
 public:
  explicit BhapticsPlayer(const std::filesystem::path& folder, std::vector<std::string> flags = {})
      : process_(command(std::move(flags)), folder / "player.txt", "/usr/bin") {
    const std::string line = process_.line();
    const std::string announced = "listening on ";
    if (line.starts_with(announced)) port_ = static_cast<std::uint16_t>(std::stoi(line.substr(announced.size())));
  }

  /// 0: it could not start.
  std::uint16_t port() const { return port_; }
  /// Waits until it prints this line. Returns false if it ends before.
  bool wait_for(const std::string& awaited) {
    for (std::string line = process_.line(); !line.empty(); line = process_.line())
      if (line == awaited) return true;
    return false;
  }
  /// Waits until a connection has ended. Returns what the Player got through it.
  nlohmann::json report() {
    for (std::string line = process_.line(); !line.empty(); line = process_.line())
      if (line.starts_with('{')) return nlohmann::json::parse(line);
    return {};
  }

 private:
  static std::vector<std::string> command(std::vector<std::string> flags) {
    flags.insert(flags.begin(), {"python3", VESTIGE_SOURCE_DIR "/tests/support/bhaptics/player.py"});
    return flags;
  }

  BackgroundProcess process_;
  std::uint16_t port_ = 0;
};

}  // namespace vestige::test
