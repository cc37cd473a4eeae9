#include "cli/choices/snapshots.hpp"

#include <csignal>

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

}  // namespace vestige::cli
