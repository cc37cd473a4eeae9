#pragma once

namespace vestige::cli {

enum class Snapshots { kWanted, kIgnored };

/// From now on SIGUSR1 asks for a snapshot, or does nothing; by itself it would end the program.
void catch_snapshots(Snapshots snapshots);

/// Whether one was asked for since the last call.
bool snapshot_wanted();

}  // namespace vestige::cli
