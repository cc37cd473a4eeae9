#pragma once

namespace vestige::cli {

enum class Snapshots { kWanted, kIgnored };

/// From now on, SIGUSR1 requests a snapshot or does nothing. Without this call it would end the program.
void catch_snapshots(Snapshots snapshots);

/// Returns whether a snapshot was requested since the last call.
bool snapshot_wanted();

}  // namespace vestige::cli
