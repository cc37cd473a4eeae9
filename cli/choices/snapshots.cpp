#include "cli/choices/snapshots.hpp"

#include <fmt/format.h>

#include <csignal>

#include "traces/base/error.hpp"

namespace vestige::cli {

namespace {

volatile std::sig_atomic_t snapshot_seen = 0;

void on_snapshot(int) {
  snapshot_seen = 1;
}

}  // namespace

void catch_snapshots(Snapshots snapshots) {
  std::signal(SIGUSR1, snapshots == Snapshots::kWanted ? on_snapshot : SIG_IGN);
}

bool snapshot_wanted() {
  if (snapshot_seen == 0) return false;
  snapshot_seen = 0;
  return true;
}

std::function<void(const std::filesystem::path&, double)> snapshot_teller(Verbosity verbosity) {
  if (verbosity == Verbosity::kQuiet) return {};
  return [](const std::filesystem::path& path, double seconds) {
    print_message(fmt::format("vestige: wrote {}: the last {:.2f} s\n", printable(path.string()), seconds));
  };
}

}  // namespace vestige::cli
