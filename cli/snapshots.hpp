#pragma once

namespace vestige::cli {

/// From now on SIGUSR1 asks for a snapshot.
void catch_snapshots();

/// Whether one was asked for since the last call.
bool snapshot_wanted();

}  // namespace vestige::cli
